# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# A document must hold, word for word, what a program prints, or with tables=ON every table in it: lines
# that begin with |.
#
# cmake -Dprogram=<program> [-Darguments=<separated by blanks>] -Ddocument=<file> [-Dtables=ON] -P page.cmake

cmake_minimum_required(VERSION 3.22)

separate_arguments(arguments)
execute_process(COMMAND ${program} ${arguments} RESULT_VARIABLE result OUTPUT_VARIABLE output)
if(NOT result EQUAL 0)
  message("${output}")
  message(FATAL_ERROR "${program} ends with ${result}")
endif()
set(parts "${output}")
if(tables)
  string(REGEX MATCHALL "\n(\\|[^\n]*\n)+" parts "\n${output}")
endif()
if(parts STREQUAL "")
  message(FATAL_ERROR "${program} prints nothing to compare")
endif()
file(READ ${document} text)
foreach(part IN LISTS parts)
  string(FIND "${text}" "${part}" position)
  if(position EQUAL -1)
    message("${part}")
    message(FATAL_ERROR "${document} does not hold what ${program} prints, which is above")
  endif()
endforeach()
