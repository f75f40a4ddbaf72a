// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/shapes.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

/// \file
/// Signed distance and closest points of a capsule and an obstacle or another capsule.

namespace duet {

/// Closest points of a body and an obstacle or another body, or the deepest ones if they overlap.
template <class T>
struct proximity {
  T distance = T(0); ///< signed distance; if they overlap, negative, the penetration depth
  /// Point of the body's surface.
  vector3<T> on_body = detail::zero_initialized<vector3<T>>();
  /// Point of the obstacle's surface.
  vector3<T> on_obstacle = detail::zero_initialized<vector3<T>>();
  /// Unit normal out of the obstacle: on_body = on_obstacle + distance · normal.
  vector3<T> normal = detail::zero_initialized<vector3<T>>();

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("distance", distance);
    f("on_body", on_body);
    f("on_obstacle", on_obstacle);
    f("normal", normal);
  }
};

namespace detail {

/// Signed distance of a point and its gradient.
template <class T>
struct point_distance {
  T distance;
  vector3<T> normal;
};

template <class T>
[[nodiscard]] vector3<T> cross_product(const vector3<T>& a, const vector3<T>& b) {
  return cross(components(a), components(b));
}

/// Unit vector perpendicular to both, or to the longer one if the other has no length or, up to
/// round-off, the same direction: constant.
template <class T>
[[nodiscard]] vector3<T> across(const vector3<T>& a, const vector3<T>& b) {
  using std::sqrt;
  using R = real_type_t<T>;
  const auto real = [](const vector3<T>& x) {
    return vector3<R>(innermost(x[0]), innermost(x[1]), innermost(x[2]));
  };
  const auto longer = [](const vector3<R>& x, const vector3<R>& y) {
    return x.squaredNorm() < y.squaredNorm() ? y : x;
  };
  const vector3<R> along = longer(real(a), real(b));
  vector3<R> result = cross_product(real(a), real(b));
  if (result.squaredNorm() <=
      std::numeric_limits<R>::epsilon() * real(a).squaredNorm() * real(b).squaredNorm()) {
    result = longer(cross_product(along, vector3<R>(vector3<R>::UnitX())),
                    cross_product(along, vector3<R>(vector3<R>::UnitY())));
  }
  const R square = result.squaredNorm();
  return square == 0 ? vector3<T>(vector3<T>::UnitZ())
                     : vector3<T>((result / sqrt(square)).template cast<T>());
}

/// The parameter of the nearest point of a line, limited to its segment. At an end it is constant:
/// a rate would be wrong if another condition makes the end the nearest point.
template <class T>
[[nodiscard]] T within_segment(const T& t) {
  return innermost(t) <= 0 ? T(0) : innermost(t) >= 1 ? T(1) : t;
}

/// Parameter t of the point from + t · along, 0 ≤ t ≤ 1, that is nearest to x.
template <class T>
[[nodiscard]] T nearest_to_point(const vector3<T>& x, const vector3<T>& from,
                                 const vector3<T>& along) {
  const T square = along.squaredNorm();
  return innermost(square) == 0 ? T(0) : within_segment(T(along.dot(x - from) / square));
}

// Signed distance of the nearest point x of a segment, and the direction out of the obstacle. The
// direction of the segment is needed if x is on the obstacle's axis or centre, or their difference
// is round-off: the direction out is then perpendicular to both.

/// Signed distance from all points within `radius` of an axis, whose point `nearest` is nearest to
/// x.
template <class T>
[[nodiscard]] point_distance<T> distance_from_axis(const vector3<T>& nearest, const vector3<T>& x,
                                                   const T& radius, const vector3<T>& along,
                                                   const vector3<T>& axis) {
  using std::sqrt;
  using R = real_type_t<T>;
  const vector3<T> difference = x - nearest;
  const T square = difference.squaredNorm();
  const R rounding = 8 * std::numeric_limits<R>::epsilon();
  // Ends of both segments, from which x and `nearest` are computed, may be far from the origin.
  const T size = x.squaredNorm() + along.squaredNorm() + axis.squaredNorm();
  if (innermost(square) <= rounding * rounding * innermost(size)) {
    const vector3<T> out = across(along, axis);
    return {T(out.dot(difference) - radius), out};
  }
  const T length = sqrt(square);
  return {T(length - radius), vector3<T>(difference / length)};
}

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const sphere<T>& s, const vector3<T>& x,
                                                const vector3<T>& along) {
  return distance_from_axis(s.centre, x, s.radius, along, vector3<T>(vector3<T>::Zero()));
}

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const capsule<T>& c, const vector3<T>& x,
                                                const vector3<T>& along) {
  const vector3<T> axis = c.to - c.from;
  const vector3<T> nearest = c.from + nearest_to_point(x, c.from, axis) * axis;
  return distance_from_axis(nearest, x, c.radius, along, axis);
}

template <class T>
[[nodiscard]] point_distance<T> signed_distance(const half_space<T>& h, const vector3<T>& x,
                                                const vector3<T>&) {
  return {T(h.normal.dot(x) - h.offset), h.normal};
}

// The point of a segment from + t · along, 0 ≤ t ≤ 1, with the smallest signed distance from an
// obstacle. Which case holds is decided by real values; t itself is computed over the scalar.

template <class T>
[[nodiscard]] T nearest_on_segment(const sphere<T>& s, const vector3<T>& from,
                                   const vector3<T>& along) {
  return nearest_to_point(s.centre, from, along);
}

/// Nearest point of a segment to a capsule. Lines are nearest to each other where (w − t u) × v is
/// along n = u × v, w between their beginnings: t = (w × v)·n / n². If that is beyond an end of one
/// of the segments, an end is nearest. Products of coordinates, u²v² − (u·v)², would lose t to
/// cancellation if lines are nearly parallel.
///
/// There t is ill-conditioned, and the distance changes little with t: within 1e-6 of parallel t
/// counts as constant, or round-off times its rate would dominate gradients.
template <class T>
[[nodiscard]] T nearest_on_segment(const capsule<T>& c, const vector3<T>& from,
                                   const vector3<T>& along) {
  const vector3<T> axis = c.to - c.from;
  const T first = nearest_to_point(c.from, from, along);
  const T last = nearest_to_point(c.to, from, along);
  const vector3<T> normal = cross_product(along, axis);
  const T square = normal.squaredNorm();
  if (innermost(square) == 0) {
    return (first + last) / T(2); // the midpoint of the overlap
  }
  const auto distance = [&](const T& t) {
    const vector3<T> x = from + t * along;
    return innermost((x - c.from - nearest_to_point(x, c.from, axis) * axis).squaredNorm());
  };
  T best = within_segment(T(cross_product(vector3<T>(c.from - from), axis).dot(normal) / square));
  if (innermost(square) < 1e-12 * innermost(along.squaredNorm()) * innermost(axis.squaredNorm())) {
    best = T(innermost(best));
  }
  auto min_distance = distance(best);
  for (const T& end : {first, last, T(0), T(1)}) {
    const auto end_distance = distance(end);
    if (end_distance < min_distance) {
      min_distance = end_distance;
      best = end;
    }
  }
  return best;
}

template <class T>
[[nodiscard]] T nearest_on_segment(const half_space<T>& h, const vector3<T>&,
                                   const vector3<T>& along) {
  const auto slope = innermost(h.normal.dot(along));
  return slope == 0 ? T(1) / T(2) : T(slope < 0 ? 1 : 0);
}

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
  /// Distance by which the face on a side, ±1, is exceeded.
  [[nodiscard]] R excess(std::size_t i, int side, const R& t) const {
    return side * at(i, t) - half[i];
  }
  /// Largest excess max |x_i| − half_i.
  [[nodiscard]] R excess(const R& t) const {
    return std::max({excess(0, 1, t), excess(0, -1, t), excess(1, 1, t), excess(1, -1, t),
                     excess(2, 1, t), excess(2, -1, t)});
  }
  /// Round-off of an excess.
  [[nodiscard]] R rounding() const {
    using std::abs;
    R size(0);
    for (std::size_t i = 0; i < 3; ++i) {
      size = std::max({size, R(abs(from[i]) + abs(along[i])), half[i]});
    }
    return 8 * std::numeric_limits<R>::epsilon() * size;
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
  R min_excess = s.excess(innermost(best)), best_of_pair = min_excess;
  const R rounding = s.rounding();
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
          if (!(t_real > 0 && t_real < 1)) {
            continue;
          }
          // At the same t other faces may balance that are not the nearest: opposite ones of a
          // cube.
          const R excess = s.excess(t_real);
          const R of_pair = std::max(s.excess(i, a, t_real), s.excess(j, b, t_real));
          if (excess < min_excess - rounding ||
              (excess <= min_excess + rounding && of_pair > best_of_pair + rounding)) {
            min_excess = excess;
            best_of_pair = of_pair;
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
      // Along a segment parallel to the faces up to round-off t is ill-conditioned, as for
      // capsules, and may be far before this interval.
      const bool is_parallel = innermost(growth) < 1e-12 * innermost(along.squaredNorm());
      const R t_real = std::max(R(innermost(t)), crossings.t[k]);
      return is_parallel || t_real == crossings.t[k] ? T(t_real) : t;
    }
  }
  return T(1);
}

template <class S, class T>
[[nodiscard]] sphere<S> with_scalar(const sphere<T>& s) {
  return {s.centre.template cast<S>(), S(s.radius)};
}
template <class S, class T>
[[nodiscard]] capsule<S> with_scalar(const capsule<T>& c) {
  return {c.from.template cast<S>(), c.to.template cast<S>(), S(c.radius)};
}
template <class S, class T>
[[nodiscard]] box<S> with_scalar(const box<T>& b) {
  return {dual_quaternion<S>(b.pose), b.half_extents.template cast<S>()};
}
template <class S, class T>
[[nodiscard]] half_space<S> with_scalar(const half_space<T>& h) {
  return {h.normal.template cast<S>(), S(h.offset)};
}

} // namespace detail

/// Signed distance and closest points: the minimum of dist(x) − r over the points x of a capsule's
/// axis, r its radius; exact, without iteration. dist is an obstacle's signed distance, in a box
/// minus that to the nearest face.
///
/// Derivatives with respect to any infinitesimals in body and obstacle are those of the distance
/// and of the points. If several points are equally near they are those of one of them, in the
/// middle of a side that is parallel to the axis. If axes cross or touch, they are those of a
/// separating motion perpendicular to both.
///
/// \param body  a capsule or a sphere
/// \param obstacle  a sphere, a capsule, a `box` or a `half_space`
template <template <class> class Body, class T, template <class> class Obstacle, class U>
  requires Promotable<T, U> && std::constructible_from<capsule<T>, Body<T>>
[[nodiscard]] proximity<promote_t<T, U>> closest_points(const Body<T>& body,
                                                        const Obstacle<U>& obstacle) {
  using S = promote_t<T, U>;
  const auto c = detail::with_scalar<S>(capsule<T>(body));
  const auto o = detail::with_scalar<S>(obstacle);
  const vector3<S> along = c.to - c.from;
  const vector3<S> x = c.from + detail::nearest_on_segment(o, c.from, along) * along;
  const auto [distance, normal] = detail::signed_distance(o, x, along);
  return {S(distance - c.radius), vector3<S>(x - c.radius * normal),
          vector3<S>(x - distance * normal), normal};
}

} // namespace duet
