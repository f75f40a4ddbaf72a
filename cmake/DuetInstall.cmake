# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# Headers do not depend on the architecture, so their package files belong in share/; a library does.
set(duet_has_compiled FALSE)
set(destination ${CMAKE_INSTALL_DATADIR})
set(architecture ARCH_INDEPENDENT)
if(TARGET duet_compiled)
  set(duet_has_compiled TRUE)
  set(destination ${CMAKE_INSTALL_LIBDIR})
  set(architecture "")
  install(TARGETS duet_compiled EXPORT duetTargets)
endif()

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/duet DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS duet EXPORT duetTargets)
install(EXPORT duetTargets NAMESPACE duet:: DESTINATION ${destination}/cmake/duet)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/duetConfig.cmake.in
  ${PROJECT_BINARY_DIR}/duetConfig.cmake INSTALL_DESTINATION ${destination}/cmake/duet)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/duetConfigVersion.cmake
  COMPATIBILITY SameMajorVersion ${architecture})
install(FILES
  ${PROJECT_BINARY_DIR}/duetConfig.cmake
  ${PROJECT_BINARY_DIR}/duetConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/DuetDependencies.cmake
  DESTINATION ${destination}/cmake/duet)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/licenses/duet)

# For pkg-config. All paths in there are relative to the file, so that it may be moved with what it names.
set(pkgconfig_folder ${destination}/pkgconfig)
cmake_path(ABSOLUTE_PATH pkgconfig_folder BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX} OUTPUT_VARIABLE full_folder)
file(RELATIVE_PATH from_pkgconfig_to_prefix ${full_folder} ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" from_pkgconfig_to_prefix ${from_pkgconfig_to_prefix})
file(RELATIVE_PATH from_prefix_to_headers ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
file(RELATIVE_PATH from_prefix_to_library ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_LIBDIR})
# Of what Eigen's own file says with -I compilers would tell warnings. A folder that is also named as one of the system is that.
# Only where that is the same on every machine; a folder that is not there does no harm.
get_target_property(eigen_as_system Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
if(eigen_as_system MATCHES "^/usr/(local/)?include/[^;]+$")
  string(PREPEND eigen_as_system " -isystem ")
else()
  set(eigen_as_system "")
endif()
set(expat_as_required "")
if(TARGET EXPAT::EXPAT)
  set(expat_as_required ", expat")
endif()
set(pkgconfig_names duet)
if(TARGET duet_compiled)
  list(APPEND pkgconfig_names duet-compiled)
endif()
foreach(name IN LISTS pkgconfig_names)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${pkgconfig_folder})
endforeach()
