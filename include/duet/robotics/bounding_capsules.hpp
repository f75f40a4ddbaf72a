// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/io/mesh_file.hpp>
#include <duet/kinematics/robot_description.hpp>
#include <duet/kinematics/shapes.hpp>
#include <duet/robotics/clearance.hpp>

#include <string>
#include <vector>

/// \file
/// Bounding capsules of points, of shapes and of the links of a robot description.

namespace duet {
DUET_ABI_BEGIN

/// Volume of a capsule, πr²l + 4πr³/3.
[[nodiscard]] double volume_of(const capsule<double>& c);
/// Volume of a shape.
[[nodiscard]] double volume_of(const collision_box& b);
[[nodiscard]] double volume_of(const collision_cylinder& c);
[[nodiscard]] double volume_of(const collision_sphere& s);
[[nodiscard]] double volume_of(const collision_capsule& c);
/// Volume within a triangle mesh of either orientation, Σ a·(b × c)/6 over its triangles; nan if it
/// is not closed, as Σ (b − a) × (c − a) then is not 0.
[[nodiscard]] double volume_of(const triangle_mesh& m);
/// Smallest bounding capsule of a cylinder along its axis.
///
/// With c the distance from the end of its axis to that of the cylinder, r² + c² the square of its
/// radius and h half the length of the cylinder, its volume is minimal where 2ch − 3c² − r² +
/// 2c√(r² + c²) = 0: that grows with c. For h ≤ r/√3 it is the ball of c = h.
[[nodiscard]] capsule<double> bounding_capsule(const collision_cylinder& cylinder);
/// Smallest bounding capsule of a box along one of its edges.
[[nodiscard]] capsule<double> bounding_capsule(const collision_box& b);
/// The capsule itself.
[[nodiscard]] capsule<double> bounding_capsule(const collision_capsule& c);
/// Sphere as a capsule whose axis has no length.
[[nodiscard]] capsule<double> bounding_capsule(const collision_sphere& s);
/// Small bounding capsule of a triangle mesh, and so of its convex hull.
///
/// \throws invalid_input for a mesh without triangles
[[nodiscard]] capsule<double> bounding_capsule(const triangle_mesh& m);

/// Small bounding capsule of points: all of them are inside, to round-off.
///
/// Its volume is a local minimum, sought from 13 directions; the global minimum is not guaranteed.
/// Only a few points are used: first the outermost in a few directions, then those outside the
/// capsule around these, until there are none.
///
/// \throws invalid_input for no points and for points that are not finite
[[nodiscard]] capsule<double> bounding_capsule(const std::vector<vector3<double>>& points);

/// Bounding capsules of the shapes of links, and how much larger they are.
struct bounding_capsules_result {
  std::vector<collision_body> bodies; ///< bodies for a `scene`, each with the name of its link
  /// Volume of each capsule divided by that of its shape; nan if a mesh is not closed.
  std::vector<double> volume_ratios;
};

DUET_ABI_END
namespace detail {
DUET_ABI_BEGIN

/// Collision shape on a link.
struct shape_on_link {
  int link;                     ///< number of the link
  const std::string& name;      ///< name of the link
  placement<double> offset;     ///< frame of the link's shapes in the frame of the link
  const collision_shape& shape; ///< shape in that frame
};
[[nodiscard]] bounding_capsules_result bounding_capsules(const std::vector<shape_on_link>& shapes,
                                                         const std::string& folder);

DUET_ABI_END
} // namespace detail

/// Bounding capsules of the collision shapes of a robot's links: the shape itself for a sphere or a
/// capsule, the smallest along the axis of a cylinder or along an edge of a box, and a small one
/// around the convex hull of a mesh.
///
/// Example: `scene around; around.bodies = bounding_capsules(arm, "meshes").bodies;`
///
/// \param robot   chain or tree that was read from a description: what has `links()`
/// \param folder  directory of meshes: contains the folders that are named after packages, and is
/// the base of relative paths
/// \throws file_error for meshes that cannot be read, as `read_mesh`
template <class Robot>
  requires LinkedMechanism<Robot>
[[nodiscard]] bounding_capsules_result bounding_capsules(const Robot& robot,
                                                         const std::string& folder = "") {
  std::vector<detail::shape_on_link> shapes;
  int number = 0;
  const auto& links = robot.links();
  for (const auto& link : links) {
    placement<double> offset;
    int on = number++;
    if constexpr (requires { link.frame; }) { // of a chain
      offset = link.frame.offset;
      on = link.frame.link;
    }
    for (const collision_shape& each : link.collision) {
      shapes.push_back({on, link.name, offset, each});
    }
  }
  return detail::bounding_capsules(shapes, folder);
}

} // namespace duet
