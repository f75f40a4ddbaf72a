# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Runs the tolerance study in one, two and three processes: the results must be the same. Then one of three is killed
# while it computes: what is missing is named, and computed by the next run.
#
# cmake -Dprogram=<tolerance_study> -Dfolder=<for files> -Dmpirun=<mpirun, or empty> -P tolerance_study_processes.cmake

cmake_minimum_required(VERSION 3.22)

if(NOT mpirun)
  message("skipped: the tolerance study was built without Boost.MPI")
  return()
endif()

# Open MPI wants to be asked before it runs as root, and before it runs more processes than there are cores.
set(ENV{OMPI_ALLOW_RUN_AS_ROOT} 1)
set(ENV{OMPI_ALLOW_RUN_AS_ROOT_CONFIRM} 1)
set(ENV{OMPI_MCA_rmaps_base_oversubscribe} 1)

file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})
set(options --samples 1000 --heights 3)

function(require_equal first second)
  file(READ ${folder}/${first} a)
  file(READ ${folder}/${second} b)
  if(NOT a STREQUAL b)
    message(FATAL_ERROR "${first} holds\n${a}${second} holds\n${b}")
  endif()
endfunction()

execute_process(COMMAND ${program} ${options} --out alone WORKING_DIRECTORY ${folder} OUTPUT_VARIABLE alone
  COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "alone" "OUT" alone "${alone}")
foreach(count IN ITEMS 1 2 3)
  execute_process(COMMAND ${mpirun} -n ${count} ${program} ${options} --out out${count} WORKING_DIRECTORY ${folder}
    OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "out${count}" "OUT" output "${output}")
  if(NOT output STREQUAL alone)
    message(FATAL_ERROR "${count} processes print\n${output}instead of\n${alone}")
  endif()
  require_equal(out${count}/summary.csv alone/summary.csv)
  require_equal(out${count}/samples/00003.csv alone/samples/00003.csv)
endforeach()

# What is wrong in the first process is said once, and ends all.
execute_process(COMMAND ${mpirun} -n 3 ${program} ${options} --seed 2 --out out3 WORKING_DIRECTORY ${folder}
  RESULT_VARIABLE result ERROR_VARIABLE error OUTPUT_QUIET)
string(REGEX MATCHALL "tolerance_study: duet: out3/samples/00000.csv:1: made with seed 1, not seed 2" said "${error}")
list(LENGTH said times)
if(NOT result EQUAL 1 OR NOT times EQUAL 1)
  message(FATAL_ERROR "status ${result}\n${error}")
endif()

# The second of three processes computes block 1 and is killed when it comes to write it, which it cannot before: it
# runs in another folder, where the file is a pipe that nobody reads. The others have written their blocks.
list(JOIN options " " words)
file(WRITE ${folder}/kill.sh "
set -eu
mkdir -p other/killed/samples
mkfifo other/killed/samples/00001.csv
\"$1\" -n 3 sh -c '
  if [ \${OMPI_COMM_WORLD_RANK:-$PMI_RANK} = 1 ]; then
    cd other
    echo $$ >pid
  fi
  exec \"$@\"' sh \"$2\" ${words} --out killed &
run=$!
until [ -s other/pid ] && [ -e killed/samples/00000.csv ] && [ -e killed/samples/00002.csv ] &&
      [ -e killed/samples/00003.csv ]; do
  kill -0 $run
  sleep 0.1
done
kill -9 \"$(cat other/pid)\"
if wait $run; then
  echo 'a process was killed, yet mpirun succeeded'
  exit 3
fi
")
execute_process(COMMAND sh kill.sh ${mpirun} ${program} WORKING_DIRECTORY ${folder}
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "status ${result}\n${output}${error}")
endif()
if(EXISTS ${folder}/killed/summary.csv)
  message(FATAL_ERROR "a block is missing, yet there is a summary")
endif()
execute_process(COMMAND ${program} ${options} --out killed --summary WORKING_DIRECTORY ${folder}
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
if(NOT result EQUAL 1 OR NOT error MATCHES "(^|\n)tolerance_study: of blocks 0-3 in killed/samples, these are missing: 1 .run again")
  message(FATAL_ERROR "status ${result}\n${output}${error}")
endif()
execute_process(COMMAND ${mpirun} -n 2 ${program} ${options} --out killed WORKING_DIRECTORY ${folder}
  OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
if(NOT output MATCHES "^1 of 4 blocks to compute\n")
  message(FATAL_ERROR "the second run prints\n${output}")
endif()
require_equal(killed/summary.csv alone/summary.csv)
