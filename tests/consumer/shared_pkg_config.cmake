# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# What pkg-config says of shared libraries.

set(names duet-robotics)
include(${CMAKE_CURRENT_LIST_DIR}/pkg_config.cmake)
