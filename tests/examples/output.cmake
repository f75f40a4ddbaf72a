# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Output to a full device, to pipes, links and paths that are not folders. The status of a program tells whether all
# output was written, standard output included; after a signal all files are complete.
#
# cmake -Dprograms=<folder of the examples> -Dfolder=<for files> -P output.cmake

cmake_minimum_required(VERSION 3.22)

if(NOT EXISTS /dev/full)
  message("skipped: there is no /dev/full")
  return()
endif()
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})

set(tools wheel_carrier/wheel_carrier screw_motion/screw_motion fit_trajectory/fit_trajectory
  path_following/path_following bump_ride/bump_ride tolerance_study/tolerance_study motion_plan/motion_plan
  four_bar/four_bar robot_tree/robot_tree workspace_sweep)

# Runs a script of the shell, in which $tool is a program.
function(shell tool expected_result expected_error script)
  set(ENV{tool} ${programs}/${tool})
  execute_process(COMMAND sh -euc "${script}" WORKING_DIRECTORY ${folder}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
  string(REGEX REPLACE "progress: [^\n]*\n" "" error "${error}")
  if(NOT result EQUAL expected_result OR NOT error MATCHES "^${expected_error}$")
    message(FATAL_ERROR "${tool}: ${script}: status ${result}, says\n${output}${error}"
      "instead of status ${expected_result} and: ${expected_error}")
  endif()
endfunction()

foreach(tool IN LISTS tools ITEMS inverse_kinematics robot_arm)
  cmake_path(GET tool FILENAME name)
  shell(${tool} 1 "${name}: standard output: not all of it could be written\n" "\"$tool\" --help >/dev/full")
  shell(${tool} 1 "${name}: unrecognised option '--a.x1b.2J.nb'\n" "\"$tool\" --\"$(printf 'a\\033[2J\\nb')\"")
endforeach()
foreach(name IN ITEMS formula_to_latex arm_as_formula)
  shell(${name} 1 "${name}: standard output: not all of it could be written\n" "\"$tool\" >/dev/full")
endforeach()

# What cannot be a folder is found before the work, and left as it is.
file(WRITE ${folder}/file "kept\n")
file(CREATE_LINK nowhere/folder ${folder}/dangling SYMBOLIC)
foreach(tool IN LISTS tools)
  cmake_path(GET tool FILENAME name)
  foreach(out IN ITEMS /dev/full file dangling)
    shell(${tool} 1 "${name}: ${out}: is not a folder\n" "\"$tool\" --out ${out}")
  endforeach()
  shell(${tool} 1 "${name}: file/a/b: file is not a folder\n" "\"$tool\" --out file/a/b")
  shell(${tool} 1 "${name}: --out is empty .expected a folder.\n" "\"$tool\" --out ''")
endforeach()
foreach(name IN ITEMS tolerance_study/tolerance_study workspace_sweep)
  shell(${name} 1 "[a-z_]+: file: is not a folder\n" "\"$tool\" --samples 10000000 --out file")
endforeach()
shell(inverse_kinematics 1 "inverse_kinematics: duet: none/a.csv: cannot be written: No such file or directory\n"
  "\"$tool\" --out none/a.csv")
shell(inverse_kinematics 1 "inverse_kinematics: duet: /dev/full: cannot be written: No space left on device\n"
  "\"$tool\" --out /dev/full")
shell(screw_motion/screw_motion 0 "" "
  test -c /dev/full
  test \"$(cat file)\" = kept
  test -L dangling
  test ! -e nowhere
  mkdir closed
  chmod a-w closed
  if test ! -w closed; then # who is root may
    ! \"$tool\" --out closed/out 2>message
    test \"$(cat message)\" = 'screw_motion: closed/out: cannot write to the folder closed'
  fi")

# Standard output by name, with what else is printed.
foreach(out IN ITEMS /dev/stdout both.txt)
  shell(inverse_kinematics 0 "" "
    \"$tool\" --out ${out} >both.txt
    grep -q '^q0,q1,' both.txt
    tail -n 1 both.txt | grep -q '^inverse kinematics: reached=1'")
endforeach()

# Pipes and links stay what they are.
shell(screw_motion/screw_motion 0 "" "
  mkdir piped
  mkfifo piped/frames.csv
  cat piped/frames.csv >frames.csv &
  PATH=/nowhere \"$tool\" --out piped # gnuplot would wait for somebody to write to the pipe again
  wait $!
  test -p piped/frames.csv
  test \"$(wc -l <frames.csv)\" -gt 10
  mkdir out elsewhere
  ln -s out link
  ln -s ../elsewhere/path.csv ../elsewhere/path.svg out
  GNUTERM=none \"$tool\" --out link # an environment that gnuplot cannot obey
  test -L link
  test -L out/path.csv
  test \"$(head -n 1 elsewhere/path.csv | cut -c 1-3)\" = tau
  test \"$(wc -l <elsewhere/path.csv)\" = 62
  if test -e out/path.png; then # by gnuplot
    test -L out/path.svg
    tail -n 1 elsewhere/path.svg | grep -q '</svg>\\|^$'
  fi
  test -z \"$(find . -name '.duet-*')\"")

# A picture that cannot be drawn is missed, unless gnuplot is not there.
file(WRITE ${folder}/failing/gnuplot "#!/bin/sh\nexit 1\n")
file(CHMOD ${folder}/failing/gnuplot PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
shell(screw_motion/screw_motion 1 "screw_motion: gnuplot fails to draw none/path.gnuplot\n" "
  PATH=$PWD/failing:$PATH \"$tool\" --out none")
shell(screw_motion/screw_motion 0 "" "
  PATH=/nowhere \"$tool\" --out bare >bare.txt
  grep -q '^No picture: gnuplot is not installed' bare.txt
  test \"$(ls -A bare | tr '\\n' ' ')\" = 'frames.csv path.csv path.gnuplot '
  test \"$(ls -A none | tr '\\n' ' ')\" = 'frames.csv path.csv path.gnuplot '")

# A signal while pictures are drawn leaves no part of a picture under its name, and one while samples are computed whole
# blocks. Temporary files may remain.
file(WRITE ${folder}/tools/gnuplot "#!/bin/sh\ntouch drawing\nuntil test -e enough; do sleep 0.1; done\n")
file(CHMOD ${folder}/tools/gnuplot PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
shell(screw_motion/screw_motion 0 "" "
  PATH=$PWD/tools:$PATH \"$tool\" --out killed &
  until test -e killed/drawing; do sleep 0.1; kill -0 $!; done
  kill -TERM $!
  ended=0
  wait $! 2>/dev/null || ended=$?
  touch killed/enough
  test $ended = 143
  test -z \"$(find killed -name '*.svg' -o -name '*.png')\"")
shell(tolerance_study/tolerance_study 0 "" "
  \"$tool\" --samples 1000000 --heights 2 --out blocks 2>/dev/null &
  until ls blocks/samples 2>/dev/null | grep -q csv$; do sleep 0.1; kill -0 $!; done
  kill -TERM $!
  ended=0
  wait $! 2>/dev/null || ended=$?
  test $ended = 143
  for block in blocks/samples/*; do
    test \"$(wc -l <$block)\" = 257
  done")
