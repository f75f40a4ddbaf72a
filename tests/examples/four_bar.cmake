# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs the linkage on good and bad options.
#
# cmake -Dprogram=<four_bar> -Dfolder=<for files> -P four_bar.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

# Everything agrees with the closed forms to 1e-14 of the largest value.
set(small "([0-9.]+e-1[4-9]|0)")
set(agreement "angle_difference=${small} velocity_difference=${small} acceleration_difference=${small}\n$")
run(0 "0.55 m: crank-rocker\n.*four bar: samples=361 ${agreement}")
foreach(file IN ITEMS motion links)
  if(NOT EXISTS ${folder}/out/${file}.csv)
    message(FATAL_ERROR "no ${file}.csv")
  endif()
endforeach()
run(0 "samples=50 ${agreement}" --crossed --samples 50 --speed 20)
run(0 "double crank\n.*${agreement}" --ground 0.2 --crank 0.55 --from -100 --to 800)
run(0 "triple rocker\n.*${agreement}" --crank .3 --coupler .25 --rocker .2 --ground .4 --from 10 --to 75)
run(0 "assemble it with crossed links" --help)

run(1 "cannot close beyond a crank angle of 78.5848 degrees: a dead point"
  --crank .3 --coupler .25 --rocker .2 --ground .4)
run(1 "cannot close at a crank angle of 0 degrees" --ground 3)
run(1 "--crank is 0 .expected a positive length." --crank 0)
run(1 "--rocker is nan .expected a positive length." --rocker nan)
run(1 "--to is inf .expected a finite number." --to inf)
run(1 "--samples is 1 .expected at least 2." --samples 1)
