# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# The one header of scripts/single_header: it includes nothing of duet and nothing twice, and instead of
# duet/duet.hpp it compiles, without a warning, README's first program by every compiler that is here, and
# those of the layers that it has by the one that tests are built with.
#
# cmake -Dpython=<program> -Dsource=<top of the project> -Dfolder=<for what is made> -Dcompile=<compiler and flags>
#   -P single_header.cmake

cmake_minimum_required(VERSION 3.22)

file(REMOVE_RECURSE ${folder})
set(header ${folder}/duet_core.hpp)
execute_process(COMMAND ${python} ${source}/scripts/single_header ${header} COMMAND_ERROR_IS_FATAL ANY)

file(STRINGS ${header} includes REGEX "^[ \t]*#[ \t]*include")
list(FILTER includes EXCLUDE REGEX "\"duet: needs C[+][+]20") # no file, but what compilers say
set(unique ${includes})
list(REMOVE_DUPLICATES unique)
if(includes STREQUAL "" OR NOT includes STREQUAL unique)
  message(FATAL_ERROR "nothing or something twice is included: ${includes}")
elseif(includes MATCHES "duet/")
  message(FATAL_ERROR "it still includes what is duet's: ${includes}")
endif()

# A page as far as a heading, with the one header.
function(write_document path page end)
  file(READ ${source}/${page} text)
  string(FIND "${text}" "${end}" position)
  if(position EQUAL -1)
    message(FATAL_ERROR "${page} has no '${end}'")
  endif()
  string(SUBSTRING "${text}" 0 ${position} text)
  string(REPLACE "#include <duet/duet.hpp>" "#include \"duet_core.hpp\"" text "${text}")
  file(WRITE ${path} "${text}")
endfunction()
write_document(${folder}/first.md README.md "\n## Robot arm")
write_document(${folder}/layers.md docs/tutorials/rotations_and_poses.md "\n## Interpolate")

# Of the flags those that lead to Eigen and Boost, and not to duet.
list(POP_FRONT compile compiler)
list(FILTER compile INCLUDE REGEX "^(-isystem|/.*)$")
list(REMOVE_ITEM compile ${source}/include)

# usage: check_by <compiler> <document>
function(check_by compiler document)
  cmake_path(GET compiler FILENAME name)
  execute_process(
    COMMAND ${python} ${source}/tests/documents/check.py --folder ${folder}/${name}_${document}
      --documents ${folder}/${document}.md
      --compiler ${compiler} -std=c++20 -Wpedantic -Wconversion -Wno-sign-conversion -Wshadow -I ${folder} ${compile}
    OUTPUT_VARIABLE said ERROR_VARIABLE said RESULT_VARIABLE result)
  message("${name}: ${said}")
  if(NOT result EQUAL 0 OR said MATCHES "^0 programs")
    message(FATAL_ERROR "not compiled by ${compiler}")
  endif()
endfunction()
check_by(${compiler} layers)
file(REAL_PATH ${compiler} tried)
foreach(name IN ITEMS g++ clang++)
  find_program(other_${name} ${name})
  if(other_${name})
    file(REAL_PATH ${other_${name}} other)
    if(NOT other STREQUAL tried)
      check_by(${other_${name}} first)
    endif()
  endif()
endforeach()
