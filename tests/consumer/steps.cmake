# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# Steps that ways of installing share, in a folder of their own that is made anew: `folder`.

file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})

# Runs a command; what it prints is in `output`.
macro(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nends with ${result}:\n${output}")
  endif()
endmacro()

# Configures duet without libraries in a build folder: <build> <source> [option ...].
function(configure_headers build tree)
  run(${CMAKE_COMMAND} -S ${tree} -B ${build} -G ${generator} -DCMAKE_CXX_COMPILER=${compiler}
    -DDUET_BUILD_TESTS=OFF -DDUET_BUILD_EXAMPLES=OFF -DDUET_BUILD_PROGRAMS=OFF -DDUET_BUILD_IO=OFF -DDUET_BUILD_ROBOTICS=OFF ${ARGN})
endfunction()

# A project finds duet below a prefix, and a program of it runs: <prefix> <whether it has the libraries>.
function(use_duet prefix has_libraries)
  run(${CMAKE_CTEST_COMMAND} --build-and-test ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/find_package ${folder}/consumer
    --build-generator ${generator}
    --build-options -DCMAKE_CXX_COMPILER=${compiler} -DCMAKE_PREFIX_PATH=${prefix} -Dexpected_prefix=${prefix}
      -Dhas_libraries=${has_libraries} -Dis_brief=ON
    --test-command ${CMAKE_CTEST_COMMAND} --output-on-failure)
endfunction()
