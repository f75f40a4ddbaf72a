# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs the mechanisms of the folder on good and bad options and files.
#
# cmake -Dprogram=<closed_mechanisms> -Dfolder=<for files> -P closed_mechanisms.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

# Everything agrees with the closed forms.
set(small "([0-9.]+e-1[3-9]|0)")
set(agreement "by hand: position_difference=${small} first_derivative_difference=${small} second_derivative_difference=${small}\n")
run(0 "four_bar: 3 coordinates, 5 equations\nmobility 1: counted -2, .*\n2 assembly configurations.*${agreement}complete motion: [0-9]+ positions, closed\n  rocker is dead at 1.508255565" --random-starts 20 --samples 21)
run(0 "mobility 2: counted -1, .*\n2 assembly configurations.*${agreement}" five_bar --random-starts 20 --samples 11)
run(0 "mobility 3: counted 3, .*${agreement}" delta --random-starts 5 --samples 11)
run(0 "mobility 1: counted 1, .*${agreement}" wheel_carrier --random-starts 10 --samples 11)
run(0 "mobility 0: counted 0, .*assembly configurations from 20 starts" stewart --random-starts 20)
run(0 "Closed-chain mechanisms from files" --help)

run(1 "--mechanism is 'six_bar' .expected four_bar, five_bar, delta, stewart or wheel_carrier." six_bar)
run(1 "--random-starts is 0 .expected at least 1." --random-starts 0)
run(1 "--samples is 1 .expected at least 2." --samples 1)
run(1 "duet: nowhere/four_bar.urdf: cannot be read" --files nowhere)
