// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/mechanism/collision_shape.hpp>
#include <duet/mechanism/mesh_file.hpp>
#include <duet/planning/clearance.hpp>
#include <duet/planning/enclosing_capsule.hpp>
#include <duet/planning/shapes.hpp>

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
/// The capsules that the links of a robot description are within.

namespace duet {

/// The volume of a shape.
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
/// The volume within a surface, Σ a·(b × c)/6 over its triangles, whichever way they are turned;
/// nan where it is not closed, as Σ (b − a) × (c − a) then is not 0.
[[nodiscard]] inline double volume_of(const mesh_surface& m) {
  double volume = 0, area = 0;
  vector3<double> sum = vector3<double>::Zero();
  for (std::size_t i = 0; i + 2 < m.corners.size(); i += 3) {
    const auto corner = [&](std::size_t k) {
      const auto &x = m.corners[i + k], &origin = m.corners[0];
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

/// The smallest capsule along the axis of a cylinder that the cylinder is in.
///
/// With c from the end of its axis to that of the cylinder, r² + c² the square of its radius, h
/// half the length, its volume is least where 2ch − 3c² − r² + 2c√(r² + c²) = 0: that grows with c.
/// For h ≤ r/√3 it is the ball of c = h.
[[nodiscard]] inline capsule<double> enclosing_capsule(const collision_cylinder& cylinder) {
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
/// The smallest capsule along an edge of a box that the box is in.
[[nodiscard]] inline capsule<double> enclosing_capsule(const collision_box& b) {
  capsule<double> best(sphere<double>{vector3<double>::Zero(), 0});
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const double across = std::hypot(b.size[(i + 1) % 3], b.size[(i + 2) % 3]) / 2;
    const capsule<double> along = enclosing_capsule(collision_cylinder{across, b.size[i]});
    if (volume_of(along) < least) {
      least = volume_of(along);
      const vector3<double> end = along.to[2] * vector3<double>::Unit(Eigen::Index(i));
      best = {vector3<double>(-end), end, along.radius};
    }
  }
  return best;
}
/// The capsule itself.
[[nodiscard]] inline capsule<double> enclosing_capsule(const collision_capsule& c) {
  return {{0, 0, -c.length / 2}, {0, 0, c.length / 2}, c.radius};
}
/// The ball itself.
[[nodiscard]] inline capsule<double> enclosing_capsule(const collision_sphere& s) {
  return sphere<double>{vector3<double>::Zero(), s.radius};
}
/// A small capsule that a surface is in, and so its convex hull.
/// \throws invalid_input for a surface of no triangles
[[nodiscard]] inline capsule<double> enclosing_capsule(const mesh_surface& m) {
  std::vector<vector3<double>> points;
  points.reserve(m.corners.size());
  for (const auto& x : m.corners) {
    points.emplace_back(x[0], x[1], x[2]);
  }
  return enclosing_capsule(points);
}

/// Capsules in place of the shapes of links, and how much larger they are.
struct fitted_bodies {
  std::vector<link_body> bodies; ///< of `scene`, each with the name of its link
  /// The volume of each over that of its shape; nan where a mesh is not closed.
  std::vector<double> volume_ratios;
};

namespace detail {

/// Where the file of a mesh is: `package://` stands for the folder, and so does nothing before a
/// path that is not absolute.
[[nodiscard]] inline std::string mesh_path(const std::string& file, const std::string& folder) {
  constexpr std::string_view package = "package://", local = "file://";
  if (file.starts_with(local)) {
    return file.substr(local.size());
  }
  const bool is_in_package = file.starts_with(package);
  const std::string path = is_in_package ? file.substr(package.size()) : file;
  return folder.empty() || (path.starts_with('/') && !is_in_package) ? path : folder + "/" + path;
}

[[nodiscard]] inline mesh_surface surface_of(const collision_mesh& mesh,
                                             const std::string& folder) {
  mesh_surface result = read_mesh(mesh_path(mesh.file, folder));
  for (auto& x : result.corners) {
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] *= mesh.scale[i];
    }
  }
  return result;
}

} // namespace detail

/// For each shape that the links of a robot have for collisions a capsule that it is in: the shape
/// itself where it is a sphere or a capsule, the smallest along its axis for a cylinder, along an
/// edge for a box, and a small one around the convex hull of a mesh.
///
/// Example: `scene around; around.bodies = capsules_of(arm, "meshes").bodies;`
/// \param robot   a chain or a tree that was read: what has `links()`
/// \param folder  of meshes: where the folders are that are named after packages, and what has no
///                absolute path
/// \throws file_error for meshes that cannot be read, as `read_mesh`
template <class Robot>
  requires LinkedMechanism<Robot>
[[nodiscard]] fitted_bodies capsules_of(const Robot& robot, const std::string& folder = "") {
  fitted_bodies result;
  int number = 0;
  for (const auto& link : robot.links()) {
    placement<double> offset;
    int on = number++;
    if constexpr (requires { link.frame; }) { // of a chain
      offset = link.frame.offset;
      on = link.frame.link;
    }
    for (const collision_shape& each : link.collision) {
      const placement<double> placed = offset * each.frame;
      const auto add = [&](const auto& shape) {
        const capsule<double> fitted = enclosing_capsule(shape);
        const vector3<double> shift(placed.translation.data());
        result.bodies.push_back({on, transformed(pose(placed.rotation, shift), fitted), link.name});
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
