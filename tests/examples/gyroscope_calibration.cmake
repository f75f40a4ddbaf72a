# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs the calibration of a gyroscope: the offset of the clock is found to a microsecond, errors are within their
# bounds, and Ceres and duet agree. Bad input must end with status 1, one line that says what, and nothing written.
#
# cmake -Dprogram=<gyroscope_calibration> -Dfolder=<for files> [-Ddata=<DUET_TEST_DATA>] -P gyroscope_calibration.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

set(found "offset_error=[0-9.]+e-(0[7-9]|1[0-9]) largest_error_in_bounds=(0[.][0-9]+|1[.][0-4][0-9]) difference=[0-9.]+e-(0[6-9]|1[0-9]) bounds_differ_by=[0-9.]+e-(0[89]|1[0-9])\n$")
run(0 "11981 readings over 59.9 s.*${found}")
foreach(file IN ITEMS errors readings)
  if(NOT EXISTS ${folder}/out/${file}.csv)
    message(FATAL_ERROR "no ${file}.csv")
  endif()
endforeach()
file(STRINGS ${folder}/out/errors.csv lines)
list(LENGTH lines count)
if(NOT count EQUAL 8)
  message(FATAL_ERROR "errors.csv has ${count} lines instead of a header and seven durations")
endif()
run(0 "${found}" --seed 2 --noise 1e-5)
run(0 "--noise W" --help)

run(1 "nowhere.txt: cannot be read" nowhere.txt)
run(1 "--rate is 0 .expected a positive number." --rate 0)
run(1 "--noise is -1 .expected a positive number." --noise=-1)
run(1 "unrecognised option '--bogus'" --bogus)
file(WRITE ${folder}/short.txt "0 0 0 0 0 0 0 1\n0.1 0 0 0 0 0 0 1\n0.2 0 0 0 0 0 0 1\n")
run(1 "short.txt: 3 rotations .expected at least 4." short.txt)
file(APPEND ${folder}/short.txt "0.3 0 0 0 0 0 0 1\n")
run(1 "short.txt: shorter than a second" short.txt)

if(data)
  run(0 "5998 readings over 30.0 s.*${found}" ${data}/trajectories/freiburg1_xyz-groundtruth.txt)
else()
  message("no recorded motion: DUET_TEST_DATA is not set")
endif()
