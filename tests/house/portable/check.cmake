# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Without the compiler's extensions results have the same digits, and a compiler without them is
# detected.
#
# cmake -Dcompile=<compiler and flags> -Dtarget=<core/compiler/target.hpp> -P check.cmake

cmake_minimum_required(VERSION 3.22)

foreach(way IN ITEMS extended plain)
  set(flag "")
  if(way STREQUAL plain)
    set(flag -DDUET_PORTABLE)
  endif()
  execute_process(COMMAND ${compile} ${flag} ${CMAKE_CURRENT_LIST_DIR}/digits.cpp -o digits_${way}
    COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ./digits_${way} OUTPUT_VARIABLE digits_${way} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
if(NOT digits_extended MATCHES "0x1[.].*\n7722 numbers\n$")
  message(FATAL_ERROR "digits.cpp does not print what it should")
endif()
if(NOT digits_extended STREQUAL digits_plain)
  file(WRITE digits_extended.txt "${digits_extended}")
  file(WRITE digits_plain.txt "${digits_plain}")
  message(FATAL_ERROR "results differ: digits_extended.txt, digits_plain.txt")
endif()

execute_process(COMMAND ${compile} -U__GNUC__ -U__clang__ -E -dM ${target} OUTPUT_VARIABLE macros
  COMMAND_ERROR_IS_FATAL ANY)
if(NOT macros MATCHES "#define DUET_PORTABLE")
  message(FATAL_ERROR "a compiler that is neither g++ nor clang is taken for one")
endif()
