// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/mechanism/joint.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

/// \file
/// The shapes that links have for collisions, as robot descriptions say them.

namespace duet {

/// A box about the origin, its edges along the axes.
struct collision_box {
  std::array<double, 3> size = {}; ///< the lengths of its edges
};

/// A cylinder about the origin, along z.
struct collision_cylinder {
  double radius = 0; ///< in units of length
  double length = 0; ///< from end to end
};

/// A cylinder about the origin, along z, with half a ball on each end.
struct collision_capsule {
  double radius = 0; ///< of cylinder and balls
  double length = 0; ///< of the cylinder
};

/// A ball about the origin.
struct collision_sphere {
  double radius = 0; ///< in units of length
};

/// The surface in a file.
struct collision_mesh {
  std::string file;                        ///< as it is written, `package://…` included
  std::array<double, 3> scale = {1, 1, 1}; ///< of its coordinates
};

/// One of the shapes that a link consists of for collisions.
struct collision_shape {
  placement<double> frame = {}; ///< of the shape, in the frame of the link
  std::variant<collision_box, collision_cylinder, collision_capsule, collision_sphere,
               collision_mesh>
      geometry;         ///< about the frame's origin, along its axes
  std::size_t line = 0; ///< of the file that it is from; 0: of none
};

} // namespace duet
