# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs the path following on good and bad input.
#
# cmake -Dprogram=<path_following> -Dfolder=<for files> -P path_following.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

run(0 "reason=reached turns=0.1 waypoints=" --turns 0.1)
file(STRINGS ${folder}/out/path.csv lines)
list(GET lines 0 header)
if(NOT header MATCHES "^turns,x,y,z,qw,qx,qy,qz,deviation_m,deviation_rad,joint_0,.*,joint_6$")
  message(FATAL_ERROR "path.csv begins with ${header}")
endif()
run(0 "reason=reached turns=0.1 " --robot ur5e --turns 0.1 --radius 0.02)
run(0 "reason=[a-z_]+ .*stops after [0-9.]+ of 0.2 turns" --turns 0.2 --radius 3 --robot ur5e)
run(0 "--pitch" --help)

run(1 "--robot is 'r2d2' .expected panda, iiwa14" --robot r2d2)
run(1 "--joints: 7 numbers expected, got 2" --joints 1,2)
run(1 "--joints: 'nan' is not a finite number" --joints 0,0,0,nan,0,1,0)
run(1 "joint 3 of the start is 1 .expected a finite number from" --joints 0,0,0,1,0,1,0)
run(1 "--radius is -1 .expected at least 0." --radius -1)
run(1 "--turns is 0 .expected more than 0, at most 1000." --turns 0)
run(1 "--pitch is inf .expected a finite number." --pitch inf)
run(1 "unrecognised option '--bogus'" --bogus)
