# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs the trajectory fit on good and bad recordings: what cannot be read must end with status 1, one line
# that says what and where, and nothing written; rows that are no poses are named and left out.
#
# cmake -Dprogram=<fit_trajectory> -Dfolder=<for files> [-Ddata=<DUET_TEST_DATA>] -P fit_trajectory.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

function(run_rows expected_result expected_text content)
  file(WRITE ${folder}/rows.txt "${content}")
  run(${expected_result} "${expected_text}" rows.txt ${ARGN})
endfunction()

# The path's y is 0.1 t; x turns.
set(rows "# timestamp tx ty tz qx qy qz qw\n")
foreach(i RANGE 39)
  math(EXPR tens "${i} / 10")
  math(EXPR ones "${i} % 10")
  string(APPEND rows "${tens}.${ones} 1 0.${tens}${ones} 0 0.6 0 0 0.8\n")
endforeach()

run(0 "rows=1201 left_out=0 controls=123 outliers=13 median_residual=0.0033")
run(0 "samples-per-knot" --help)
run_rows(0 "rows=40 left_out=0 controls=6 outliers=0" "${rows}")
foreach(file IN ITEMS trajectory rows)
  if(NOT EXISTS ${folder}/out/${file}.csv)
    message(FATAL_ERROR "no ${file}.csv")
  endif()
endforeach()
file(STRINGS ${folder}/out/trajectory.csv lines LIMIT_COUNT 102)
list(GET lines 0 header)
if(NOT header STREQUAL
    "timestamp,tx,ty,tz,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz,ax,ay,az,alphax,alphay,alphaz,sd_vx,sd_vy,sd_vz,sd_wx,sd_wy,sd_wz,sd_ax,sd_ay,sd_az,sd_alphax,sd_alphay,sd_alphaz")
  message(FATAL_ERROR "header: ${header}")
endif()
list(GET lines 101 line)
if(NOT line MATCHES "^1,(1|0.99999|1.00000)[0-9]*,0.(1|099999|100000)[0-9]*,")
  message(FATAL_ERROR "the pose after a second: ${line}")
endif()

# usage: expect_issue(<text> <rows>): named on the error stream, and the fit goes on
function(expect_issue text content)
  file(WRITE ${folder}/rows.txt "${content}")
  execute_process(COMMAND ${program} --out out rows.txt WORKING_DIRECTORY ${folder}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
  remove_progress(error)
  if(NOT result EQUAL 0 OR NOT error MATCHES "^${text}\n$")
    message(FATAL_ERROR "status ${result}, says\n${error}instead of: ${text}")
  endif()
endfunction()
expect_issue("rows.txt:42: timestamp 0.5 repeats line 7: left out" "${rows}0.5 1 0.05 0 0.6 0 0 0.8\n")
expect_issue("rows.txt:42: timestamp 0.55 is out of order: sorted in"
  "${rows}0.55 1 0.055 0 0.6 0 0 0.8\n")
expect_issue("rows.txt:42: qw is nan: left out" "${rows}4.1 1 0.41 0 0.6 0 0 nan\n")
expect_issue("rows.txt:42: tx is inf: left out" "${rows}4.1 inf 0.41 0 0.6 0 0 0.8\n")
expect_issue("rows.txt:42: the quaternion of qw, qx, qy, qz has norm 0, not 1: left out" "${rows}4.1 1 0.41 0 0 0 0 0\n")
expect_issue("rows.txt:42: tx is 1e400, beyond the range of a double: left out"
  "${rows}4.1 1e400 0.41 0 0.6 0 0 0.8\n")
expect_issue("rows.txt:42: tz is -1e-400, beyond the range of a double: left out"
  "${rows}4.1 1 0.41 -1e-400 0.6 0 0 0.8\n")

# EuRoC's files: by their header, by timestamps and commas; nanoseconds where w is last, as blanks tell. All
# are the same motion as above.
set(euroc "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n")
set(unnamed "")
set(blanks "")
string(ASCII 239 187 191 byte_order_mark)
set(swapped "${byte_order_mark}qw,qx,qy,qz,tx,ty,tz,timestamp_ms,speed\r\n")
foreach(i RANGE 39)
  math(EXPR tens "${i} / 10")
  math(EXPR ones "${i} % 10")
  math(EXPR stamp "1403636580 + ${tens}")
  string(APPEND unnamed "${stamp}${ones}00000000,1,0.${tens}${ones},0,0.8,0.6,0,0\n")
  string(APPEND blanks "${stamp}${ones}00000000.0 1 0.${tens}${ones} 0 0.6 0 0 0.8\n")
  string(APPEND swapped "0.8,0.6,0,0,1,0.${tens}${ones},0,${i}00,n/a\r\n")
endforeach()
function(expect_rotation content said)
  expect_issue("${said}" "${content}")
  file(STRINGS ${folder}/out/trajectory.csv lines LIMIT_COUNT 2)
  list(GET lines 1 line)
  if(NOT line MATCHES "^[0-9.]+,(1|0.99999|1.00000)[0-9]*,[-0-9.e]+,[-0-9.e]+,0.(6|59999|60000)[0-9]*,[-0-9.e]+,[-0-9.e]+,0.(8|79999|80000)[0-9]*,")
    message(FATAL_ERROR "after ${said} the first pose is ${line}")
  endif()
endfunction()
expect_rotation("${euroc}${unnamed}" "rows.txt: a EuRoC file: timestamps in nanoseconds")
expect_rotation("${unnamed}"
  "rows.txt: timestamps in nanoseconds: read as in EuRoC files, timestamp, x, y, z, qw, qx, qy, qz")
expect_rotation("${blanks}" "rows.txt: timestamps in nanoseconds: read as timestamp tx ty tz qx qy qz qw")
expect_rotation("${swapped}" "rows.txt: timestamps in ms")
# KITTI's, with its times and without.
set(matrices "")
set(times "")
foreach(i RANGE 39)
  math(EXPR tens "${i} / 10")
  math(EXPR ones "${i} % 10")
  string(APPEND matrices "1 0 0 1 0 0.28 -0.96 0.${tens}${ones} 0 0.96 0.28 0\n")
  string(APPEND times "${tens}.${ones}\n")
endforeach()
file(WRITE ${folder}/times.txt "${times}")
run_rows(0 "40 rows over 3.9 s.* rows=40 left_out=0" "${matrices}" --times times.txt)
expect_rotation("${matrices}" "rows.txt: 12 columns: read as in KITTI files, the matrix .R t. row by row")
run_rows(1 "rows.txt:1: the rows have times, and so does times.txt" "0 1 2 3 0 0 0 1\n" --times times.txt)
run(1 "--times requires FILE" --times times.txt)
# Its own output is as good as any.
run_rows(0 "" "${rows}")
file(COPY_FILE ${folder}/out/trajectory.csv ${folder}/again.csv)
file(COPY_FILE ${folder}/out/rows.csv ${folder}/residuals.csv)
run(0 "rows=391 left_out=0" again.csv)
run(1 "residuals.csv:1: the header names no column qw: known columns are u " residuals.csv)

run(1 "nowhere.txt: cannot be read" nowhere.txt)
run(1 "[.]: is a folder, not a file" .)
run_rows(1 "--rate: 1e[+]09 Hz over 3.9 s would make more than 10000000 poses" "${rows}" --rate 1e9)
run_rows(1 "rows.txt:2: timestamp 0.5 is not an integer number of nanoseconds .other units need a header" "${euroc}0.5,0,0,0,1,0,0,0\n")
run_rows(1 "rows.txt:2: the unit of timestamps is 'h' .expected s, ms, us or ns." "t [h],x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n")
run_rows(1 "rows.txt:2: the unit of positions is 'mm' .expected m." "t,x [mm],y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n")
run_rows(1 "rows.txt: holds no usable rows" "# nothing\n")
run_rows(1 "rows.txt: 14 usable rows .expected at least 24 for --samples-per-knot 20." "0 1 2 3 0 0 0 1\n1 1 2 3 0 0 0 1
2 1 2 3 0 0 0 1\n3 1 2 3 0 0 0 1\n4 1 2 3 0 0 0 1\n5 1 2 3 0 0 0 1\n6 1 2 3 0 0 0 1\n7 1 2 3 0 0 0 1
8 1 2 3 0 0 0 1\n9 1 2 3 0 0 0 1\n10 1 2 3 0 0 0 1\n11 1 2 3 0 0 0 1\n12 1 2 3 0 0 0 1
13 1 2 3 0 0 0 1\n" --samples-per-knot 20)
run_rows(1 "rows.txt:2: 8 columns expected, got 7" "0 1 2 3 0 0 0 1\n1 1 2 3 0 0 0\n")
run_rows(1 "rows.txt:1: 7 columns without a header before the first row .expected a header such as `u,x,y,z,qw,qx,qy,qz`" "1 1 2 3 0 0 0\n")
run_rows(1 "rows.txt:1: tx is not a number: 'one'" "0 one 2 3 0 0 0 1\n")
run(1 "--rate is 0 .expected a positive number." --rate 0)
run(1 "--samples-per-knot is 0 .expected at least 1." --samples-per-knot 0)
run(1 "'%value%': an argument must not contain %value%" --rate %value%) # once went on for ever
run(1 "unrecognised option '--bogus'" --bogus)

if(data)
  set(recorded ${data}/trajectories/freiburg1_xyz-groundtruth.txt)
  run(0 "rows=3000 left_out=0 controls=302 .* rms=0.0032" ${recorded})
else()
  message("no recorded motion: DUET_TEST_DATA is not set")
endif()
