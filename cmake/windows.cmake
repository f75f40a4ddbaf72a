# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# For Windows, on a Debian machine: by clang with the libraries of the cross compiler g++-mingw-w64-x86-64-posix; what
# is built runs under Wine, by ctest of itself. (As for other processors, clang takes half of g++'s time, and finds
# the headers in /usr/include, behind those of Windows.)

set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_PREFIX_PATH /usr)
set(CMAKE_CXX_COMPILER clang++)
set(CMAKE_CXX_COMPILER_TARGET x86_64-w64-windows-gnu)
file(GLOB cross /usr/lib/gcc/x86_64-w64-mingw32/*-posix)
# (The first flag is harmless: with -Werror in CXXFLAGS CMake drops the one behind that when it looks for folders.)
set(CMAKE_CXX_FLAGS_INIT "-fexceptions -stdlib++-isystem ${cross}/include/c++ -stdlib++-isystem ${cross}/include/c++/x86_64-w64-mingw32 -Wno-unused-command-line-argument")
# The GNU linker takes minutes.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-fuse-ld=lld -static -pthread -L${cross} -B${cross}")
find_program(DUET_WINE NAMES wine64 wine PATHS /usr/lib/wine)
set(CMAKE_CROSSCOMPILING_EMULATOR
  env WINEPREFIX=${CMAKE_BINARY_DIR}/wine WINEDEBUG=-all WINEDLLOVERRIDES=mscoree,mshtml,winemenubuilder.exe= ${DUET_WINE})
set(CMAKE_DISABLE_FIND_PACKAGE_EXPAT ON) # pkg-config would name this machine's; no test of these reads URDF
