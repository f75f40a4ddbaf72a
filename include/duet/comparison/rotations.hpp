// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/domain.hpp>
#include <duet/core/constants.hpp>
#include <duet/core/random_source.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Rotations and quaternions as arguments of compared functions.

namespace duet {

/// A unit quaternion; its coordinates are its rotation vector (full angle, radians). Special:
/// identity, tiny rotations, half turns about the axes and a diagonal, and nearly full turns.
/// Related to q: its inverse, −q, rotations about its axis, and those that are a half turn away. Of
/// unit norm in every precision, since it is constructed in it.
struct rotations {
  double largest_angle = 6.283185; ///< just below a full turn, where the rotation vector jumps

  /// Excludes the point with these coordinates and all points within `radius` of it.
  [[nodiscard]] auto without(const coordinates& point, double radius = 0) const {
    return restricted(*this).without(point, radius);
  }
  /// Excludes the arguments, over `double`, for which `keeps` is false.
  template <class Predicate>
  [[nodiscard]] auto where(Predicate keeps) const {
    return restricted(*this).where(std::move(keeps));
  }

  // For those who extend duet: the members that `InputDomain` requires.

  [[nodiscard]] std::size_t size() const { return 3; }
  [[nodiscard]] bool contains(std::span<const double> point) const {
    return std::hypot(point[0], point[1], point[2]) <= largest_angle;
  }
  [[nodiscard]] std::vector<coordinates> special_points() const {
    const double pi = constant::pi<double>();
    std::vector<coordinates> points = {{0, 0, 0}};
    for (const double angle : {1.0, 1e-4, 1e-8, pi / 2, pi, -pi, largest_angle}) {
      for (const coordinates& axis : {coordinates{1, 0, 0}, coordinates{0, 1, 0},
                                      coordinates{0, 0, 1}, coordinates{0.48, 0.6, 0.64}}) {
        const coordinates point = {angle * axis[0], angle * axis[1], angle * axis[2]};
        if (contains(point)) {
          points.push_back(point);
        }
      }
    }
    return points;
  }
  [[nodiscard]] std::vector<coordinates> related_points(std::span<const double> point,
                                                        random_source& random) const {
    const double pi = constant::pi<double>();
    const double angle = std::hypot(point[0], point[1], point[2]);
    const auto scaled = [&](double factor) {
      return coordinates{factor * point[0], factor * point[1], factor * point[2]};
    };
    const auto axis = random.direction<3>();
    const auto about_axis = [&](double by) {
      return coordinates{by * axis[0], by * axis[1], by * axis[2]};
    };
    const auto away = rotation_vector(
        quaternion<double>(make<double>(point) * quaternion<double>(0, axis[0], axis[1], axis[2])));
    const double opposite = std::min(2 * pi - angle, largest_angle * (1 - 1e-15));
    return {angle > 0 ? scaled(-opposite / angle) : about_axis(opposite), // −q
            {away[0], away[1], away[2]},
            scaled(-1),
            angle > 0 ? scaled(1 - pi / angle) : about_axis(pi), // a half turn about its axis
            scaled(random.uniform(-2, 2))};
  }
  [[nodiscard]] coordinates random_point(random_source& random) const {
    const auto axis = random.direction<3>();
    const double angle = random.uniform(0, largest_angle);
    return {angle * axis[0], angle * axis[1], angle * axis[2]};
  }
  [[nodiscard]] std::string describe(std::span<const double> point) const {
    return "rotation by " + detail::tuple_text(point);
  }
  template <class T>
  [[nodiscard]] quaternion<T> make(std::span<const double> point) const {
    return from_rotation_vector(vector3<T>(T(point[0]), T(point[1]), T(point[2])));
  }
};

/// Any quaternion except zero, with components between −bound and bound; its coordinates are its
/// components, scalar first. Special: nearly zero ones, ±1, the imaginary units, and nearly real
/// ones. Related to q: −q, q*, 1/q, its multiples, and quaternions perpendicular to it.
struct quaternions {
  double bound = 2; ///< maximum absolute value of a component

  /// Excludes the point with these coordinates and all points within `radius` of it.
  [[nodiscard]] auto without(const coordinates& point, double radius = 0) const {
    return restricted(*this).without(point, radius);
  }
  /// Excludes the arguments, over `double`, for which `keeps` is false.
  template <class Predicate>
  [[nodiscard]] auto where(Predicate keeps) const {
    return restricted(*this).where(std::move(keeps));
  }

  // For those who extend duet: the members that `InputDomain` requires.

  [[nodiscard]] std::size_t size() const { return 4; }
  [[nodiscard]] bool contains(std::span<const double> point) const {
    return std::all_of(point.begin(), point.end(),
                       [this](double x) { return std::abs(x) <= bound; }) &&
           std::any_of(point.begin(), point.end(), [](double x) { return x != 0; });
  }
  [[nodiscard]] std::vector<coordinates> special_points() const {
    std::vector<coordinates> points;
    for (const coordinates& unit :
         {coordinates{1e-12, 0, 0, 0}, coordinates{1, 0, 0, 0}, coordinates{-1, 0, 0, 0},
          coordinates{0, 1, 0, 0}, coordinates{0, 0, -1, 0}, coordinates{0, 0, 0, 1},
          coordinates{1, 1e-8, 0, 0}, coordinates{0.5, 0, 1e-4, 0},
          coordinates{0.5, 0.5, 0.5, 0.5}}) {
      points.push_back(unit);
      for (double& x : points.back()) {
        x *= bound;
      }
    }
    return points;
  }
  [[nodiscard]] std::vector<coordinates> related_points(std::span<const double> point,
                                                        random_source& random) const {
    const double w = point[0], x = point[1], y = point[2], z = point[3];
    const double square = w * w + x * x + y * y + z * z, factor = random.uniform(-2, 2);
    return {{-w, -x, -y, -z},
            {w, -x, -y, -z},
            {w / square, -x / square, -y / square, -z / square},
            {factor * w, factor * x, factor * y, factor * z},
            {-x, w, -z, y}};
  }
  [[nodiscard]] coordinates random_point(random_source& random) const {
    coordinates point;
    for (int i = 0; i < 4; ++i) {
      point.push_back(random.uniform(-bound, bound));
    }
    return point;
  }
  [[nodiscard]] std::string describe(std::span<const double> point) const {
    return detail::tuple_text(point);
  }
  template <class T>
  [[nodiscard]] quaternion<T> make(std::span<const double> point) const {
    return {T(point[0]), T(point[1]), T(point[2]), T(point[3])};
  }
};

} // namespace duet
