// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/text/file_error.hpp>
#include <duet/kinematics/tree_loop.hpp>

#include <string>

/// \file
/// Loop-closure constraints from files, as a robot description, which is a tree, cannot
/// contain them.

namespace duet {
DUET_ABI_BEGIN

/// The loop-closure constraints in a text file, which accompanies a robot description, one a line,
/// as `revolute coupler 0.5 0 0 rocker 0.4 0 0` or `distance base 1 0 0 plate 0.1 0 0 length 0.8`:
/// a type of `constraint_kind`, two frames, and for a distance its length; `weld`, `hinge`,
/// `slider`, `ball` and `rod` are read as well. A frame is a link, a point x y z in its frame, and,
/// if its axes are not those of the link, `axis x y z`, the direction of its z axis as in
/// `frame_with_z_axis`, or `rpy roll pitch yaw` as in URDF. Metres and radians; names without
/// blanks; the rest of a line after a number sign is a comment.
///
/// \throws file_error with line and value for files that cannot be read, unknown types, missing and
/// superfluous words, numbers that are not finite, axes and distances without length
[[nodiscard]] loop_constraints read_loops(const std::string& path);

DUET_ABI_END
} // namespace duet
