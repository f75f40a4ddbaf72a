# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# For another processor, DUET_PROCESSOR, on a Debian machine: by clang with the libraries of the cross compiler
# g++-<processor>-linux-gnu; what is built runs under qemu-user-static, by ctest of itself. (clang takes half of
# g++'s time, and finds the headers in /usr/include, which are every processor's, behind those of the processor.)

set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR ${DUET_PROCESSOR})
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES DUET_PROCESSOR)
set(CMAKE_CXX_COMPILER clang++)
set(CMAKE_CXX_COMPILER_TARGET ${DUET_PROCESSOR}-linux-gnu)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-${DUET_PROCESSOR}-static -L /usr/${DUET_PROCESSOR}-linux-gnu)
set(DUET_LLD "" CACHE STRING "lld before LLVM 18 links neither RISC-V's libraries nor s390x")
set(CMAKE_DISABLE_FIND_PACKAGE_EXPAT ON) # pkg-config would name this machine's; no test of these reads URDF
