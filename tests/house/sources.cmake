# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# All sources of duet::robotics are read without a warning.
#
# cmake "-Dcompile=<compiler and flags>" "-Dwarnings=<flags>" -Dsrc=<folder> -P sources.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/all_sources.cmake)
write_all_sources(${src} sources.cpp robotics)
execute_process(COMMAND ${compile} ${warnings} -Werror -fsyntax-only sources.cpp COMMAND_ERROR_IS_FATAL ANY)
