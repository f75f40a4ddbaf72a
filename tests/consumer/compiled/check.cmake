# Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

foreach(program IN ITEMS header_only linked)
  execute_process(COMMAND ${${program}} OUTPUT_VARIABLE output_of_${program}
    COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${nm} -C --defined-only ${${program}_object}
    OUTPUT_VARIABLE names_of_${program} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
if(NOT output_of_header_only MATCHES "sine.*reached.*slide.*traced.*near" OR NOT output_of_linked STREQUAL output_of_header_only)
  message(FATAL_ERROR "${output_of_header_only}\n\nlinked:\n${output_of_linked}")
endif()

foreach(name IN ITEMS "curve_through<" "fit_result<[^\n]*> duet::fit<" "::path_planner<8>::plan\\("
        "::inverse_kinematics_search<8,[^\n]*>::operator\\(\\)" "::chain_model<[^\n]*>::set\\(" "::screw_path<"
        "::read_urdf_contents<" "::compared<" "::closed_chain_mechanism::assemble\\(" "duet::find_assembly_configurations\\(" "duet::mobility\\(" "::driven_motion::followed\\("
        "duet::trace\\(")
  if(NOT names_of_header_only MATCHES "${name}")
    message(FATAL_ERROR "the program of headers alone does not define ${name}")
  elseif(names_of_linked MATCHES "${name}")
    message(FATAL_ERROR "the linked program defines ${name} itself")
  endif()
endforeach()
