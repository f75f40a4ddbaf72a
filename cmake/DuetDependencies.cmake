# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# What headers of duet need: read by the build and by the installed package alike.

include(CMakeFindDependencyMacro)

# The least version is checked by hand: Eigen's package file takes "3.4" for "3.x, 3.4 or later"
# and so refuses Eigen 5.
find_dependency(Eigen3 NO_MODULE)
if(Eigen3_VERSION VERSION_LESS 3.4)
  message(FATAL_ERROR "duet: Eigen ${Eigen3_VERSION} is too old (expected 3.4 or later)")
endif()
find_dependency(Boost 1.74)
find_dependency(Threads)
