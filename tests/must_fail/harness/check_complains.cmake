# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs ../check.cmake on a snippet that it must not pass.
#
# cmake -Dcompile=<…> -Dsnippet=<file> -Derror_message=<regex> -P check_complains.cmake

cmake_minimum_required(VERSION 3.22)

execute_process(
  COMMAND ${CMAKE_COMMAND} "-Dcompile=${compile}" -Dsnippet=${snippet} -Dcontrol=ON
    -P ${CMAKE_CURRENT_LIST_DIR}/../check.cmake
  RESULT_VARIABLE result ERROR_VARIABLE log)
if(result EQUAL 0)
  message(FATAL_ERROR "the check passes ${snippet}")
elseif(NOT log MATCHES "${error_message}")
  message("${log}")
  message(FATAL_ERROR "the check does not say: ${error_message}")
endif()
