# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Without any build system: a compiler, the headers, and the sources of a library where a program needs it. (Those of
# duet::robotics are compiled so by house/without_exceptions.)
#
# cmake "-Dcompile=<compiler and flags>" -Dsource=<top of the project> -Dfolder=<for files> -P plain.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
file(GLOB sources ${source}/src/io/*.cpp)
run(${compile} ${CMAKE_CURRENT_LIST_DIR}/headers.cpp -o ${folder}/headers)
run(${compile} ${CMAKE_CURRENT_LIST_DIR}/files.cpp ${sources} -o ${folder}/files -lexpat -pthread)
foreach(program IN ITEMS headers files)
  run(${folder}/${program})
endforeach()
