# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# A document must hold, word for word, what a program prints.
#
# cmake -Dprogram=<program> -Ddocument=<file> -P page.cmake

cmake_minimum_required(VERSION 3.22)

execute_process(COMMAND ${program} RESULT_VARIABLE result OUTPUT_VARIABLE output)
if(NOT result EQUAL 0)
  message("${output}")
  message(FATAL_ERROR "${program} ends with ${result}")
endif()
file(READ ${document} text)
string(FIND "${text}" "${output}" position)
if(output STREQUAL "" OR position EQUAL -1)
  message("${output}")
  message(FATAL_ERROR "${document} does not hold what ${program} prints, which is above")
endif()
