# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# The headers alone installed: a project finds them, and a message names the missing components.

include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)

set(prefix ${folder}/prefix)
configure_headers(${folder}/build ${source})
run(${CMAKE_COMMAND} --install ${folder}/build --prefix ${prefix})
use_duet(${prefix} OFF)

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
foreach(component IN ITEMS io robotics)
  string(TOUPPER ${component} option)
  expect_refusal("duet REQUIRED CONFIG COMPONENTS ${component}"
    "duet: was installed without the component '${component}': configure duet with -D DUET_BUILD_${option}=ON")
endforeach()
expect_refusal("duet REQUIRED CONFIG COMPONENTS curves"
  "duet: there is no component 'curves' (expected io or robotics)")

# Nothing of it depends on the processor.
file(GLOB folders RELATIVE ${prefix} ${prefix}/*)
if(NOT folders STREQUAL "include;share")
  message(FATAL_ERROR "headers alone install ${folders}")
endif()

file(STRINGS ${folder}/build/CPackConfig.cmake lines REGEX "CPACK_DEBIAN_PACKAGE_(ARCHITECTURE|DEPENDS)")
if(NOT lines MATCHES "ARCHITECTURE \"all\"" OR lines MATCHES "expat")
  message(FATAL_ERROR "the Debian package of headers alone says ${lines}")
endif()

# duet::robotics needs duet::io.
execute_process(COMMAND ${CMAKE_COMMAND} -S ${source} -B ${folder}/build -DDUET_BUILD_ROBOTICS=ON
  OUTPUT_QUIET ERROR_VARIABLE said RESULT_VARIABLE result)
if(result EQUAL 0 OR NOT said MATCHES "duet: DUET_BUILD_ROBOTICS needs duet::io")
  message(FATAL_ERROR "duet::robotics without duet::io is configured: ${said}")
endif()
