# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# The sources are those that this port is in. In a registry, where it stands alone, they are what
# vcpkg_from_git or vcpkg_download_distfile get.
cmake_path(SET SOURCE_PATH NORMALIZE "${CURRENT_PORT_DIR}/../../..")

vcpkg_check_features(OUT_FEATURE_OPTIONS options
  FEATURES io DUET_BUILD_IO robotics DUET_BUILD_ROBOTICS)
set(config_folder lib/cmake/duet)
if(NOT "io" IN_LIST FEATURES)
  set(config_folder share/cmake/duet)
  set(VCPKG_BUILD_TYPE release) # headers alone are the same in both
endif()

vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS -DDUET_BUILD_TESTS=OFF -DDUET_BUILD_EXAMPLES=OFF -DDUET_BUILD_PROGRAMS=OFF -DCMAKE_DISABLE_FIND_PACKAGE_assimp=ON ${options})
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH "${config_folder}")
vcpkg_fixup_pkgconfig()

file(REMOVE_RECURSE
  "${CURRENT_PACKAGES_DIR}/debug/include"
  "${CURRENT_PACKAGES_DIR}/debug/share"
  "${CURRENT_PACKAGES_DIR}/share/licenses")
file(INSTALL "${CURRENT_PORT_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
