# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# What duet costs the compiler: small programs as a newcomer writes them, and peers on the same
# tasks where they are installed. Seconds of the processor, the least of several runs, and multiples
# of including Eigen/Core in the same run: of a program's headers, and of what it does beyond them.
#
# cmake -Dcompile=<compiler and flags> -Dfolder=<for files> [-Dpeers=<folders of peers' headers>]
#   [-Dprograms=<regular expression of names>] [-Druns=3] -P compile_time.cmake

cmake_minimum_required(VERSION 3.22)

if(NOT runs)
  set(runs 3)
endif()
file(MAKE_DIRECTORY ${folder})

# Hundredths of a second in user and system mode, by the shell's account of its children; empty
# where the file does not compile.
function(processor_time file result)
  set(least "")
  foreach(run RANGE 1 ${runs})
    execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C
        sh -c "\"$@\" && times" sh ${compile} -c ${file} -o ${folder}/object.o
      OUTPUT_VARIABLE times ERROR_VARIABLE log RESULT_VARIABLE failed)
    if(failed)
      set(${result} "" PARENT_SCOPE)
      set(log "${log}" PARENT_SCOPE)
      return()
    endif()
    set(time "([0-9]+)m([0-9]+)[.]([0-9][0-9])[0-9]*s")
    string(REGEX MATCH "${time} ${time}[ \n]*$" of_children "${times}")
    math(EXPR sum "6000 * (${CMAKE_MATCH_1} + ${CMAKE_MATCH_4})
      + 100 * (${CMAKE_MATCH_2} + ${CMAKE_MATCH_5}) + 1${CMAKE_MATCH_3} + 1${CMAKE_MATCH_6} - 200")
    if(least STREQUAL "" OR sum LESS least)
      set(least ${sum})
    endif()
  endforeach()
  set(${result} "${least}" PARENT_SCOPE)
endfunction()

# Hundredths as a decimal number.
function(decimal hundredths result)
  set(sign "")
  if(hundredths LESS 0)
    set(sign "-")
    math(EXPR hundredths "-(${hundredths})")
  endif()
  math(EXPR whole "${hundredths} / 100")
  math(EXPR rest "${hundredths} % 100 + 100")
  string(SUBSTRING ${rest} 1 2 rest)
  set(${result} "${sign}${whole}.${rest}" PARENT_SCOPE)
endfunction()

# A number of hundredths over that of Eigen/Core.
function(multiple hundredths result)
  math(EXPR rounded "(100 * (${hundredths}) + ${unit} / 2) / ${unit}")
  decimal(${rounded} text)
  set(${result} ${text} PARENT_SCOPE)
endfunction()

file(WRITE ${folder}/headers.cpp "#include <Eigen/Core>\n")
processor_time(${folder}/headers.cpp unit)
decimal(${unit} seconds)
list(JOIN compile " " command)
message("${command}\nincluding Eigen/Core: ${seconds} s of the processor\n")

foreach(peer IN LISTS peers)
  list(APPEND compile -isystem ${peer})
endforeach()

message("| header | s | over Eigen/Core |\n|---|---|---|")
foreach(header duet core/select dual/math derivative/jacobian quaternion/exponential
    dual_quaternion/screw comparison/compare expression/jacobian spline/interpolate
    kinematics/jacobian robotics/inverse_kinematics)
  if(programs AND NOT header MATCHES "${programs}")
    continue()
  endif()
  file(WRITE ${folder}/headers.cpp "#include <duet/${header}.hpp>\n")
  processor_time(${folder}/headers.cpp time)
  if(time STREQUAL "")
    message(FATAL_ERROR "${header}.hpp does not compile\n${log}")
  endif()
  decimal(${time} seconds)
  multiple(${time} over)
  message("| `${header}.hpp` | ${seconds} | ${over} |")
endforeach()

# One row of a table of programs.
function(measure_program source)
  get_filename_component(name ${source} NAME_WE)
  if(programs AND NOT name MATCHES "${programs}")
    return()
  endif()
  file(STRINGS ${source} includes REGEX "^#include")
  list(JOIN includes "\n" includes)
  file(WRITE ${folder}/headers.cpp "${includes}\n")
  processor_time(${folder}/headers.cpp headers)
  processor_time(${source} all)
  if(all STREQUAL "")
    if(NOT name MATCHES "^peer_")
      message(FATAL_ERROR "${name} does not compile\n${log}")
    endif()
    message("| `${name}`, not installed | | | |")
    return()
  endif()
  decimal(${all} seconds)
  multiple(${headers} over)
  multiple("${all} - ${headers}" beyond)
  message("| `${name}` | ${seconds} | ${over} | ${beyond} |")
endfunction()

message("\n| program | s | headers over Eigen/Core | beyond them |\n|---|---|---|---|")
file(GLOB sources ${CMAKE_CURRENT_LIST_DIR}/*.cpp)
foreach(source IN LISTS sources)
  measure_program(${source})
endforeach()
