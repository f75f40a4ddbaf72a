# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs the inverse kinematics on goals that can be reached, on some that cannot, and on bad input: these must
# end with status 1, one line that says what and where, and nothing written.
#
# cmake -Dprogram=<inverse_kinematics> -Dfolder=<for files> -P inverse_kinematics.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

set(deviation "deviation=([0-9.]+e-(0[789]|[1-9][0-9])|0)\n$")
foreach(robot IN ITEMS panda iiwa14 ur5e baxter_left)
  run(0 "^joints [-0-9. ]+\ninverse kinematics: reached=1 of=1 iterations=[0-9]+ .*${deviation}" --robot ${robot})
endforeach()
run(0 "reached=1 of=1 iterations=[1-9]" --goal 0.4,0.2,0.3,0,1,0,0 --start 0,0,0,-1,0,1,0)
run(0 "--max-restarts" --help)

# Many goals: those that cannot be reached are named, the others written.
file(WRITE ${folder}/goals.csv "x,y,z,qw,qx,qy,qz\n0.4,0.2,0.3,0,1,0,0\n2,0,0,1,0,0,0\n\n0.5,0,0.5,0,1,0,0\n")
run(0 "^goals.csv:3: not reached \\(out_of_reach\\), .*reached=2 of=3 .*${deviation}" --goals goals.csv)
file(STRINGS ${folder}/out rows)
list(LENGTH rows count)
list(GET rows 0 header)
list(GET rows 2 missed)
if(NOT count EQUAL 4 OR NOT header STREQUAL "q0,q1,q2,q3,q4,q5,q6,is_reached,length,angle"
    OR NOT missed MATCHES "^([-0-9.e]+,)*0,[1-9.]+[0-9]*,")
  message(FATAL_ERROR "the joints are written as\n${rows}")
endif()

run(1 "--goal: not reached \\(out_of_reach\\), [0-9.]+ m and [0-9.]+ rad from it" --goal 2,0,0,1,0,0,0)
run(1 "not reached \\(singular\\)" --robot ur5e --goal 0.1,0,0.1,1,0,0,0)
run(1 "not reached \\(joint_limit\\)" --robot iiwa14 --goal 0.1,0,0.1,1,0,0,0)
run(1 "--goal: 'nan' is not a finite number" --goal 0.4,nan,0.3,0,1,0,0)
run(1 "--goal: the quaternion has norm 2, not 1" --goal 0.4,0.2,0.3,0,2,0,0)
run(1 "--goal: 7 numbers .* expected, got 6" --goal 0.4,0.2,0.3,0,1,0)
run(1 "--robot is 'puma' .expected panda, iiwa14, ur5e or baxter_left." --robot puma)
run(1 "--start: 6 numbers expected, got 7" --robot ur5e --start 0,0,0,0,0,0,0)
run(1 "--start: 'inf' is not a finite number" --start 0,0,0,inf,0,0,0)
run(1 "tolerance.translation is 0 .expected a positive number." --tolerance 0)
run(1 "restarts is -1 .expected a non-negative number." --max-restarts -1)
run(1 "unrecognised option '--bogus'" --bogus)
run(1 "exclude each other" --goals goals.csv --goal 0,0,0,1,0,0,0)
run(1 "nowhere.csv: cannot be read" --goals nowhere.csv)
file(WRITE ${folder}/bad.csv "0.4,0.2,0.3,0,1,0,0\n0.4,0.2,0.3,0,0,0,0\n")
run(1 "bad.csv:2: the quaternion has norm 0, not 1" --goals bad.csv)
file(WRITE ${folder}/bad.csv "0.4,0.2,0.3,0,1,0,0\n0.4,0.2,nan,0,1,0,0\n")
run(1 "bad.csv:2: column 3 is nan" --goals bad.csv)
