# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# With libc++, what tests of every kind of number and curve expect holds.
#
# cmake "-Dcompile=<clang and flags>" -Dproject=<folder> -Dfolder=<for files> -P libcxx.cmake

cmake_minimum_required(VERSION 3.22)

file(MAKE_DIRECTORY ${folder})
set(lines "#include \"support/main.cpp\"\n")
foreach(test IN ITEMS
    core/chars core/number_text core/parallel_for core/text_rows
    dual/algebra dual/exceptions dual/function_values derivative/vectors
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
