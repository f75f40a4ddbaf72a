// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "constrained_step.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/closest_points.hpp>
#include <duet/robotics/bounding_capsules.hpp>

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

namespace duet {
namespace {

using detail::across, detail::cross_product, detail::inequality, detail::least_distance,
    detail::nearest_to_point;

using points_in_space = std::vector<vector3<double>>;

/// Distance of a point from a segment, the parameter t of the nearest point, and the direction from
/// that point.
struct segment_proximity {
  double distance, t;
  vector3<double> normal;
};
[[nodiscard]] segment_proximity proximity_to_segment(const vector3<double>& x,
                                                     const vector3<double>& from,
                                                     const vector3<double>& to) {
  const double t = nearest_to_point(x, from, vector3<double>(to - from));
  const vector3<double> difference = x - (1 - t) * from - t * to;
  const double length = difference.norm();
  return {length, t, length > 0 ? vector3<double>(difference / length) : vector3<double>::Zero()};
}

/// Thinnest capsule around points with given ends of its axis.
[[nodiscard]] capsule<double> around(const points_in_space& points, const vector3<double>& from,
                                     const vector3<double>& to) {
  double radius = 0;
  for (const auto& x : points) {
    radius = std::max(radius, proximity_to_segment(x, from, to).distance);
  }
  return {from, to, radius};
}

/// Capsule along a direction, centred on the points, with an axis of `part` times their extent.
[[nodiscard]] capsule<double> around(const points_in_space& points,
                                     const vector3<double>& direction, double part) {
  const vector3<double> d = direction.normalized();
  const vector3<double> e = across(d, vector3<double>(vector3<double>::Zero()));
  const std::array<vector3<double>, 3> axes = {d, e, cross_product(d, e)};
  vector3<double> centre = vector3<double>::Zero();
  double half = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [lowest, highest] = std::minmax_element(
        points.begin(), points.end(), [&](const vector3<double>& a, const vector3<double>& b) {
          return axes[k].dot(a) < axes[k].dot(b);
        });
    const double low = axes[k].dot(*lowest), high = axes[k].dot(*highest);
    centre += (low + high) / 2 * axes[k];
    half = k == 0 ? (high - low) / 2 : half;
  }
  const vector3<double> end = part * half * d;
  return around(points, centre - end, centre + end);
}

/// Capsule around points of smaller volume. Each step moves ends and radius to minimise the volume,
/// to first order, plus the squared step while, to first order, all points stay within. Steps that
/// reduce the volume are accepted; the weight of the squared step is adapted.
[[nodiscard]] capsule<double> shrunk(const points_in_space& points, capsule<double> c, int rounds) {
  using step = Eigen::Matrix<double, 7, 1>; // changes of `from`, `to` and the radius
  double reach = .1;                        // factor of the first-order change of the volume
  double min_volume = volume_of(c);
  for (int round = 0; round < rounds && reach > 1e-10; ++round) {
    const vector3<double> along = c.to - c.from;
    const double length = along.norm(), r = c.radius;
    const vector3<double> u = length > 0 ? vector3<double>(along / length) : vector3<double>(along);
    step descent_step;
    descent_step << r * r * u, -r * r * u, -2 * r * length - 4 * r * r;
    descent_step *= reach;
    std::vector<inequality<step>> within;
    for (const auto& x : points) {
      const auto [distance, t, n] = proximity_to_segment(x, c.from, c.to);
      step gradient;
      gradient << (1 - t) * n, t * n, 1;
      within.push_back({gradient, distance - r - gradient.dot(descent_step)});
    }
    const auto correction = least_distance(within, 7);
    if (correction) {
      const step total = descent_step + *correction;
      const capsule<double> next = around(points, vector3<double>(c.from + total.head<3>()),
                                          vector3<double>(c.to + total.segment<3>(3)));
      const double size = volume_of(next);
      if (size < min_volume) {
        const bool is_done = min_volume - size < 1e-9 * min_volume;
        c = next;
        min_volume = size;
        reach *= 2;
        if (is_done) {
          break;
        }
        continue;
      }
    }
    reach /= 4;
  }
  return c;
}

/// Directions all around, no two of them opposite.
[[nodiscard]] points_in_space directions_around() {
  points_in_space result;
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      for (int k = -1; k <= 1; ++k) {
        if (9 * i + 3 * j + k > 0) {
          result.emplace_back(i, j, k);
        }
      }
    }
  }
  return result;
}

/// Adds, in each octant about a capsule's centre, the point that is farthest outside its surface.
void add_outermost(const points_in_space& all, const capsule<double>& c, points_in_space& chosen) {
  const vector3<double> centre = (c.from + c.to) / 2;
  std::array<const vector3<double>*, 8> farthest{};
  std::array<double, 8> max_distance;
  max_distance.fill(c.radius * (1 + 1e-9));
  for (const auto& x : all) {
    const double distance = proximity_to_segment(x, c.from, c.to).distance;
    const std::size_t octant = std::size_t(x[0] > centre[0]) + 2U * std::size_t(x[1] > centre[1]) +
                               4U * std::size_t(x[2] > centre[2]);
    if (distance > max_distance[octant]) {
      max_distance[octant] = distance;
      farthest[octant] = &x;
    }
  }
  for (const auto* x : farthest) {
    if (x != nullptr) {
      chosen.push_back(*x);
    }
  }
}

/// Path of a mesh file: `package://` stands for the folder, and relative paths are in it.
[[nodiscard]] std::string mesh_path(const std::string& file, const std::string& folder) {
  constexpr std::string_view package = "package://", local = "file://";
  if (file.starts_with(local)) {
    return file.substr(local.size());
  }
  const bool is_in_package = file.starts_with(package);
  const std::string path = is_in_package ? file.substr(package.size()) : file;
  return folder.empty() || (path.starts_with('/') && !is_in_package) ? path : folder + "/" + path;
}

[[nodiscard]] triangle_mesh surface_of(const collision_mesh& mesh, const std::string& folder) {
  triangle_mesh result = read_mesh(mesh_path(mesh.file, folder));
  for (auto& x : result.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] *= mesh.scale[i];
    }
  }
  return result;
}

} // namespace

DUET_ABI_BEGIN

double volume_of(const capsule<double>& c) {
  const double r = c.radius;
  return std::numbers::pi * r * r * ((c.to - c.from).norm() + 4 * r / 3);
}

double volume_of(const collision_box& b) { return b.size[0] * b.size[1] * b.size[2]; }

double volume_of(const collision_cylinder& c) {
  return std::numbers::pi * c.radius * c.radius * c.length;
}

double volume_of(const collision_sphere& s) {
  return 4 * std::numbers::pi * s.radius * s.radius * s.radius / 3;
}

double volume_of(const collision_capsule& c) {
  return volume_of(collision_cylinder{c.radius, c.length}) + volume_of(collision_sphere{c.radius});
}

double volume_of(const triangle_mesh& m) {
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

capsule<double> bounding_capsule(const collision_cylinder& cylinder) {
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

capsule<double> bounding_capsule(const collision_box& b) {
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

capsule<double> bounding_capsule(const collision_capsule& c) {
  return {{0, 0, -c.length / 2}, {0, 0, c.length / 2}, c.radius};
}

capsule<double> bounding_capsule(const collision_sphere& s) {
  return sphere<double>{vector3<double>::Zero(), s.radius};
}

capsule<double> bounding_capsule(const triangle_mesh& m) {
  std::vector<vector3<double>> points;
  points.reserve(m.vertices.size());
  for (const auto& x : m.vertices) {
    points.emplace_back(x[0], x[1], x[2]);
  }
  return bounding_capsule(points);
}

capsule<double> bounding_capsule(const std::vector<vector3<double>>& points) {
  detail::require(!points.empty(), "duet: bounding_capsule: the list of points is empty");
  vector3<double> low = points[0], high = points[0];
  for (const auto& x : points) {
    detail::require(detail::all_finite(x), "duet: bounding_capsule: point ", &x - points.data(),
                    " is not finite");
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  // Units in which the longest edge of the bounding box is 2.
  const vector3<double> centre = low / 2 + high / 2;
  const double unit = (high - low).maxCoeff() / 2;
  if (!(unit > 0)) {
    return sphere<double>{points[0], 0};
  }
  points_in_space all;
  all.reserve(points.size());
  for (const auto& x : points) {
    all.emplace_back((x - centre) / unit);
  }
  const auto directions = directions_around();
  points_in_space chosen;
  for (const auto& d : directions) {
    const auto [lowest, highest] = std::minmax_element(
        all.begin(), all.end(), [&](const auto& a, const auto& b) { return d.dot(a) < d.dot(b); });
    chosen.push_back(*lowest);
    chosen.push_back(*highest);
  }
  std::vector<capsule<double>> candidates;
  for (const auto& d : directions) {
    for (const double part : {.2, .4, .6, .9}) {
      candidates.push_back(shrunk(chosen, around(chosen, d, part), 8));
    }
  }
  const auto is_smaller = [](const capsule<double>& a, const capsule<double>& b) {
    return volume_of(a) < volume_of(b);
  };
  std::sort(candidates.begin(), candidates.end(), is_smaller);
  candidates.erase(candidates.begin() + 8, candidates.end());
  for (capsule<double>& each : candidates) {
    each = shrunk(chosen, each, 200);
  }
  capsule<double> best = *std::min_element(candidates.begin(), candidates.end(), is_smaller);
  for (int round = 0; round < 100; ++round) {
    const std::size_t before = chosen.size();
    add_outermost(all, best, chosen);
    if (chosen.size() == before) {
      break;
    }
    best = shrunk(chosen, around(chosen, best.from, best.to), 200);
  }
  return around(points, vector3<double>(centre + unit * best.from),
                vector3<double>(centre + unit * best.to));
}

DUET_ABI_END
namespace detail {
DUET_ABI_BEGIN

bounding_capsules_result bounding_capsules(const std::vector<shape_on_link>& shapes,
                                           const std::string& folder) {
  bounding_capsules_result result;
  for (const shape_on_link& each : shapes) {
    const placement<double> shape_pose = each.offset * each.shape.frame;
    const auto add = [&](const auto& shape) {
      const capsule<double> fitted = bounding_capsule(shape);
      const vector3<double> shift(shape_pose.translation.data());
      result.bodies.push_back(
          {each.link, transformed(pose(shape_pose.rotation, shift), fitted), each.name});
      result.volume_ratios.push_back(volume_of(fitted) / volume_of(shape));
    };
    std::visit(
        [&](const auto& shape) {
          if constexpr (requires { shape.file; }) {
            add(surface_of(shape, folder));
          } else {
            add(shape);
          }
        },
        each.shape.geometry);
  }
  return result;
}

DUET_ABI_END
} // namespace detail
} // namespace duet
