# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Writes a file that includes all sources of the libraries, or of those named: what they share is then compiled once.
# (That each compiles alone is seen by consumer/add_subdirectory.)
#
# usage: write_all_sources(<src> <file> [<library>...])
function(write_all_sources src file)
  set(libraries ${ARGN})
  if(NOT libraries)
    set(libraries io robotics)
  endif()
  set(lines "")
  foreach(library IN LISTS libraries)
    file(GLOB sources ${src}/${library}/*.cpp)
    foreach(source IN LISTS sources)
      cmake_path(ABSOLUTE_PATH source NORMALIZE)
      string(APPEND lines "#include \"${source}\"\n")
    endforeach()
  endforeach()
  file(WRITE ${file} "${lines}")
endfunction()
