// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/domain.hpp>
#include <duet/comparison/rotations.hpp>
#include <duet/core/random_source.hpp>
#include <duet/dual_quaternion/pose.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Poses as arguments of compared functions.

namespace duet {

/// A pose; its coordinates are its rotation vector (full angle, radians) and its translation.
/// Special and related ones are those of `rotations` with translations that are zero, tiny, large,
/// along the axis of rotation and across it. Of unit norm in every precision, since it is
/// constructed in it.
struct rigid_motions {
  double bound = 2;                ///< maximum absolute value of a component of the translation
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

  [[nodiscard]] std::size_t size() const { return 6; }
  [[nodiscard]] bool contains(std::span<const double> point) const {
    return rotations{largest_angle}.contains(point.first(3)) &&
           vectors<3>{bound}.contains(point.subspan(3));
  }
  [[nodiscard]] std::vector<coordinates> special_points() const {
    std::vector<coordinates> points;
    const auto add = [&](const coordinates& r, const coordinates& t) {
      points.push_back({r[0], r[1], r[2], t[0], t[1], t[2]});
    };
    std::size_t next = 0;
    const std::vector<coordinates> translations = vectors<3>{bound}.special_points();
    for (const coordinates& r : rotations{largest_angle}.special_points()) {
      add(r, {0, 0, 0});
      add(r, translations[next++ % translations.size()]);
    }
    return points;
  }
  [[nodiscard]] std::vector<coordinates> related_points(std::span<const double> point,
                                                        random_source& random) const {
    std::vector<coordinates> points;
    for (const coordinates& r : rotations{largest_angle}.related_points(point.first(3), random)) {
      points.push_back({r[0], r[1], r[2], point[3], point[4], point[5]});
    }
    const coordinates other = random_point(random);
    points.push_back({other[0], other[1], other[2], point[3], point[4], point[5]});
    points.push_back({point[0], point[1], point[2], other[3], other[4], other[5]});
    return points;
  }
  [[nodiscard]] coordinates random_point(random_source& random) const {
    coordinates point = rotations{largest_angle}.random_point(random);
    for (int i = 0; i < 3; ++i) {
      point.push_back(random.uniform(-bound, bound));
    }
    return point;
  }
  [[nodiscard]] std::string describe(std::span<const double> point) const {
    return rotations{}.describe(point.first(3)) + ", translation " +
           detail::tuple_text(point.subspan(3));
  }
  template <class T>
  [[nodiscard]] dual_quaternion<T> make(std::span<const double> point) const {
    return pose(rotations{}.make<T>(point.first(3)), vectors<3>{}.make<T>(point.subspan(3)));
  }
};

} // namespace duet
