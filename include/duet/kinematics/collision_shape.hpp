// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/kinematics/joint.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

/// \file
/// Collision shapes of links, as in robot descriptions.

namespace duet {

/// A box centred at the origin, with edges along the axes.
struct collision_box {
  std::array<double, 3> size = {}; ///< lengths of the edges, in units of length
};

/// A cylinder centred at the origin, along z.
struct collision_cylinder {
  double radius = 0; ///< radius, in units of length
  double length = 0; ///< total length, in units of length
};

/// A capsule centred at the origin, along z: a cylinder with a hemisphere on each end.
struct collision_capsule {
  double radius = 0; ///< radius of cylinder and hemispheres, in units of length
  double length = 0; ///< length of the cylinder alone, in units of length
};

/// A sphere centred at the origin.
struct collision_sphere {
  double radius = 0; ///< radius, in units of length
};

/// A triangle mesh in a file.
struct collision_mesh {
  std::string file;                        ///< name as written, including `package://…`
  std::array<double, 3> scale = {1, 1, 1}; ///< scale factors of its coordinates; default: 1
};

/// One of the collision shapes of a link.
struct collision_shape {
  placement<double> frame = {}; ///< pose of the shape in the frame of the link
  std::variant<collision_box, collision_cylinder, collision_capsule, collision_sphere,
               collision_mesh>
      geometry;         ///< shape at the origin of the frame, along its axes
  std::size_t line = 0; ///< line in its file; 0: not from a file
};

} // namespace duet
