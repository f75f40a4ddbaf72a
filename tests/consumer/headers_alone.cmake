# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# The headers alone installed: a project finds them, and a message names the missing components.

include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)

set(prefix ${folder}/prefix)
configure_headers(${folder}/build ${source})
run(${CMAKE_COMMAND} --install ${folder}/build --prefix ${prefix})
use_duet(${prefix})

# That find_package(<request>) fails with these words.
function(expect_refusal request words)
  file(WRITE ${folder}/refusal/CMakeLists.txt
    "cmake_minimum_required(VERSION 3.22)\nproject(refusal LANGUAGES NONE)\nfind_package(${request})\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${folder}/refusal -B ${folder}/refusal/build --fresh -G ${generator}
    -DCMAKE_PREFIX_PATH=${prefix} OUTPUT_QUIET ERROR_VARIABLE said RESULT_VARIABLE result)
  string(REGEX REPLACE "[ \n]+" " " said "${said}")
  string(FIND "${said}" "${words}" position)
  if(result EQUAL 0 OR position EQUAL -1)
    message(FATAL_ERROR "find_package(${request}) ends with ${result}, without the words\n${words}\nbut\n${said}")
  endif()
endfunction()

string(REGEX MATCHALL "[0-9]+" numbers ${version})
list(GET numbers 0 major)
list(GET numbers 1 minor)
math(EXPR next_major "${major} + 1")
math(EXPR next_minor "${minor} + 1")
math(EXPR last_major "${major} - 1")
foreach(asked IN ITEMS ${major}.${next_minor} ${next_major}.0 ${last_major}.1)
  expect_refusal("duet ${asked} REQUIRED CONFIG"
    "Could not find a configuration file for package \"duet\" that is compatible with requested version \"${asked}\".")
  expect_refusal("duet ${asked} REQUIRED CONFIG" "/duet/duetConfig.cmake, version: ${version}")
endforeach()
expect_refusal("duet REQUIRED CONFIG COMPONENTS compiled"
  "duet: was installed without the component 'compiled': configure duet with -D DUET_BUILD_COMPILED=ON")
expect_refusal("duet REQUIRED CONFIG COMPONENTS curves"
  "duet: there is no component 'curves'; the only one is 'compiled'")
