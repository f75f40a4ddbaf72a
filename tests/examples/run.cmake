# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Included by scripts that run an example in ${folder}, which it empties.

cmake_path(GET program STEM name)
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})

# Progress depends on time: its lines are taken out of the standard error.
macro(remove_progress variable)
  string(REGEX REPLACE "progress: [^\n]*\n" "" ${variable} "${${variable}}")
endmacro()

# Runs ${program} with the further arguments. Status 0: it must print expected_text. Status 1: it must
# end with one line that has expected_text, and nothing written.
function(run expected_result expected_text)
  file(REMOVE_RECURSE ${folder}/out)
  execute_process(COMMAND ${program} --out out ${ARGN} WORKING_DIRECTORY ${folder}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
  remove_progress(error)
  if(NOT result EQUAL expected_result)
    message(FATAL_ERROR "${ARGN}: status ${result}, expected ${expected_result}\n${output}${error}")
  endif()
  if(expected_result EQUAL 1)
    if(NOT error MATCHES "^${name}: [^\n]*${expected_text}[^\n]*\n$")
      message(FATAL_ERROR "${ARGN}: says\n${error}instead of one line with: ${expected_text}")
    endif()
    if(EXISTS ${folder}/out)
      message(FATAL_ERROR "${ARGN}: bad input, yet something was written")
    endif()
  elseif(NOT output MATCHES "${expected_text}")
    message(FATAL_ERROR "${ARGN}: prints\n${output}without: ${expected_text}")
  endif()
endfunction()
