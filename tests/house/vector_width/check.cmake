# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# The layout of packed duals follows the vector width and whether vectors are the compiler's, and so does that of what
# libraries take and return: files built in different ways must not link, they would corrupt each other's memory.
#
# cmake -Dcompile=<compiler and flags> -Dprocessor=<…> -P check.cmake

cmake_minimum_required(VERSION 3.22)

if(NOT processor MATCHES "^(x86_64|AMD64|amd64)$")
  message("SKIPPED: vector widths differ by compiler flag on x86-64 only, this is ${processor}")
  return()
endif()
set(ENV{LC_ALL} C)

# A file of a program, one with a function of it, and one of duet::io.
set(user ${CMAKE_CURRENT_LIST_DIR}/user.cpp)
set(function ${CMAKE_CURRENT_LIST_DIR}/library.cpp)
set(library ${CMAKE_CURRENT_LIST_DIR}/../../../src/io/loop_file.cpp)
set(kinds sse2 avx portable)
set(flag_of_sse2 -msse2)
set(flag_of_avx -mavx)
set(flag_of_portable -DDUET_PORTABLE)
foreach(kind IN LISTS kinds)
  foreach(file IN ITEMS user function library)
    execute_process(COMMAND ${compile} ${flag_of_${kind}} -c ${${file}} -o ${file}_${kind}.o
      COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
endforeach()

foreach(kind IN LISTS kinds)
  foreach(other IN LISTS kinds)
    execute_process(COMMAND ${compile} user_${kind}.o function_${other}.o library_${other}.o -o vector_width
      RESULT_VARIABLE result ERROR_VARIABLE log)
    set(are_told_apart FALSE)
    if(log MATCHES "undefined reference to [^\n]*first_partial" AND log MATCHES "undefined reference to [^\n]*read_loops")
      set(are_told_apart TRUE)
    endif()
    if(kind STREQUAL other AND NOT result EQUAL 0)
      message(FATAL_ERROR "files built with ${flag_of_${kind}} do not link:\n${log}")
    elseif(NOT kind STREQUAL other AND result EQUAL 0)
      message(FATAL_ERROR "files built with ${flag_of_${kind}} and ${flag_of_${other}} link, though their duals differ")
    elseif(NOT kind STREQUAL other AND NOT are_told_apart)
      message(FATAL_ERROR "files built with ${flag_of_${kind}} and ${flag_of_${other}} fail to link for another reason:\n${log}")
    endif()
  endforeach()
endforeach()
