# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs the wheel carrier on good and bad input: bad input must end with status 1, one line that says what and
# where, and nothing written.
#
# cmake -Dprogram=<wheel_carrier> -Dfolder=<for files> -P wheel_carrier.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

function(bad_table text expected_text)
  file(WRITE ${folder}/bad.csv "${text}")
  run(1 "${expected_text}" --table bad.csv)
endfunction()

set(good "u,qw,qx,qy,qz\n0,1,0,0,0\n1,0.8,0.6,0,0\n2,0.6,0.8,0,0\n3,0.28,0.96,0,0\n")
set(line "wheel carrier: rows=[0-9]+")
set(errors " delta_E_max=[0-9.e+-]+ ddelta_E_max=[0-9.e+-]+")
set(rest " ad_vs_closed_form=[0-9.e+-]+ printed_formula_error=[0-9.e+-]+\n$")

run(0 "Options" --help)
run(0 "${line}${errors}${rest}" --rows 30)
foreach(file IN ITEMS table rates errors path convergence splines spline_convergence
    configuration configuration_errors)
  if(NOT EXISTS ${folder}/out/${file}.csv)
    message(FATAL_ERROR "no ${file}.csv")
  endif()
endforeach()
file(COPY ${folder}/out/table.csv DESTINATION ${folder})
run(0 "30 rows.*natural ends.*${line}${rest}" --table table.csv)
file(WRITE ${folder}/good.csv "${good}")
run(0 "clamped ends.*${line}${rest}" --table good.csv --end-velocities 1.2,0,0,0.6,0,0)

# The rate is constant between two rows, and errors are not relative to its round-off.
file(WRITE ${folder}/two.csv "u,qw,qx,qy,qz\n0,1,0,0,0\n1,0.8,0.36,0.48,0\n")
run(0 "2 rows.* ad_vs_closed_form=([0-9.]+e-1[0-9]|0) printed" --table two.csv)

run(0 "105 rows.*both ends.*${line}${errors}${rest}" --spline quintic --end-conditions both)
run(0 "not-a-knot ends.*${line}${rest}" --table table.csv --spline rotation-vector --end-conditions not-a-knot)

run(1 "nowhere.csv: cannot be read" --table nowhere.csv)
bad_table("u,qw\n" "bad.csv:1: the header names no column qx")
bad_table("u,qw,qx,qy,qz\n" "bad.csv: holds no rows")
bad_table("u,qw,qx,qy,qz\n0,1,0,0,0\n" "bad.csv: has fewer than two rows")
bad_table("0,1,0,0,0\n" "bad.csv:1: 5 columns without a header before the first row")
bad_table("u,qw,qx,qy,qz\n0,1,0,0,0\n1,1,0,0\n" "bad.csv:3: 5 columns expected, got 4")
bad_table("u,qw,qx,qy,qz\n0,1,0,0,0\n1,1,0,0,0,0\n" "bad.csv:3: 5 columns expected, got 6")
bad_table("u,qw,qx,qy,qz\n0,1,0,0,0\n1,one,0,0,0\n" "bad.csv:3: qw is not a number: 'one'")
bad_table("u,qw,qx,qy,qz\n0,1,0,0,0\n# remark\n1,nan,0,0,0\n" "bad.csv:4: qw is nan")
bad_table("u,qw,qx,qy,qz\n0,1,0,0,0\n1,0,0,0,0\n" "bad.csv:3: .* norm 0")
bad_table("u,qw,qx,qy,qz\n0,1,0,0,0\n1,0.5,0,0,0\n" "bad.csv:3: .* norm 0.5")
bad_table("u,qw,qx,qy,qz\n0,1,0,0,0\n0,1,0,0,0\n" "bad.csv:3: parameter 0 does not increase")
bad_table("u,qw,qx,qy,qz\n0,1,0,0,0\n1,0,1,0,0\n" "bad.csv: row 2: half a turn")

run(1 ".free. .expected natural, clamped, acceleration" --end-conditions free)
run(1 ".bezier. .expected cumulative, rotation-vector" --spline bezier)
run(1 "--end-conditions both requires --spline quintic" --end-conditions both)
run(1 "a table alone has no rates at its ends" --table good.csv --end-conditions acceleration)
run(1 "needs 6 samples" --table good.csv --spline quintic --end-conditions not-a-knot)
run(1 "a table alone has no rates at its ends" --table good.csv --end-conditions clamped)
run(1 "six numbers expected, got 2" --end-velocities 1,2)
run(1 "'x' is not a finite number" --end-velocities x,0,0,0,0,0)
run(1 "--rows is 2 .expected at least 3." --rows 2)
file(WRITE ${folder}/swapped.csv "u,qx,qy,qz,qw\n0,0,0,0,1\n1,0.6,0,0,0.8\n2,0.8,0,0,0.6\n3,0.96,0,0,0.28\n")
run(0 "" --table good.csv)
file(READ ${folder}/out/rates.csv good_rates)
run(0 "" --table swapped.csv)
file(READ ${folder}/out/rates.csv swapped_rates)
if(NOT good_rates STREQUAL swapped_rates)
  message(FATAL_ERROR "the order of columns in the header is ignored")
endif()
run(1 "exclude each other" --rows 30 --table good.csv)

set(rods "a,0.06,0.547,0.082,0.056,0.864,0.151\nb,-0.157,0.508,0.062,0.056,0.864,0.151\n")
string(APPEND rods "c,0.036,0.338,-0.133,0.029,0.842,-0.093\nd,0.723,0.599,-0.072,0,0.864,-0.156\n")
file(WRITE ${folder}/rods.csv "${rods}")
run(1 "rods.csv: 4 rods .expected five." --hardpoints rods.csv)
string(APPEND rods "e,-0.257,0.320,-0.116,-0.144,0.862,-0.056\n")
file(WRITE ${folder}/rods.csv "${rods}")
run(1 "rods.csv: there is no line `wheel centre" --hardpoints rods.csv)
file(WRITE ${folder}/rods.csv "${rods}wheel centre,0,0.95\n")
run(1 "rods.csv:6: the wheel centre is not a single row of three" --hardpoints rods.csv)
file(WRITE ${folder}/rods.csv "${rods}wheel centre,0,0.95,0\n")
run(0 "105 rows.*${line}${errors}${rest}" --hardpoints rods.csv)
run(0 "30 rows.*clamped.*${line}${errors}${rest}" --hardpoints rods.csv --table table.csv)
file(WRITE ${folder}/rods.csv "name,ax,ay,az,px,py,pz\n${rods}wheel centre,0,0.95,0\n")
run(0 "105 rows.*${line}${errors}${rest}" --hardpoints rods.csv)
file(WRITE ${folder}/rods.csv "name,px,py,pz,ax,ay,az\n${rods}wheel centre,0,0.95,0\n")
run(1 "rods.csv:1: the header differs from the columns .expected name, ax, ay, az, px, py, pz." --hardpoints rods.csv)
string(REPLACE "0.338" "0.8" rods "${rods}")
file(WRITE ${folder}/rods.csv "${rods}wheel centre,0,0.95,0\n")
run(1 "the rods cannot close beyond u = -0.[0-9]+ m" --hardpoints rods.csv)
