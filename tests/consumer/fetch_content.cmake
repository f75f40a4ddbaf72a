# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# In another project a library is built only if something links it.

include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)

run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/fetch_content -B ${folder}/build -G ${generator}
  -DCMAKE_CXX_COMPILER=${compiler} -Dduet_folder=${source})

# That these objects of duet exist, no others.
function(expect_objects regex)
  file(GLOB_RECURSE objects ${folder}/build/_deps/*.o)
  list(FILTER objects EXCLUDE REGEX "${regex}")
  if(objects)
    message(FATAL_ERROR "compiled, though nothing links it: ${objects}")
  endif()
endfunction()
run(${CMAKE_COMMAND} --build ${folder}/build --target headers)
expect_objects("^$")
run(${CMAKE_COMMAND} --build ${folder}/build)
expect_objects("/duet_io[.]dir/")
run(${CMAKE_CTEST_COMMAND} --test-dir ${folder}/build --output-on-failure)
