# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Ceres for tests, examples and benchmarks: the target Ceres::ceres, if it is installed.
#
# The configuration files of Debian's glog, which those of Ceres need, look for the libunwind of nongnu.org. Where LLVM's
# is installed instead, as for libc++, they fail, although libraries and headers are there: these are then taken.

set(CMAKE_MESSAGE_LOG_LEVEL WARNING) # Ceres names all of SuiteSparse
find_package(Ceres 2.1 QUIET)
unset(CMAKE_MESSAGE_LOG_LEVEL)
if(NOT TARGET Ceres::ceres AND NOT CMAKE_CROSSCOMPILING)
  find_path(DUET_CERES_INCLUDE ceres/manifold.h)
  find_path(DUET_GLOG_INCLUDE glog/logging.h)
  find_library(DUET_CERES_LIBRARY NAMES libceres.so libceres.dylib)
  find_library(DUET_GLOG_LIBRARY NAMES libglog.so libglog.dylib)
  if(DUET_CERES_INCLUDE AND DUET_GLOG_INCLUDE AND DUET_CERES_LIBRARY AND DUET_GLOG_LIBRARY)
    add_library(Ceres::ceres UNKNOWN IMPORTED)
    set_target_properties(Ceres::ceres PROPERTIES IMPORTED_LOCATION ${DUET_CERES_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES "${DUET_CERES_INCLUDE};${DUET_GLOG_INCLUDE}"
      INTERFACE_LINK_LIBRARIES "${DUET_GLOG_LIBRARY};Eigen3::Eigen;Threads::Threads")
  endif()
endif()
if(TARGET Ceres::ceres)
  get_target_property(CERES_INCLUDE_DIRS Ceres::ceres INTERFACE_INCLUDE_DIRECTORIES)
else()
  message(STATUS "duet: Ceres 2.1 or newer not found, tests, examples and benchmarks are built without it")
endif()
