# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# What duet's own tests, examples and benchmarks are compiled with, and its users are not.

add_library(duet_development INTERFACE)
target_link_libraries(duet_development INTERFACE duet::duet)

# g++ begins to collect garbage at 128 MB, and finds little: from 2 GB on is an eighth quicker.
set(duet_compiler_memory "")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(duet_compiler_memory --param=ggc-min-heapsize=2000000)
endif()

# Warnings are errors in .ci/run only: what other releases of a compiler say should stop nobody.
#
# clang's -Wconversion includes -Wsign-conversion, g++'s does not: Eigen and std disagree on the sign
# of an index, so code that uses both would be mostly casts. g++ 12 gives false alarms: -Wrestrict and
# -Wstringop-overflow within std::string, -Warray-bounds in optimised code over dual numbers,
# -Wmaybe-uninitialized in its header of AVX-512; clang 22 objects to __COUNTER__ in the macros of
# doctest and Google Benchmark.
set(duet_warnings -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wshadow -Wnon-virtual-dtor
  -Woverloaded-virtual -Wold-style-cast)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND duet_warnings -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow -Wno-maybe-uninitialized)
elseif(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 22)
  list(APPEND duet_warnings -Wno-c2y-extensions)
endif()
target_compile_options(duet_development INTERFACE ${duet_warnings} ${duet_compiler_memory})

# It links in a fifth of the time that the GNU linker takes: the table of formulas in 0.2 s of processor time
# instead of 0.9.
find_program(DUET_LLD NAMES ld.lld)
if(DUET_LLD)
  target_link_options(duet_development INTERFACE -fuse-ld=lld)
endif()

# What tests and examples precompile is all of duet. clang 14 cannot read from there what tells the numbers of
# a formula apart: by it formulas are not precompiled.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/duet/duet.hpp)
file(STRINGS ${PROJECT_SOURCE_DIR}/include/duet/duet.hpp headers REGEX "^#include ")
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 15)
  list(FILTER headers EXCLUDE REGEX "<duet/expression/")
endif()
list(JOIN headers "\n" headers)
set(duet_to_precompile ${PROJECT_BINARY_DIR}/to_precompile.hpp)
file(CONFIGURE OUTPUT ${duet_to_precompile} CONTENT "${headers}\n")
