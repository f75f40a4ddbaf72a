# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Every table that the examples wrote has as many names in its first line as columns in each row.
#
# cmake -Dfolder=<where the examples were run> -P tables.cmake

cmake_minimum_required(VERSION 3.22)

file(GLOB_RECURSE tables ${folder}/*.csv)
foreach(table IN LISTS tables)
  file(READ ${table} text)
  # Comments and empty lines, which part what is drawn apart, aside.
  string(REGEX REPLACE "#[^\n]*" "" text "${text}\n")
  string(REGEX REPLACE "\n\n+" "\n" text "${text}")
  string(REGEX REPLACE "^\n" "" text "${text}")
  if(NOT text MATCHES "^([^\n]+)\n([^\n]+)\n")
    message(FATAL_ERROR "${table} has no rows")
  endif()
  set(header "${CMAKE_MATCH_1}")
  if(header MATCHES "\"|,,|^,|,$")
    message(FATAL_ERROR "${table}: names that cannot be told apart: ${header}")
  endif()
  # Of all other lines only the commas: with those of the header they must be gone.
  string(REGEX REPLACE "[^,\n]+" "" commas "${text}")
  string(REGEX MATCH "^,*\n" of_header "${commas}")
  string(REPLACE "${of_header}" "" rest "${commas}")
  if(NOT rest STREQUAL "")
    message(FATAL_ERROR "${table} has rows with more or fewer columns than its first line: ${header}")
  endif()
endforeach()
list(LENGTH tables count)
if(count LESS least)
  message(FATAL_ERROR "${count} tables in ${folder}, fewer than ${least}")
endif()
message("${count} tables in ${folder}")
