# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Without any build system: a compiler, the headers, and the sources of the libraries where a program needs them.
#
# cmake "-Dcompile=<compiler and flags>" -Dsource=<top of the project> -Dfolder=<for files> -P plain.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
file(GLOB sources ${source}/src/*/*.cpp)
run(${compile} ${CMAKE_CURRENT_LIST_DIR}/headers.cpp -o ${folder}/headers)
run(${compile} ${CMAKE_CURRENT_LIST_DIR}/planning.cpp ${sources} -o ${folder}/planning -lexpat -pthread)
foreach(program IN ITEMS headers planning)
  run(${folder}/${program})
endforeach()
