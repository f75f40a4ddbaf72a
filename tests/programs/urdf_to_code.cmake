# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# duet-urdf-to-code: its code compiles without a warning, and what it says to wrong options and files.
#   cmake -D program=<program> -D source=<duet> -D folder=<scratch folder> -P urdf_to_code.cmake

set(robot ${source}/examples/motion_plan/folding_arm/folding_arm.urdf)

function(run_program expected_status)
  execute_process(COMMAND ${program} ${ARGN} WORKING_DIRECTORY ${folder} RESULT_VARIABLE status
    OUTPUT_VARIABLE output ERROR_VARIABLE error)
  if(NOT status EQUAL expected_status)
    message(FATAL_ERROR "${program} ${ARGN}: exit status ${status}\n${output}${error}")
  endif()
  set(output "${output}" PARENT_SCOPE)
  set(error "${error}" PARENT_SCOPE)
endfunction()

function(expect_error text)
  run_program(1 ${ARGN})
  string(REGEX MATCHALL "\n" lines "${error}")
  list(LENGTH lines count)
  string(FIND "${error}" "${text}" found)
  if(found LESS 0 OR NOT count EQUAL 1 OR NOT output STREQUAL "")
    message(FATAL_ERROR "${program} ${ARGN}: not one line with '${text}':\n${output}${error}")
  endif()
endfunction()

file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})
foreach(frame IN ITEMS spatial body hybrid)
  run_program(0 ${robot} link0 hand --frame ${frame} --jacobian-rate --name arm --output ${frame}.c)
  foreach(compiler IN ITEMS gcc clang)
    execute_process(COMMAND ${compiler} -std=c99 -Wall -Wextra -Werror -pedantic -c ${frame}.c -o ${frame}.o
      WORKING_DIRECTORY ${folder} RESULT_VARIABLE status ERROR_VARIABLE error)
    if(NOT status EQUAL 0)
      message(FATAL_ERROR "${compiler} ${frame}.c\n${error}")
    endif()
  endforeach()
endforeach()
run_program(0 ${robot} link0 hand --float --no-jacobian)
if(NOT output MATCHES "void forward_kinematics\\(const float theta\\[7\\], float rotation\\[9\\], float position\\[3\\]\\)")
  message(FATAL_ERROR "--float --no-jacobian:\n${output}")
endif()
run_program(0 --help)
run_program(0 --version)
expect_error("a robot description, a base and a tip are needed" ${robot})
expect_error("no link \"nowhere\"" ${robot} link0 nowhere)
expect_error("missing.urdf: cannot be read" missing.urdf link0 hand)
expect_error("--language is 'fortran'" ${robot} link0 hand --language fortran)
expect_error("--frame is 'world'" ${robot} link0 hand --frame world)
expect_error("'3x' is no name for a function" ${robot} link0 hand --name 3x)
expect_error("there is no movable joint" ${robot} hand hand)
expect_error("unrecognised option '--bogus'" ${robot} link0 hand --bogus)
