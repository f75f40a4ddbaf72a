# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Checks code that must not compile. A snippet holds the mistake under `#ifdef DUET_MUST_FAIL` and
# the right way under `#else`, and says near its top
#   // expect: <regex that a line of the compiler's errors or notes must match>
#   // flags: <flags for both compilations, optional>
#   // wrong flags: <flags for the mistake alone, optional>
#   // within: <by which line of the compiler's output it must be said, optional>
#   // forms: <how many forms the mistake has: DUET_MUST_FAIL is 1, 2 … for them, optional>
# The right way, the control, must compile: else the mistake may fail for the wrong reason.
#
# Of several mistakes in one form each line ends with `// mistake`: the compiler must name every one of them.
#
# A snippet without flags of its own is given a precompiled header, where one is named.
#
# cmake -Dcompile=<compiler and flags> -Dsnippet=<file> -Dcontrol=<compile the right way, too> [-Dprecompiled=<header>] -P check.cmake

cmake_minimum_required(VERSION 3.22)

# The compiler's words are matched, so they must be English.
set(ENV{LC_ALL} C)

function(read_comment key result_variable)
  file(STRINGS ${snippet} line LIMIT_COUNT 1 REGEX "^// ${key}: ")
  string(REGEX REPLACE "^// ${key}: " "" value "${line}")
  set(${result_variable} "${value}" PARENT_SCOPE)
endfunction()

# A line that a formatter has wrapped would lose the keys behind it.
file(READ ${snippet} text)
string(REGEX MATCH "^([^\n]+\n)+" comments "${text}")
string(REPLACE ";" "," comments "${comments}")
string(REGEX MATCHALL "\n// [^\n]*" comments "${comments}")
foreach(comment IN LISTS comments)
  if(NOT comment MATCHES "^\n// (expect|flags|within|forms|wrong flags): ")
    message(FATAL_ERROR "${snippet}: not a line of a key:${comment}")
  endif()
endforeach()
read_comment(expect expected)
if(expected STREQUAL "")
  message(FATAL_ERROR "${snippet} has no line \"// expect: <regex>\"")
endif()
read_comment(flags flags)
separate_arguments(flags UNIX_COMMAND "${flags}")
list(APPEND compile ${flags} -fsyntax-only -fdiagnostics-color=never)
read_comment(within last_line)
read_comment(forms forms)
if(forms STREQUAL "")
  set(forms 1)
endif()
if(compile MATCHES "clang")
  list(APPEND compile -ferror-limit=0)
endif()
read_comment("wrong flags" wrong_flags)
if(precompiled AND NOT flags AND NOT wrong_flags)
  list(APPEND compile -include ${precompiled})
endif()

if(control)
  execute_process(COMMAND ${compile} ${snippet} RESULT_VARIABLE result ERROR_VARIABLE log)
  if(NOT result EQUAL 0)
    message("${log}")
    message(FATAL_ERROR "the control does not compile")
  endif()
endif()

# What fails for one mistake need not be compiled further.
file(STRINGS ${snippet} mistakes REGEX "// mistake$")
if(NOT mistakes AND NOT last_line)
  list(APPEND compile -Wfatal-errors)
endif()
foreach(form RANGE 1 ${forms})
  execute_process(COMMAND ${compile} ${wrong_flags} -DDUET_MUST_FAIL=${form} ${snippet}
    RESULT_VARIABLE result ERROR_VARIABLE log)
  if(result EQUAL 0)
    message(FATAL_ERROR "form ${form}: it compiles, but should have failed with: ${expected}")
  endif()
  if(NOT log MATCHES "(error|note): [^\n]*(${expected})")
    message("${log}")
    message(FATAL_ERROR "form ${form}: it fails for another reason than: ${expected}")
  endif()
  string(FIND "${log}" "${CMAKE_MATCH_0}" position)
  string(SUBSTRING "${log}" 0 ${position} before)
  string(REGEX REPLACE "[^\n]" "" before "${before}")
  string(LENGTH "${before}" lines_before)
  if(last_line AND lines_before GREATER_EQUAL last_line)
    message("${log}")
    message(FATAL_ERROR "form ${form}: ${lines_before} lines come before: ${expected}")
  endif()
  file(STRINGS ${snippet} lines)
  set(number 0)
  foreach(line IN LISTS lines)
    math(EXPR number "${number} + 1")
    if(line MATCHES "// mistake$" AND NOT log MATCHES "${snippet}:${number}:")
      message("${log}")
      message(FATAL_ERROR "the mistake in line ${number} is not complained of")
    endif()
  endforeach()
endforeach()
