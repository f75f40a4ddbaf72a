# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

# The programs of a project that uses duet, one for each target of it that `libraries` names, and their tests. With
# `is_brief` the last of them alone, which uses the others.

enable_testing()
set(last duet)
if(is_brief AND libraries)
  list(GET libraries -1 last)
endif()
foreach(pair IN ITEMS headers:duet files:io planning:robotics)
  string(REGEX MATCH "^(.*):(.*)$" pair ${pair})
  set(program ${CMAKE_MATCH_1})
  set(library ${CMAKE_MATCH_2})
  if(is_brief AND NOT library STREQUAL last)
    continue()
  elseif(library STREQUAL "duet" OR library IN_LIST libraries)
    add_executable(${program} ${CMAKE_CURRENT_LIST_DIR}/${program}.cpp)
    target_link_libraries(${program} PRIVATE duet::${library})
    add_test(NAME ${program} COMMAND ${program})
  elseif(TARGET duet::${library} AND NOT allow_further_libraries)
    message(FATAL_ERROR "duet::${library} is not expected here")
  endif()
endforeach()
