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
#include <vector>

/// \file
/// Rotations and quaternions as arguments of compared functions.

namespace duet {

/// A unit quaternion; its coordinates are its rotation vector (full angle, radians). Special:
/// identity, tiny rotations, half turns about the axes and a diagonal, and nearly full turns. A
/// unit in every precision, since it is made in it.
struct rotations {
  double largest_angle = 6.283185; ///< just below a full turn, where the rotation vector jumps

  // For those who extend duet: what an `InputDomain` is asked.

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

/// Any quaternion but zero, with components between −bound and bound; its coordinates are its
/// components, scalar first. Special: ±1, the imaginary units, and nearly real ones.
struct quaternions {
  double bound = 2; ///< the largest size of a component

  // For those who extend duet: what an `InputDomain` is asked.

  [[nodiscard]] std::size_t size() const { return 4; }
  [[nodiscard]] bool contains(std::span<const double> point) const {
    return std::all_of(point.begin(), point.end(),
                       [this](double x) { return std::abs(x) <= bound; }) &&
           std::any_of(point.begin(), point.end(), [](double x) { return x != 0; });
  }
  [[nodiscard]] std::vector<coordinates> special_points() const {
    std::vector<coordinates> points;
    for (const coordinates& unit :
         {coordinates{1, 0, 0, 0}, coordinates{-1, 0, 0, 0}, coordinates{0, 1, 0, 0},
          coordinates{0, 0, -1, 0}, coordinates{0, 0, 0, 1}, coordinates{1, 1e-8, 0, 0},
          coordinates{0.5, 0, 1e-4, 0}, coordinates{0.5, 0.5, 0.5, 0.5}}) {
      points.push_back(unit);
      for (double& x : points.back()) {
        x *= bound;
      }
    }
    return points;
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
