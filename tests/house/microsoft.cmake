# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# All headers, and the sources of the libraries, compile in plain C++20 as clang reads them for Windows in MSVC's
# stead (its ABI, its extensions, long of 32 bits, long double of 64). There is no standard library of MSVC here: MinGW's
# libstdc++ replaces it, with macros that say that clang is GNU's.
#
# cmake -Dcompile=<clang and flags> -Dinclude=<folder> -Dfolder=<for files> -P microsoft.cmake

cmake_minimum_required(VERSION 3.22)

file(GLOB standard_library /usr/lib/gcc/x86_64-w64-mingw32/*-posix/include/c++)
if(NOT standard_library)
  message("SKIPPED: g++-mingw-w64-x86-64-posix is not installed")
  return()
endif()

# Beside the libraries of headers alone there are those of another C library in /usr/include.
file(MAKE_DIRECTORY ${folder})
file(CREATE_LINK /usr/include/boost ${folder}/boost SYMBOLIC)
file(CREATE_LINK /usr/include/eigen3/Eigen ${folder}/Eigen SYMBOLIC)
file(CREATE_LINK /usr/include/eigen3/unsupported ${folder}/unsupported SYMBOLIC)

file(GLOB_RECURSE headers RELATIVE ${include} ${include}/duet/*.hpp)
list(FILTER headers EXCLUDE REGEX "/interop/ceres") # which need Ceres
list(TRANSFORM headers REPLACE "(.+)" "#include <\\1>")
list(JOIN headers "\n" lines)
file(WRITE ${folder}/everything.cpp "${lines}\n")
include(${CMAKE_CURRENT_LIST_DIR}/all_sources.cmake)
write_all_sources(${include}/../src ${folder}/sources.cpp)

list(APPEND compile --target=x86_64-pc-windows-msvc -fms-compatibility -fms-extensions -fms-compatibility-version=19.30
  -DDUET_PORTABLE -DDUET_WITHOUT_EXPAT -Wall -Wextra -Werror -Wno-ignored-attributes -Wno-unknown-attributes
  -nostdinc++ -isystem ${standard_library} -isystem ${standard_library}/x86_64-w64-mingw32
  -isystem /usr/share/mingw-w64/include -isystem ${folder}
  # What MinGW's headers ask for; and type_info::raw_name, which Boost finds in MSVC's library alone.
  -fgnuc-version=12.2.0 -D__MINGW32__ -D__MINGW64__ -D__MSVCRT__ -D__declspec=__declspec
  -D__GLIBCXX_TYPE_INT_N_0=__int128 -D__GLIBCXX_BITSIZE_INT_N_0=128
  -DBOOST_TYPE_INDEX_FORCE_NO_RTTI_COMPATIBILITY)
execute_process(COMMAND ${compile} -fsyntax-only ${folder}/everything.cpp COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${compile} -fsyntax-only ${folder}/sources.cpp COMMAND_ERROR_IS_FATAL ANY)
list(LENGTH headers count)
message("${count} headers and all sources compile as for MSVC")
