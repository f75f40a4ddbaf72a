# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# All headers and libraries compile with -fno-exceptions and -fno-rtti, without any build system, and with libc++ where it
# is installed; what they compute is right, and errors end in the handler, or in std::abort.
#
# cmake "-Dcompile=<compiler and flags>" [-Dother_library=-stdlib=libc++] -P without_exceptions.cmake

cmake_minimum_required(VERSION 3.22)

set(flags -fno-exceptions -fno-rtti ${other_library})
set(headers "")
set(include ${CMAKE_CURRENT_LIST_DIR}/../../include)
file(GLOB_RECURSE all RELATIVE ${include} ${include}/duet/*.hpp)
list(FILTER all EXCLUDE REGEX "/interop/")
list(TRANSFORM all REPLACE "(.+)" "#include <\\1>\n")
list(JOIN all "" headers)
file(WRITE without_exceptions_headers.hpp "${headers}")
include(${CMAKE_CURRENT_LIST_DIR}/all_sources.cmake)
write_all_sources(${include}/../src without_exceptions_sources.cpp)

list(APPEND compile ${flags} -Wall -Wextra -Werror -Wno-ignored-attributes)
execute_process(
  COMMAND ${compile} -I . -include without_exceptions_headers.hpp -c ${CMAKE_CURRENT_LIST_DIR}/without_exceptions.cpp
    -o without_exceptions.o
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(
  COMMAND ${compile} without_exceptions_sources.cpp without_exceptions.o -o without_exceptions -lexpat
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ./without_exceptions COMMAND_ERROR_IS_FATAL ANY)

# usage: expect_end(<how> <error> <fails> <regex of standard output> <regex of standard error>)
function(expect_end how error fails output_regex error_regex)
  execute_process(COMMAND ./without_exceptions ${how} ${error}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE message)
  if(result EQUAL 0)
    set(has_failed FALSE)
  else()
    set(has_failed TRUE)
  endif()
  if(NOT has_failed STREQUAL fails OR NOT output MATCHES "^${output_regex}$" OR NOT message MATCHES "^${error_regex}$")
    message(FATAL_ERROR "${how} ${error}: ended with ${result}, said:\n${output}${message}")
  endif()
endfunction()
foreach(case IN ITEMS
    "zero:duet: normalized: the quaternion is zero"
    "row:duet: spline evaluated at 9, outside its domain [^\n]*"
    "joints:duet: serial_chain: 2 coordinates [(]expected 7[)]"
    "file:duet: without_exceptions.urdf:2: mismatched tag, in <link> of line 1")
  string(REGEX MATCH "^([a-z]+):(.*)$" case "${case}")
  set(error ${CMAKE_MATCH_1})
  set(message ${CMAKE_MATCH_2})
  expect_end(handled ${error} FALSE "handled: ${message}\n" "")
  expect_end(unhandled ${error} TRUE "" "${message}\n")
endforeach()

# A handler that returns does not make the program go on. (What it wrote may be lost in std::abort.)
expect_end(returns zero TRUE "(handled: [^\n]*\n)?" "duet: normalized: the quaternion is zero\n")
