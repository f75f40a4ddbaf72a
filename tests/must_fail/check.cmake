# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Checks code that must not compile. A snippet holds the mistake under `#ifdef DUET_MUST_FAIL` and
# the right way under `#else`, and says in its first lines
#   // expect: <regex that a line of the compiler's errors or notes must match>
#   // flags: <flags for both compilations, optional>
#   // wrong flags: <flags for the mistake alone, optional>
#   // within: <by which line of the compiler's output it must be said, optional>
#   // forms: <how many forms the mistake has: DUET_MUST_FAIL is 1, 2 … for them, optional>
# The right way, the control, must compile: else the mistake may fail for the wrong reason.
#
# A table <layer>.cpp has many of them, each below a line `//// <name>`; what stands above the first is for all. Of a
# table one snippet is checked, -Dname=<name>, or without a name that the right ways compile, of all together.
#
# Of several mistakes in one form each line ends with `// mistake`: the compiler must name every one of them.
#
# A snippet without flags of its own is given a precompiled header, where one is named.
#
# cmake -Dcompile=<compiler and flags> -Dsnippet=<file> [-Dname=<name> | -Dcontrol=<compile the right way, too>]
#   [-Dfolder=<for snippets of tables>] [-Dprecompiled=<header>] -P check.cmake

cmake_minimum_required(VERSION 3.22)

# The compiler's words are matched, so they must be English.
set(ENV{LC_ALL} C)

# The snippet <name> of a table, with its keys, then what is for all, then its code; all code within a namespace if
# it is to stand beside others.
function(read_snippet table name result_variable is_inside)
  string(FIND "${table}" "\n//// " end)
  string(SUBSTRING "${table}" 0 ${end} for_all)
  string(FIND "${table}" "\n//// ${name}\n" begin)
  if(begin EQUAL -1)
    message(FATAL_ERROR "${snippet} has no line \"//// ${name}\"")
  endif()
  string(LENGTH "\n//// ${name}\n" length)
  math(EXPR begin "${begin} + ${length}")
  string(SUBSTRING "${table}" ${begin} -1 text)
  string(FIND "${text}" "\n//// " end)
  string(SUBSTRING "${text}" 0 ${end} text)
  string(FIND "${text}" "\n\n" end)
  string(SUBSTRING "${text}" 0 ${end} keys)
  string(SUBSTRING "${text}" ${end} -1 code)
  if(is_inside)
    string(REGEX MATCHALL "#include [^\n]*\n" includes "${code}")
    string(JOIN "" includes ${includes})
    set(${result_variable} "${includes}namespace ${name} {\n${code}}\n" PARENT_SCOPE)
  else()
    set(${result_variable} "// ${name}\n${keys}\n\n${for_all}\n${code}" PARENT_SCOPE)
  endif()
endfunction()

if(NOT DEFINED control)
  file(READ ${snippet} table)
  cmake_path(GET snippet STEM stem)
  if(DEFINED name)
    set(snippet ${folder}/${stem}/${name}.cpp)
    read_snippet("${table}" ${name} text OFF)
    file(WRITE ${snippet} "${text}")
  else()
    string(FIND "${table}" "\n//// " end)
    string(SUBSTRING "${table}" 0 ${end} text)
    file(STRINGS ${snippet} names REGEX "^//// ")
    foreach(name IN LISTS names)
      string(SUBSTRING ${name} 5 -1 name)
      read_snippet("${table}" ${name} code ON)
      string(APPEND text "\n${code}")
    endforeach()
    file(WRITE ${folder}/${stem}.cpp "${text}")
    list(APPEND compile -fsyntax-only)
    if(precompiled)
      list(APPEND compile -include ${precompiled})
    endif()
    execute_process(COMMAND ${compile} ${folder}/${stem}.cpp RESULT_VARIABLE result)
    if(NOT result EQUAL 0)
      message(FATAL_ERROR "the right ways do not compile")
    endif()
    return()
  endif()
endif()

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
