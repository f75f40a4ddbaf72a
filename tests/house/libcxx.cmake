# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# With libc++, what tests of every kind of number and curve expect holds, and errors are caught by their types across
# the boundary of a shared library.
#
# cmake "-Dcompile=<clang and flags>" -Dproject=<folder> -Dfolder=<for files> -P libcxx.cmake

cmake_minimum_required(VERSION 3.22)

file(MAKE_DIRECTORY ${folder})
set(lines "#include \"support/main.cpp\"\n")
foreach(test IN ITEMS
    core/chars core/number_text core/parallel_for core/text_rows
    dual/algebra dual/exceptions dual/second_dual derivative/vectors
    quaternion/distance quaternion/rotation_matrix dual_quaternion/algebra dual_quaternion/pose
    spline/evaluate spline/interpolate)
  string(APPEND lines "#include \"${test}.cpp\"\n")
endforeach()
file(WRITE ${folder}/tests.cpp "${lines}")
execute_process(
  COMMAND ${compile} -I ${project}/tests -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS -Wno-ignored-attributes
    ${folder}/tests.cpp -o ${folder}/tests -pthread
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${folder}/tests COMMAND_ERROR_IS_FATAL ANY)

# (The sources of duet::robotics are compiled with it by house/without_exceptions.)
include(${CMAKE_CURRENT_LIST_DIR}/all_sources.cmake)
write_all_sources(${project}/src ${folder}/sources.cpp io)
list(APPEND compile -fPIC -pthread -Wno-ignored-attributes)
execute_process(
  COMMAND ${compile} -shared -Wl,--version-script=${project}/src/exported_symbols.map ${folder}/sources.cpp
    -o ${folder}/libduet.so -lexpat
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(
  COMMAND ${compile} ${project}/tests/consumer/files.cpp -o ${folder}/files -L ${folder} -lduet -Wl,-rpath,${folder}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${folder}/files WORKING_DIRECTORY ${folder} COMMAND_ERROR_IS_FATAL ANY)
