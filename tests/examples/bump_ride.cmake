# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs the ride on good and bad options.
#
# cmake -Dprogram=<bump_ride> -Dfolder=<for files> -P bump_ride.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

# The ride by the table is that by the constraints to 1e-8 m, and keeps its energy as well as the integrator does.
run(0 "bump ride: rows=105 steps=600 height_difference=[0-9.]+e-09 energy_error=[0-9.]+e-06"
  --step 0.001)
if(NOT EXISTS ${folder}/out/ride.csv)
  message(FATAL_ERROR "no ride.csv")
endif()
run(0 "rows of the lookup table" --help)
run(0 "steps=10 height_difference=[0-9.]+e-" --bump 0 --duration 0.01 --step 0.001)

run(1 "--rows is 3 .expected at least 4." --rows 3)
run(1 "--step is 0, --duration is 0.6 .expected 0 < step <= duration." --step 0)
run(1 "--step is 0.1, --duration is 0.01" --step 0.1 --duration 0.01)
run(1 "--bump is 0.2 .expected 0 to 0.1 m" --bump 0.2)
run(1 "the argument .'often'. for option '--rows' is invalid" --rows often)
