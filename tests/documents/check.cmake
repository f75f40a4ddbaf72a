# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Compiles and runs every ```cpp block of a document that has a main(). Where a ```text block
# follows, with nothing but blank lines between, it must be what the program prints. Other blocks
# are excerpts for the eye and are not compiled.
#
# A program that begins with duet/duet.hpp, as all do that can, is given this header precompiled and the instantiations
# that tests share, but no other header: it must include what else it needs. One that includes a header of duet/io or
# duet/robotics is linked to the libraries, one that includes duet/interop/ceres to Ceres, without which it is left out;
# others must do without.
#
# cmake -Dcompile=<compiler and flags> -Ddocument=<file> -Dprecompiled=<header> -Dlibraries=<files and flags>
#   -Dceres=<flags> -Dinstantiated=<header> -Doptimised=<object files> -Dfolder=<for programs> -P check.cmake

cmake_minimum_required(VERSION 3.22)

set(fence "\n```")
file(READ ${document} rest)
file(MAKE_DIRECTORY ${folder})
set(count 0)

# Moves what stands before `mark` from `rest` to `taken`; `found` says whether there is a mark.
macro(take_until mark)
  string(FIND "${rest}" "${mark}" position)
  if(position EQUAL -1)
    set(found FALSE)
  else()
    set(found TRUE)
    string(SUBSTRING "${rest}" 0 ${position} taken)
    string(LENGTH "${mark}" length)
    math(EXPR position "${position} + ${length}")
    string(SUBSTRING "${rest}" ${position} -1 rest)
  endif()
endmacro()

while(TRUE)
  take_until("${fence}cpp\n")
  if(NOT found)
    break()
  endif()
  take_until("${fence}")
  set(code "${taken}\n")
  if(NOT code MATCHES "int main\\(")
    continue()
  endif()
  math(EXPR count "${count} + 1")
  set(program ${folder}/snippet_${count})
  file(WRITE ${program}.cpp "${code}")
  set(include "")
  set(link "")
  if(precompiled AND code MATCHES "^\n*#include <duet/duet.hpp>\n")
    set(include -include ${precompiled} -include ${instantiated})
    set(link ${optimised})
  endif()
  if(code MATCHES "#include <duet/(io|robotics)[/.]")
    list(APPEND link ${libraries})
  endif()
  if(code MATCHES "#include <duet/interop/ceres")
    if(NOT ceres)
      message("program ${count} is left out: there is no Ceres")
      continue()
    endif()
    list(APPEND link ${ceres})
  endif()
  if(code MATCHES "judge_cost_function") # else it would run for longer than that takes
    list(APPEND link -O1)
  endif()
  execute_process(
    COMMAND ${compile} -Wall -Wextra -Werror ${include} ${program}.cpp -o ${program} ${link}
    RESULT_VARIABLE result ERROR_VARIABLE log)
  if(NOT result EQUAL 0)
    message("${code}\n${log}")
    message(FATAL_ERROR "program ${count} of ${document} does not compile")
  endif()
  execute_process(COMMAND ${program}
    WORKING_DIRECTORY ${folder} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE log)
  if(NOT result EQUAL 0)
    message("${output}\n${log}")
    message(FATAL_ERROR "program ${count} of ${document} ends with ${result}")
  endif()
  if(rest MATCHES "^\n+```text\n")
    take_until("${fence}text\n")
    take_until("${fence}")
    if(NOT output STREQUAL "${taken}\n")
      message("It prints\n${output}\nbut the document says\n${taken}\n")
      message(FATAL_ERROR "program ${count} of ${document} does not print what follows it")
    endif()
  endif()
endwhile()
message("${count} programs of ${document} compiled and run")
