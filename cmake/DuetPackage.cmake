# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# `cpack -G DEB` in a build folder makes the Debian package libduet-dev: headers and static libraries.

if(duet_libraries AND BUILD_SHARED_LIBS)
  return() # Debian has packages for shared libraries alone
endif()

# Without the programs, which are of one processor and link shared libraries of Boost.
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};duet;Unspecified;/")
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_SOURCE_GENERATOR "") # scripts/release makes the archive of the sources
set(CPACK_PACKAGE_CONTACT "the duet authors <duet@placeholder.invalid>" CACHE STRING
  "Who makes a package: a name and an <address>")

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_NAME libduet-dev)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4), libboost-dev (>= 1.74)")
foreach(package IN LISTS duet_io_debian)
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", ${package}")
endforeach()
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"A library of C++20 templates for those who derive formulas of motion, in
robotics, multibody dynamics and computer vision: quaternions, dual
quaternions, curves and robot arms over any scalar, with exact derivatives of
every order by dual numbers, and a judge of closed forms.")
if(NOT duet_libraries)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE all)
endif()
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian_documents.cmake)
set(CPACK_duet_CHANGELOG ${PROJECT_SOURCE_DIR}/CHANGELOG.md) # read there

include(CPack)
