# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# The layout of packed duals follows the vector width and whether vectors are the compiler's, so files
# built in different ways must not link: they would corrupt each other's memory.
#
# cmake -Dcompile=<compiler and flags> -Dprocessor=<…> -P check.cmake

cmake_minimum_required(VERSION 3.22)

if(NOT processor MATCHES "^(x86_64|AMD64|amd64)$")
  message("SKIPPED: vector widths differ by compiler flag on x86-64 only, this is ${processor}")
  return()
endif()
set(ENV{LC_ALL} C)

function(link library_flag user_flag result_variable log_variable)
  foreach(file IN ITEMS library user)
    execute_process(
      COMMAND ${compile} ${${file}_flag} -c ${CMAKE_CURRENT_LIST_DIR}/${file}.cpp -o ${file}.o
      COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
  execute_process(COMMAND ${compile} library.o user.o -o vector_width
    RESULT_VARIABLE result ERROR_VARIABLE log)
  set(${result_variable} ${result} PARENT_SCOPE)
  set(${log_variable} "${log}" PARENT_SCOPE)
endfunction()

foreach(flag IN ITEMS -msse2 -mavx -DDUET_PORTABLE)
  link(${flag} ${flag} result log)
  if(NOT result EQUAL 0)
    message("${log}")
    message(FATAL_ERROR "two files built with ${flag} do not link")
  endif()
endforeach()

foreach(flag IN ITEMS -mavx -DDUET_PORTABLE)
  link(${flag} -msse2 result log)
  if(result EQUAL 0)
    message(FATAL_ERROR "files built with and without ${flag} link, though their duals differ")
  elseif(NOT log MATCHES "undefined reference to [^\n]*first_partial")
    message("${log}")
    message(FATAL_ERROR "files built with and without ${flag} fail to link for another reason")
  endif()
endforeach()
