# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Shared libraries: their names have the whole version, as layouts may change in any release, and their symbols
# are duet's own.

include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)

run(${CMAKE_COMMAND} --install ${build} --prefix ${folder}/prefix)
foreach(name IN ITEMS duet_io duet_robotics)
  file(GLOB_RECURSE library ${folder}/prefix/lib*/lib${name}.so.${version})
  if(NOT library)
    message(FATAL_ERROR "there is no lib${name}.so.${version} below ${folder}/prefix")
  endif()
  run(${objdump} -p ${library})
  if(NOT output MATCHES "SONAME +lib${name}[.]so[.]${version}\n")
    message(FATAL_ERROR "${library} has another name:\n${output}")
  endif()
  run(${nm} -D --defined-only ${library})
  if(NOT output MATCHES " T _ZN4duet")
    message(FATAL_ERROR "${library} exports no function of duet")
  endif()
  string(REGEX MATCHALL " [A-Za-z] [^\n]*" symbols "${output}")
  list(FILTER symbols EXCLUDE REGEX " (_ZNK?4duet|_ZT[IVS]N4duet)")
  if(symbols)
    message(FATAL_ERROR "${library} exports symbols of others: ${symbols}")
  endif()
endforeach()
use_duet(${folder}/prefix ON)
