# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# The Debian package: made, read, found fault with by lintian, unpacked and used.

include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)

foreach(tool IN ITEMS dpkg-deb lintian)
  find_program(${tool} ${tool})
  if(NOT ${tool})
    message("SKIPPED: there is no ${tool} (Debian: sh scripts/setup lintian)")
    return()
  endif()
endforeach()

configure_headers(${folder}/build ${source})
run(${CMAKE_CPACK_COMMAND} -G DEB --config ${folder}/build/CPackConfig.cmake -B ${folder})
set(package ${folder}/libduet-dev_${version}-1_all.deb)

foreach(field IN ITEMS "Package;libduet-dev" "Version;${version}-1" "Architecture;all" "Section;libdevel"
    "Depends;libeigen3-dev (>= 3.4), libboost-dev (>= 1.74), libexpat1-dev")
  list(POP_FRONT field name)
  run(${dpkg-deb} --field ${package} ${name})
  string(STRIP "${output}" output)
  if(NOT output STREQUAL field)
    message(FATAL_ERROR "${name} is '${output}', not '${field}'")
  endif()
endforeach()

# It closes no wish for a package, as it is not uploaded anywhere.
run(${lintian} --allow-root --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs ${package})
if(output MATCHES "[EW]: ")
  message(FATAL_ERROR "${output}")
endif()

run(${dpkg-deb} --extract ${package} ${folder}/system)
use_duet(${folder}/system/usr)
