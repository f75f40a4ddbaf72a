# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Every header compiles alone, the private ones of src/ too. As a module of clang each sees what it includes and nothing else,
# and is read once: seconds for all, where a file for each takes minutes.
#
# cmake -Dcompile=<clang and flags> -Dinclude=<folder> -Dfolder=<for files> -P headers.cmake

cmake_minimum_required(VERSION 3.22)

file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})

# One module for each header of duet, and one for all that they include from elsewhere.
file(GLOB_RECURSE headers ${include}/duet/*.hpp ${include}/../src/*.hpp)
list(FILTER headers EXCLUDE REGEX "/interop/ceres") # which need Ceres
set(modules "")
set(outside "")
foreach(header IN LISTS headers)
  file(RELATIVE_PATH name ${include} ${header})
  string(MAKE_C_IDENTIFIER ${name} name)
  string(APPEND modules "  module ${name} { header \"${header}\" export * }\n")
  file(STRINGS ${header} includes REGEX "^#include <")
  list(FILTER includes EXCLUDE REGEX "<(duet/|arm_neon)")
  list(APPEND outside ${includes})
endforeach()
list(REMOVE_DUPLICATES outside)
# There are two of that name, C's with macros and C++'s; the compiler knows which is meant.
list(FILTER outside EXCLUDE REGEX "<math[.]h>")

# Where compilers find the latter.
list(JOIN outside "\n" lines)
file(WRITE ${folder}/outside.cpp "${lines}\n")
execute_process(COMMAND ${compile} -M ${folder}/outside.cpp OUTPUT_VARIABLE paths
  COMMAND_ERROR_IS_FATAL ANY)
set(outside_modules "")
foreach(line IN LISTS outside)
  string(REGEX REPLACE "#include <(.*)>.*" "\\1" name "${line}")
  string(REGEX REPLACE "([+.])" "[\\1]" pattern "${name}")
  string(REGEX MATCH "[^ \n]+/${pattern}[ \n]" path "${paths}")
  string(STRIP "${path}" path)
  if(path)
    string(APPEND outside_modules "  header \"${path}\"\n")
  endif()
endforeach()
file(WRITE ${folder}/module.modulemap
  "module outside [system] {\n${outside_modules}  export *\n}\nmodule duet {\n${modules}}\n")

file(WRITE ${folder}/one.cpp "#include <duet/core/version.hpp>\n")
execute_process(
  COMMAND ${compile} -Wno-ignored-attributes -fmodules -fcxx-modules -fno-implicit-module-maps
    -fmodule-map-file=${folder}/module.modulemap -fmodules-cache-path=${folder}
    -Xclang -fmodules-local-submodule-visibility -fsyntax-only ${folder}/one.cpp
  COMMAND_ERROR_IS_FATAL ANY)
list(LENGTH headers count)
message("${count} headers compile alone")
