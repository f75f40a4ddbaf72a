// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/select.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

/// \file
/// Unit quaternions as active rotations v ↦ q v q*: vectors, axis and angle, rotation vectors,
/// matrices. Angles in radians.

namespace duet {

/// Rotates the vector v by a unit quaternion: q v q*.
template <class T, Promotable<T> U>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<promote_t<T, U>> rotate(const quaternion<T>& q,
                                                                 const vector3<U>& v) {
  return detail::rotated(q, detail::three_vector<const U&>{v[0], v[1], v[2]});
}

/// Rotation by the angle a, in radians, about the direction n of any length.
///
/// \throws invalid_input if n is zero
template <class T, Promotable<T> S>
[[nodiscard]] quaternion<detail::differentiable_t<promote_t<T, S>>>
from_axis_angle(const vector3<T>& n, const S& a) {
  using std::cos;
  using std::sin;
  using R = detail::differentiable_t<promote_t<T, S>>;
  using U = detail::as_real_of<T, R>;
  const quaternion<U> direction(U(0), U(n[0]), U(n[1]), U(n[2]));
  detail::require(!detail::surely_any(detail::is_zero(direction)),
                  "duet: from_axis_angle: the axis is the zero vector");
  const quaternion<U> axis = normalized(direction);
  const R half = R(a) / 2;
  const R s = sin(half);
  return {cos(half), axis.x() * s, axis.y() * s, axis.z() * s};
}

/// Rotation by the angle |r|, in radians, about r: exp(r/2).
template <class T>
[[nodiscard]] quaternion<detail::differentiable_t<T>> from_rotation_vector(const vector3<T>& r) {
  using S = detail::differentiable_t<T>;
  return duet::exp(vector3<S>(S(r[0]) / 2, S(r[1]) / 2, S(r[2]) / 2));
}

/// Rotation vector of q, angle times axis, of length at most π: the same for q and −q, q of any
/// norm. At a half turn (q₀ = 0) both r and −r are rotation vectors; the one given by the sign of q
/// is returned.
///
/// \throws invalid_input for the zero quaternion
template <class T>
[[nodiscard]] vector3<T> rotation_vector(const quaternion<T>& q) {
  const quaternion<T> shorter_arc = select(
      innermost(q.w()) < 0, [&] { return -q; }, [&] { return q; });
  const vector3<T> half = detail::log_vector(shorter_arc, "rotation_vector");
  return {2 * half[0], 2 * half[1], 2 * half[2]};
}

namespace detail {

template <class T>
[[nodiscard]] quaternion<T> shortest_rotation(const vector3<T>& a, const vector3<T>& b) {
  using real = real_type_t<T>;
  const vector3<T> u = normalized(quaternion<T>(T(0), a)).vec();
  const vector3<T> v = normalized(quaternion<T>(T(0), b)).vec();
  // 1 + u·v = |u + v|²/2 and u × v = u × (v ± u). The sum of opposite unit vectors and the
  // difference of equal ones are exact, so nothing cancels.
  const vector3<T> sum = u + v;
  const T w = sum.squaredNorm() / 2;
  const bool same_side = !(innermost(w) < 1);
  const vector3<T> nearer = select(
      same_side, [&] { return vector3<T>(v - u); }, [&] { return sum; });
  const quaternion<T> q(w, vector3<T>(u.cross(nearer)));
  const auto largest = [](const vector3<T>& x) {
    return largest_component(innermost_of(quaternion<T>(T(0), x)));
  };
  // The sum is perpendicular to u, up to the deviation of u and v from unit length. If the sum is
  // no larger than that deviation, u and v are opposite.
  const bool is_determined = same_side || 4 * largest(q.vec()) > largest(sum);
  const auto chosen =
      vector3<real>(innermost(u[0]), innermost(u[1]), innermost(u[2])).unitOrthogonal().eval();
  const auto component = [&](real value) {
    return undetermined(value, T(u[0] + v[0]), T(u[1] + v[1]), T(u[2] + v[2]));
  };
  return normalized(select(
      is_determined, [&] { return q; },
      [&] {
        return quaternion<T>(component(real(0)), component(chosen[0]), component(chosen[1]),
                             component(chosen[2]));
      }));
}

} // namespace detail

/// Shortest rotation that takes the direction of a to that of b. For opposite directions the axis
/// is undetermined: one perpendicular to a is chosen, without derivatives.
///
/// \throws invalid_input if a or b is zero
template <class A, Promotable<A> B>
[[nodiscard]] quaternion<detail::differentiable_t<promote_t<A, B>>>
from_two_vectors(const vector3<A>& a, const vector3<B>& b) {
  using T = detail::differentiable_t<promote_t<A, B>>;
  return detail::by_lane(
      [](const auto& u, const auto& v) { return detail::shortest_rotation(u, v); },
      vector3<T>(a.template cast<T>()), vector3<T>(b.template cast<T>()));
}

namespace detail {

/// v ↦ q v q* for several v, by the matrix of q.
template <class T>
class rotation_of_many {
public:
  DUET_ALWAYS_INLINE explicit rotation_of_many(const quaternion<T>& q) {
    const T x2 = 2 * q.x(), y2 = 2 * q.y(), z2 = 2 * q.z();
    const T xx = x2 * q.x(), yy = y2 * q.y(), zz = z2 * q.z();
    const T xy = x2 * q.y(), yz = y2 * q.z(), zx = z2 * q.x();
    const T wx = x2 * q.w(), wy = y2 * q.w(), wz = z2 * q.w();
    x_ = {1 - (yy + zz), xy - wz, zx + wy};
    y_ = {xy + wz, 1 - (zz + xx), yz - wx};
    z_ = {zx - wy, yz + wx, 1 - (xx + yy)};
  }
  [[nodiscard]] DUET_ALWAYS_INLINE three_vector<T> operator()(const three_vector<T>& v) const {
    return {dot(x_, v), dot(y_, v), dot(z_, v)};
  }

  [[nodiscard]] DUET_ALWAYS_INLINE matrix3<T> matrix() const { return matrix_of_rows(x_, y_, z_); }

private:
  three_vector<T> x_, y_, z_; ///< rows
};

} // namespace detail

/// Rotation matrix R with R v = q v q*, for a unit quaternion.
template <class T>
[[nodiscard]] matrix3<T> rotation_matrix(const quaternion<T>& q) {
  return detail::rotation_of_many(q).matrix();
}

namespace detail {

template <class T>
[[nodiscard]] quaternion<T> quaternion_of(const matrix3<T>& r) {
  using std::sqrt;
  using real = real_type_t<T>;
  const matrix3<real> values = r.unaryExpr([](const T& x) { return real(innermost(x)); });
  const real defect =
      (values * values.transpose() - matrix3<real>::Identity()).cwiseAbs().maxCoeff();
  const real tolerance = std::numeric_limits<real>::digits > 24 ? real(1e-6) : real(1e-3);
  require(defect <= tolerance && !(values.determinant() < 0),
          "duet: from_rotation_matrix: the matrix is not a rotation: |R R^T - 1| = ", defect,
          ", det R = ", values.determinant(), " (expected 0 and 1)");
  // 4q₀², 4q₁² … from the diagonal; dividing by the largest avoids cancellation.
  const T s[4] = {1 + r(0, 0) + r(1, 1) + r(2, 2), 1 + r(0, 0) - r(1, 1) - r(2, 2),
                  1 - r(0, 0) + r(1, 1) - r(2, 2), 1 - r(0, 0) - r(1, 1) + r(2, 2)};
  const auto larger = [](bool second, const auto& a, const auto& b) {
    return select(
        second, [&] { return b; }, [&] { return a; });
  };
  const bool x_over_w = s[1] > s[0];
  const bool z_over_y = s[3] > s[2];
  const T first = larger(x_over_w, s[0], s[1]);
  const T last = larger(z_over_y, s[2], s[3]);
  const bool is_last = last > first;
  const T half = sqrt(larger(is_last, first, last)) / 2;
  const T f = 1 / (4 * half);
  const T a = (r(2, 1) - r(1, 2)) * f, b = (r(0, 2) - r(2, 0)) * f, c = (r(1, 0) - r(0, 1)) * f;
  const T d = (r(1, 0) + r(0, 1)) * f, e = (r(2, 1) + r(1, 2)) * f, g = (r(0, 2) + r(2, 0)) * f;
  using Q = quaternion<T>;
  return larger(is_last, larger(x_over_w, Q(half, a, b, c), Q(a, half, d, g)),
                larger(z_over_y, Q(b, d, half, e), Q(c, g, e, half)));
}

} // namespace detail

/// Unit quaternion of a rotation matrix, its largest component positive.
///
/// \throws invalid_input if R Rᵀ differs from 1 by more than 1e-6 (1e-3 in single precision), or
///   det R < 0
template <class T>
[[nodiscard]] quaternion<detail::differentiable_t<T>> from_rotation_matrix(const matrix3<T>& r) {
  using S = detail::differentiable_t<T>;
  return detail::by_lane([](const auto& m) { return detail::quaternion_of(m); },
                         matrix3<S>(r.template cast<S>()));
}

DUET_REFUSES_FOREIGN(rotate, vector3<double>)
DUET_REFUSES_FOREIGN(from_axis_angle, quaternion<double>)
DUET_REFUSES_FOREIGN(from_rotation_vector, quaternion<double>)
DUET_REFUSES_FOREIGN(rotation_vector, vector3<double>)
DUET_REFUSES_FOREIGN(from_two_vectors, quaternion<double>)
DUET_REFUSES_FOREIGN(rotation_matrix, matrix3<double>)
DUET_REFUSES_FOREIGN(from_rotation_matrix, quaternion<double>)

template <class V, class T>
DUET_REFUSED("the rotation is the first argument: rotate(q, v)")
vector3<T> rotate(const Eigen::MatrixBase<V>&, const quaternion<T>&);
template <Arithmetic S, class V>
DUET_REFUSED("the axis is the first argument: from_axis_angle(n, a)")
quaternion<double> from_axis_angle(const S&, const Eigen::MatrixBase<V>&);
template <class A, class B>
DUET_REFUSED("the parameter is missing: slerp(p, q, tau), tau from 0 to 1")
quaternion<promote_t<A, B>> slerp(const quaternion<A>&, const quaternion<B>&);
template <Arithmetic S, class A, class B>
DUET_REFUSED("the rotations are the first arguments: slerp(p, q, tau)")
quaternion<promote_t<A, B>> slerp(const S&, const quaternion<A>&, const quaternion<B>&);

} // namespace duet
