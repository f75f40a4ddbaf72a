# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Where there is no expat one line says so of read_urdf and of read_mesh, and nothing else needs it.
#
# cmake "-Dcompile=<compiler and flags>" -Dinclude=<folder> -Dfolder=<for files> -P without_expat.cmake

cmake_minimum_required(VERSION 3.22)

# The header that includes it, as on a machine without expat.
set(header duet/io/xml_parser.hpp)
file(READ ${include}/${header} text)
string(REPLACE "<expat.h>" "<no_such_expat.h>" changed "${text}")
if(changed STREQUAL text)
  message(FATAL_ERROR "${header} includes no <expat.h>")
endif()
file(REMOVE_RECURSE ${folder})
file(COPY ${include}/duet DESTINATION ${folder})
file(WRITE ${folder}/${header} "${changed}")
list(TRANSFORM compile REPLACE "^${include}$" ${folder})

foreach(header IN ITEMS urdf mesh_file)
  file(WRITE ${folder}/${header}.cpp "#include <duet/io/${header}.hpp>\n")
  execute_process(COMMAND ${compile} -fsyntax-only ${folder}/${header}.cpp RESULT_VARIABLE result ERROR_VARIABLE message)
  string(REGEX MATCHALL "error: " errors "${message}")
  list(LENGTH errors count)
  if(result EQUAL 0 OR NOT count EQUAL 1
     OR NOT message MATCHES "duet: read_urdf and read_mesh need expat [^\n]*: compile with its headers, link with -lexpat")
    message(FATAL_ERROR "${header}.hpp without expat: ${message}")
  endif()
endforeach()

file(WRITE ${folder}/others.cpp "#include <duet/duet.hpp>\nint main() {}\n")
execute_process(COMMAND ${compile} -Wno-ignored-attributes ${folder}/others.cpp -o ${folder}/others
  COMMAND_ERROR_IS_FATAL ANY)
