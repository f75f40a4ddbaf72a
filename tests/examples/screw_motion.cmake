# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs the screw motion on good and bad poses: bad ones must end with status 1, one line that says what and
# where, and nothing written.
#
# cmake -Dprogram=<screw_motion> -Dfolder=<for files> -P screw_motion.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

function(run_file expected_result expected_text content)
  file(WRITE ${folder}/poses.csv "${content}")
  run(${expected_result} "${expected_text}" --file poses.csv)
endfunction()

set(start 1,0,0,1,0,0,0)
run(0 "kind=screw angle=2.5477 translation=0.620688 ad_vs_closed_form=[0-9.]+e-1[56]\n$")
run(0 "kind=screw angle=-3.73548 translation=0.620688" --longer-arc)
run(0 "^The poses are the same" --from ${start} --to ${start})
run(0 "^A translation by 3 along \\(0, 0, 1\\)" --from ${start} --to 1,0,3,1,0,0,0)
run(0 "both arcs have the same length" --from ${start} --to 1,0,0,0,0,0,1)
run(0 "A rotation by 1.5708 rad \\(90 degrees\\) about the line through \\(0.5, -0.5, 0\\) along \\(0, 0, 1\\)"
  --from ${start} --to 0,-1,0,0,1,0,0,0,0,0,1,0)
run(0 "--longer-arc" --help)
run_file(0 "kind=translation angle=0 translation=1" "x,y,z,qw,qx,qy,qz\n0,0,0,1,0,0,0\n0,0,1,1,0,0,0\n")

run(1 "--to: the quaternion has norm 2, not 1" --from ${start} --to 1,0,0,2,0,0,0)
run(1 "--to: 7 numbers .* expected, got 6" --from ${start} --to 1,0,0,1,0,0)
run(1 "--from: 'nan' is not a finite number" --from 1,0,nan,1,0,0,0 --to ${start})
run(1 "--from: .*not a rotation: .*det R = -1" --from 1,0,0,0,0,1,0,0,0,0,-1,0 --to ${start})
run(1 "--from requires --to" --from ${start})
run(1 "--to requires --from" --to ${start})
run(1 "--steps is 0 .expected at least 1." --steps 0)
run(1 "unrecognised option '--bogus'" --bogus)
run_file(0 "kind=translation angle=0 translation=1" "qx,qy,qz,qw,x,y,z\n0,0,0,1,0,0,0\n0,0,0,1,0,0,1\n")
run_file(1 "poses.csv:1: the header names no column qw" "x,y,z,q0,q1,q2,q3\n0,0,0,1,0,0,0\n0,0,1,1,0,0,0\n")
run(1 "missing.csv: cannot be read" --file missing.csv)
run_file(1 "poses.csv:2: the quaternion has norm 0, not 1" "0,0,0,1,0,0,0\n0,0,1,0,0,0,0\n")
run_file(1 "poses.csv:2: column 5 is inf" "0,0,0,1,0,0,0\n0,0,0,1,inf,0,0\n")
run_file(1 "poses.csv: two poses are needed, not 1" "0,0,0,1,0,0,0\n")
