// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file_error.hpp>
#include <duet/kinematics/robot_description.hpp>

#include <string>
#include <vector>

/// \file
/// Pairs of links without self-collision checks, from SRDF files, which accompany URDF files.

namespace duet {
DUET_ABI_BEGIN

/// Disabled collision pairs: the links of all `<disable_collisions link1="…" link2="…"/>` of a
/// file, which `self_collision_pairs` leaves out. All other elements are skipped.
///
/// \throws file_error with the line for XML that is not well formed, another root than `<robot>`,
/// missing or empty names, a link paired with itself, attributes other than these and `reason`, and
/// for `<enable_collisions>` and `<disable_default_collisions>`, which reverse the meaning; and for
/// all files if duet::io was built without expat
[[nodiscard]] std::vector<link_pair> read_disabled_collisions(const std::string& path);

DUET_ABI_END
} // namespace duet
