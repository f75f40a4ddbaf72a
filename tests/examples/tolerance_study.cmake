# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs the tolerance study in one process: good and bad options, and blocks of samples that are missing, damaged or
# of other settings.
#
# cmake -Dprogram=<tolerance_study> -Dfolder=<for files> -P tolerance_study.cmake

cmake_minimum_required(VERSION 3.22)

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

run(0 "standard deviation of every coordinate" --help)
run(1 "--samples is 1 .expected 2 to 10000000." --samples 1)
run(1 "--std-dev is 0 .expected more than 0, at most 0.05 m." --std-dev 0)
run(1 "--std-dev is nan .expected more than 0" --std-dev nan)
run(1 "--travel is 0.1,-0.1 .expected two heights, the lower first." --travel 0.1,-0.1)
run(1 "--travel is 0.1 .expected two heights" --travel 0.1)
run(1 "--travel: 'up' is not a finite number" --travel 0,up)
run(1 "--heights is 1 .expected 2 to 1000." --heights 1)
run(1 "--seed is -1 .expected at least 0." --seed -1)
run(1 "--threads is -1 .expected 0 to 1024." --threads -1)
run(1 "nowhere.csv: cannot be read" --hardpoints nowhere.csv)
run(1 "the rods cannot close beyond u = -0.3[0-9]+ m" --travel=-0.5,0)
string(REPEAT "rod,0,0,0,1,0,0\n" 5 rods)
file(WRITE ${folder}/rods.csv "${rods}wheel centre,0,0.95,0\n")
run(1 "the rods cannot close beyond u = 0 m" --hardpoints rods.csv)
run(1 "of blocks 0-3 in out/samples, these are missing: 0-3 .run again" --samples 1000 --heights 3 --summary)

# usage: study(<status> <text in the output> <text in the one line of errors> [<option> ...])
function(study expected_result expected_output expected_error)
  execute_process(COMMAND ${program} --out out --samples 1000 --heights 3 ${ARGN} WORKING_DIRECTORY ${folder}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
  remove_progress(error)
  if(NOT result EQUAL expected_result OR NOT output MATCHES "${expected_output}")
    message(FATAL_ERROR "${ARGN}: status ${result}, prints\n${output}${error}"
      "instead of status ${expected_result} and: ${expected_output}")
  endif()
  if(expected_error AND NOT error MATCHES "^tolerance_study: [^\n]*${expected_error}[^\n]*\n$")
    message(FATAL_ERROR "${ARGN}: says\n${error}instead of one line with: ${expected_error}")
  endif()
endfunction()

set(samples ${folder}/out/samples)
# First order and samples agree within the three standard errors that the larger of six differences may have.
study(0 "^4 of 4 blocks to compute\n1000 samples.* tie rod, carrier y +0[.]32.*blocks=4 sampled_against_linear=0[.]0[0-6][0-9]* standard_error=0[.]022\n$" ""
  --threads 1)
file(READ ${folder}/out/summary.csv whole)
file(READ ${samples}/00002.csv block)

# Existing blocks are not computed again, and the number of threads makes no difference.
file(REMOVE ${samples}/00000.csv ${samples}/00002.csv ${samples}/00003.csv ${folder}/out/summary.csv)
study(1 "^$" "blocks 0-3 in out/samples, these are missing: 0, 2-3 .run again" --summary)
study(0 "^3 of 4 blocks to compute\n" "" --threads 3)
file(READ ${folder}/out/summary.csv again)
if(NOT again STREQUAL whole)
  message(FATAL_ERROR "completed, the study says\n${again}instead of\n${whole}")
endif()
study(0 "^1000 samples" "" --summary)

study(1 "^$" "00000.csv:1: made with seed 1, not seed 2 .remove the file" --seed 2)
study(1 "^$" "00000.csv:1: made with standard deviation 5e-04, not standard deviation 0.001" --std-dev 0.001)
study(1 "^$" "00000.csv:1: made with travel -0.1 to 0.1, not travel 0 to 0.1" --travel 0,0.1)

string(REGEX REPLACE "\n[^\n]*\n$" "\n" shorter "${block}")
file(WRITE ${samples}/00002.csv "${shorter}")
study(1 "^0 of 4 blocks to compute\n$" "00002.csv: contains 255 samples .expected 256.")
string(REGEX REPLACE "\n512," "\n511," other "${block}")
file(WRITE ${samples}/00002.csv "${other}")
study(1 "^0 of 4 blocks to compute\n$" "00002.csv:2: sample 512 expected")
file(WRITE ${samples}/00002.csv "512,0,0,0,0,0,0\n")
study(1 "^$" "00002.csv:1: has no first line with the settings of the study")

# Errors too large to be solved name the first sample.
file(REMOVE_RECURSE ${folder}/out)
study(1 "^4 of 4 blocks to compute\n$" "the rods of sample [0-9]+ cannot close at u = -?[0-9.]+ m: the standard deviation is too large"
  --std-dev 0.05)
