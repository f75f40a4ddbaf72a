// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/io/mesh_file.hpp>
#include <duet/kinematics/collision_shape.hpp>
#include <duet/kinematics/shapes.hpp>
#include <duet/robotics/clearance.hpp>
#include <duet/robotics/enclosing_capsule.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// \file
/// Bounding capsules of the links of a robot description.

namespace duet {

/// Volume of a shape.
[[nodiscard]] inline double volume_of(const collision_box& b) {
  return b.size[0] * b.size[1] * b.size[2];
}
[[nodiscard]] inline double volume_of(const collision_cylinder& c) {
  return std::numbers::pi * c.radius * c.radius * c.length;
}
[[nodiscard]] inline double volume_of(const collision_sphere& s) {
  return 4 * std::numbers::pi * s.radius * s.radius * s.radius / 3;
}
[[nodiscard]] inline double volume_of(const collision_capsule& c) {
  return volume_of(collision_cylinder{c.radius, c.length}) + volume_of(collision_sphere{c.radius});
}
/// Volume within a triangle mesh of either orientation, Σ a·(b × c)/6 over its triangles; nan if it
/// is not closed, as Σ (b − a) × (c − a) then is not 0.
[[nodiscard]] inline double volume_of(const triangle_mesh& m) {
  double volume = 0, area = 0;
  vector3<double> sum = vector3<double>::Zero();
  for (std::size_t i = 0; i + 2 < m.vertices.size(); i += 3) {
    const auto corner = [&](std::size_t k) {
      const auto &x = m.vertices[i + k], &origin = m.vertices[0];
      return vector3<double>(x[0] - origin[0], x[1] - origin[1], x[2] - origin[2]);
    };
    const vector3<double> a = corner(0), b = corner(1), c = corner(2);
    const vector3<double> twice_area = detail::cross_product<double>(b - a, c - a);
    volume += a.dot(detail::cross_product(b, c)) / 6;
    sum += twice_area;
    area += twice_area.norm();
  }
  return sum.norm() < 1e-4 * area ? std::abs(volume) : std::numeric_limits<double>::quiet_NaN();
}

/// Smallest bounding capsule of a cylinder along its axis.
///
/// With c the distance from the end of its axis to that of the cylinder, r² + c² the square of its
/// radius and h half the length of the cylinder, its volume is minimal where 2ch − 3c² − r² +
/// 2c√(r² + c²) = 0: that grows with c. For h ≤ r/√3 it is the ball of c = h.
[[nodiscard]] inline capsule<double> bounding_capsule(const collision_cylinder& cylinder) {
  const double r = cylinder.radius, h = cylinder.length / 2;
  const auto grows = [&](double c) {
    return 2 * c * h - 3 * c * c - r * r + 2 * c * std::hypot(r, c) > 0;
  };
  double c = h;
  if (grows(h)) {
    double low = 0, high = h;
    for (int i = 0; i < 60; ++i) {
      c = (low + high) / 2;
      (grows(c) ? high : low) = c;
    }
  }
  return {{0, 0, c - h}, {0, 0, h - c}, std::hypot(r, c)};
}
/// Smallest bounding capsule of a box along one of its edges.
[[nodiscard]] inline capsule<double> bounding_capsule(const collision_box& b) {
  capsule<double> best(sphere<double>{vector3<double>::Zero(), 0});
  double min_volume = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const double across = std::hypot(b.size[(i + 1) % 3], b.size[(i + 2) % 3]) / 2;
    const capsule<double> along = bounding_capsule(collision_cylinder{across, b.size[i]});
    if (volume_of(along) < min_volume) {
      min_volume = volume_of(along);
      const vector3<double> end = along.to[2] * vector3<double>::Unit(Eigen::Index(i));
      best = {vector3<double>(-end), end, along.radius};
    }
  }
  return best;
}
/// The capsule itself.
[[nodiscard]] inline capsule<double> bounding_capsule(const collision_capsule& c) {
  return {{0, 0, -c.length / 2}, {0, 0, c.length / 2}, c.radius};
}
/// Sphere as a capsule whose axis has no length.
[[nodiscard]] inline capsule<double> bounding_capsule(const collision_sphere& s) {
  return sphere<double>{vector3<double>::Zero(), s.radius};
}
/// Small bounding capsule of a triangle mesh, and so of its convex hull.
///
/// \throws invalid_input for a mesh without triangles
[[nodiscard]] inline capsule<double> bounding_capsule(const triangle_mesh& m) {
  std::vector<vector3<double>> points;
  points.reserve(m.vertices.size());
  for (const auto& x : m.vertices) {
    points.emplace_back(x[0], x[1], x[2]);
  }
  return bounding_capsule(points);
}

/// Bounding capsules of the shapes of links, and how much larger they are.
struct bounding_capsules_result {
  std::vector<collision_body> bodies; ///< bodies for a `scene`, each with the name of its link
  /// Volume of each capsule divided by that of its shape; nan if a mesh is not closed.
  std::vector<double> volume_ratios;
};

namespace detail {

/// Path of a mesh file: `package://` stands for the folder, and relative paths are in it.
[[nodiscard]] inline std::string mesh_path(const std::string& file, const std::string& folder) {
  constexpr std::string_view package = "package://", local = "file://";
  if (file.starts_with(local)) {
    return file.substr(local.size());
  }
  const bool is_in_package = file.starts_with(package);
  const std::string path = is_in_package ? file.substr(package.size()) : file;
  return folder.empty() || (path.starts_with('/') && !is_in_package) ? path : folder + "/" + path;
}

[[nodiscard]] inline triangle_mesh surface_of(const collision_mesh& mesh,
                                              const std::string& folder) {
  triangle_mesh result = read_mesh(mesh_path(mesh.file, folder));
  for (auto& x : result.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] *= mesh.scale[i];
    }
  }
  return result;
}

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
  bounding_capsules_result result;
  int number = 0;
  for (const auto& link : robot.links()) {
    placement<double> offset;
    int on = number++;
    if constexpr (requires { link.frame; }) { // of a chain
      offset = link.frame.offset;
      on = link.frame.link;
    }
    for (const collision_shape& each : link.collision) {
      const placement<double> shape_pose = offset * each.frame;
      const auto add = [&](const auto& shape) {
        const capsule<double> fitted = bounding_capsule(shape);
        const vector3<double> shift(shape_pose.translation.data());
        result.bodies.push_back(
            {on, transformed(pose(shape_pose.rotation, shift), fitted), link.name});
        result.volume_ratios.push_back(volume_of(fitted) / volume_of(shape));
      };
      std::visit(
          [&](const auto& shape) {
            if constexpr (requires { shape.file; }) {
              add(detail::surface_of(shape, folder));
            } else {
              add(shape);
            }
          },
          each.geometry);
    }
  }
  return result;
}

} // namespace duet
