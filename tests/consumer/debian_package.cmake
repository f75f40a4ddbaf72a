# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# The Debian package of the build folder `build`: made, read, found fault with by lintian, unpacked and used.

include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)

foreach(tool IN ITEMS dpkg dpkg-deb lintian)
  find_program(${tool} ${tool})
  if(NOT ${tool})
    message("SKIPPED: there is no ${tool} (Debian: sh scripts/setup lintian)")
    return()
  endif()
endforeach()

run(${dpkg} --print-architecture)
string(STRIP "${output}" architecture)
set(depends "libeigen3-dev (>= 3.4), libboost-dev (>= 1.74), libexpat1-dev")
if(has_assimp)
  string(APPEND depends ", libassimp-dev")
endif()
run(${CMAKE_CPACK_COMMAND} -G DEB --config ${build}/CPackConfig.cmake -B ${folder})
set(package ${folder}/libduet-dev_${version}-1_${architecture}.deb)

foreach(field IN ITEMS "Package;libduet-dev" "Version;${version}-1" "Architecture;${architecture}"
    "Section;libdevel" "Depends;${depends}")
  list(POP_FRONT field name)
  run(${dpkg-deb} --field ${package} ${name})
  string(STRIP "${output}" output)
  if(NOT output STREQUAL field)
    message(FATAL_ERROR "${name} is '${output}', not '${field}'")
  endif()
endforeach()

# It closes no wish for a package, as it is not uploaded anywhere. This build is not configured for the prefix /usr,
# with which libraries go to a folder for their processor.
set(suppressed initial-upload-closes-no-bugs,pkg-config-unavailable-for-cross-compilation)
run(${lintian} --allow-root --fail-on error,warning --suppress-tags ${suppressed} ${package})
if(output MATCHES "[EW]: ")
  message(FATAL_ERROR "${output}")
endif()

run(${dpkg-deb} --extract ${package} ${folder}/system)
use_duet(${folder}/system/usr ON)
