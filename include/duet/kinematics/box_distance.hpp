// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/segment_distance.hpp>
#include <duet/kinematics/shapes.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Nearest points of a segment and a box. For those who extend duet.

namespace duet::detail {

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const box<T>& b, const vector3<T>& x,
                                                const vector3<T>&) {
  using std::sqrt;
  const vector3<T> local = transform_point(conj(b.pose), x);
  vector3<T> excess, outside;
  vector3<T> normal = vector3<T>::Zero();
  Eigen::Index face = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const T sign(innermost(local[i]) < 0 ? -1 : 1);
    excess[i] = sign * local[i] - b.half_extents[i];
    outside[i] = innermost(excess[i]) > 0 ? T(sign * excess[i]) : T(0);
    if (innermost(excess[i]) > innermost(excess[face])) {
      face = i;
    }
  }
  const T square = outside.squaredNorm();
  if (innermost(square) > 0) {
    const T length = sqrt(square);
    return {length, transform_direction(b.pose, vector3<T>(outside / length))};
  }
  normal[face] = T(innermost(local[face]) < 0 ? -1 : 1);
  return {excess[face], transform_direction(b.pose, normal)};
}

/// Segment in the frame of a box, which is |x_i| ≤ half_i, in real numbers.
template <class R>
struct segment_and_box {
  std::array<R, 3> from, along, half;

  [[nodiscard]] R at(std::size_t i, const R& t) const { return from[i] + t * along[i]; }
  /// Side on which x_i exceeds the box; 0: none.
  [[nodiscard]] int side(std::size_t i, const R& t) const {
    return at(i, t) > half[i] ? 1 : at(i, t) < -half[i] ? -1 : 0;
  }
  [[nodiscard]] bool contains(const R& t) const {
    return side(0, t) == 0 && side(1, t) == 0 && side(2, t) == 0;
  }
  /// Largest excess max |x_i| − half_i.
  [[nodiscard]] R excess(const R& t) const {
    const auto one = [&](std::size_t i) {
      const R x = at(i, t);
      return R((x < 0 ? R(-x) : x) - half[i]);
    };
    return std::max({one(0), one(1), one(2)});
  }
};

/// Parameters from 0 to 1, in order, between which no coordinate crosses the plane of a face.
template <class R>
struct face_crossings {
  std::array<R, 8> t{R(0), R(1)};
  std::size_t count = 2;

  explicit face_crossings(const segment_and_box<R>& s) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (const int side : {-1, 1}) {
        const R crossing = s.along[i] == 0 ? R(0) : R((side * s.half[i] - s.from[i]) / s.along[i]);
        if (crossing > 0 && crossing < 1) {
          t[count++] = crossing;
        }
      }
    }
    std::sort(t.begin(), t.begin() + std::ptrdiff_t(count));
  }
  [[nodiscard]] R midpoint(std::size_t k) const { return (t[k] + t[k + 1]) / 2; }
};

/// Deepest point of a segment that passes through a box: the minimum of max(|x_i| − half_i), at
/// an end or where the nearest face changes from a receding to an approaching one.
template <class T, class R>
[[nodiscard]] T deepest_in_box(const segment_and_box<R>& s, const vector3<T>& from,
                               const vector3<T>& along, const vector3<T>& half) {
  T best(s.excess(R(0)) <= s.excess(R(1)) ? 0 : 1);
  R min_excess = s.excess(innermost(best));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (const int a : {-1, 1}) {
        for (const int b : {-1, 1}) {
          // a x_i − half_i falls along the segment and b x_j − half_j rises.
          if (!(a * s.along[i] < 0 && b * s.along[j] > 0)) {
            continue;
          }
          const auto p = Eigen::Index(i), q = Eigen::Index(j);
          const T t =
              (b * from[q] - half[q] - a * from[p] + half[p]) / (a * along[p] - b * along[q]);
          const R t_real = innermost(t);
          if (t_real > 0 && t_real < 1 && s.excess(t_real) < min_excess) {
            min_excess = s.excess(t_real);
            best = t;
          }
        }
      }
    }
  }
  return best;
}

/// Nearest point of a segment to a box. Outside, the squared distance Σ max(0, |x_i| − half_i)² is
/// convex in t and quadratic between crossings of faces, so its minimum is in the first such
/// interval at whose end it does not decrease any more.
template <class T>
[[nodiscard]] T nearest_on_segment(const box<T>& b, const vector3<T>& from_outside,
                                   const vector3<T>& along_outside) {
  using R = real_type_t<T>;
  const vector3<T> from = transform_point(conj(b.pose), from_outside);
  const vector3<T> along = transform_direction(conj(b.pose), along_outside);
  segment_and_box<R> s;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = Eigen::Index(i);
    s.from[i] = innermost(from[k]);
    s.along[i] = innermost(along[k]);
    s.half[i] = innermost(b.half_extents[k]);
  }
  const face_crossings<R> crossings(s);
  for (std::size_t k = 0; k + 1 < crossings.count; ++k) {
    if (s.contains(crossings.midpoint(k))) {
      return deepest_in_box(s, from, along, b.half_extents);
    }
  }
  for (std::size_t k = 0; k + 1 < crossings.count; ++k) {
    T slope(0),
        growth(0); // of half the squared distance at t = 0, if it were that of this interval
    for (std::size_t i = 0; i < 3; ++i) {
      const int side = s.side(i, crossings.midpoint(k));
      if (side != 0) {
        const auto j = Eigen::Index(i);
        slope += (from[j] - side * b.half_extents[j]) * along[j];
        growth += along[j] * along[j];
      }
    }
    if (innermost(growth) == 0) {
      return T(crossings.midpoint(k));
    }
    const T t = -slope / growth;
    if (innermost(t) <= crossings.t[k + 1]) {
      return within_segment(t);
    }
  }
  return T(1);
}

} // namespace duet::detail
