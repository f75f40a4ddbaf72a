# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Built without expat, duet::io needs no library of it, what reads XML says so, and all else works.
#
# cmake "-Dcompile=<compiler and flags>" -Dproject=<folder> -P without_expat.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/all_sources.cmake)
write_all_sources(${project}/src without_expat_sources.cpp io)
execute_process(
  COMMAND ${compile} -DDUET_WITHOUT_EXPAT -Wall -Wextra -Werror -Wno-ignored-attributes
    ${CMAKE_CURRENT_LIST_DIR}/without_expat.cpp without_expat_sources.cpp -o without_expat
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ./without_expat COMMAND_ERROR_IS_FATAL ANY)
