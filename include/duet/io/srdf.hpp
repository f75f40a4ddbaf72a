// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/kinematics/robot_contents.hpp>

#include <string>
#include <vector>

#ifndef DUET_COMPILED
#include <duet/io/urdf_library.hpp>
#endif

/// \file
/// Pairs of links without self-collision checks, from SRDF files, which accompany URDF files.

namespace duet {

/// Disabled collision pairs: the links of all `<disable_collisions link1="…" link2="…"/>` of a
/// file, which `self_collision_pairs` leaves out. All other elements are skipped.
///
/// \throws file_error with the line for XML that is not well formed, another root than `<robot>`,
/// missing or empty names, a link paired with itself, attributes other than these and `reason`, and
/// for `<enable_collisions>` and `<disable_default_collisions>`, which reverse the meaning
[[nodiscard]] inline std::vector<link_pair> read_disabled_collisions(const std::string& path) {
  return detail::read_disabled_collisions_in_srdf<detail::xml_library>(path);
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE std::vector<link_pair>
detail::read_disabled_collisions_in_srdf<detail::xml_library>(const std::string&);
#endif

} // namespace duet
