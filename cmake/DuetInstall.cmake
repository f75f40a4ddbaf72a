# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# Headers do not depend on the architecture, so their package files belong in share/; a library does.
set(destination ${CMAKE_INSTALL_DATADIR}/cmake/duet)
set(architecture ARCH_INDEPENDENT)
if(TARGET duet_compiled)
  set(destination ${CMAKE_INSTALL_LIBDIR}/cmake/duet)
  set(architecture "")
  install(TARGETS duet_compiled EXPORT duetTargets)
endif()

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/duet DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS duet EXPORT duetTargets)
install(EXPORT duetTargets NAMESPACE duet:: DESTINATION ${destination})

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/duetConfig.cmake.in
  ${PROJECT_BINARY_DIR}/duetConfig.cmake INSTALL_DESTINATION ${destination})
# SameMinorVersion: until 1.0 every minor version may break the one before.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/duetConfigVersion.cmake
  COMPATIBILITY SameMinorVersion ${architecture})
install(FILES
  ${PROJECT_BINARY_DIR}/duetConfig.cmake
  ${PROJECT_BINARY_DIR}/duetConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/DuetDependencies.cmake
  DESTINATION ${destination})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/licenses/duet)
