// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/core/errors.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
// Included so that every user of poses can differentiate with respect to them.
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>

/// \file
/// Unit dual quaternions as rigid displacements x ↦ R x + t (N17): points, directions, lines,
/// planes, homogeneous transformation matrices.

namespace duet {

namespace detail {

/// `pose(rotation, translation)` (N17) without the check of the norm.
template <class A, class B>
[[nodiscard]] dual_quaternion<promote_t<A, B>> pose_of_unit(const quaternion<A>& rotation,
                                                            const vector3<B>& translation) {
  using T = promote_t<A, B>;
  const quaternion<T> alpha(rotation);
  const quaternion<T> half(T(0), T(translation[0]) / 2, T(translation[1]) / 2,
                           T(translation[2]) / 2);
  return make_dual_quaternion(alpha, half * alpha);
}

template <class Q>
[[noreturn]] DUET_COLD DUET_OUT_OF_LINE void raise_not_unit(Q q) {
  raise(invalid_input(
      message("duet: pose: the rotation ", q, " is not a unit quaternion (use normalized(q))")));
}

} // namespace detail

/// N17: the pose α + εβ with β = ½ t α: first the rotation, a unit quaternion, then the
/// translation.
///
/// \throws invalid_input if |α|² is not 1 within 1e-6 (1e-3 in single precision): the
///   pose would scale points; NaN is accepted
template <class A, Promotable<A> B>
[[nodiscard]] DUET_ALWAYS_INLINE dual_quaternion<promote_t<A, B>>
pose(const quaternion<A>& rotation, const vector3<B>& translation) {
  using std::abs;
  using real = lane_type_t<A>;
  constexpr double tolerance = std::numeric_limits<real>::digits > 24 ? 1e-6 : 1e-3;
  const auto alpha = detail::innermost_of(rotation);
  if (detail::surely_any(abs(squared_norm(alpha) - 1) > tolerance)) [[unlikely]] {
    detail::raise_not_unit(alpha);
  }
  return detail::pose_of_unit(rotation, translation);
}

/// The pose of the homogeneous transformation [R t; 0 1].
///
/// \throws invalid_input as `from_rotation_matrix`
template <class A, Promotable<A> B>
[[nodiscard]] dual_quaternion<promote_t<A, B>> pose(const matrix3<A>& rotation,
                                                    const vector3<B>& translation) {
  return detail::pose_of_unit(from_rotation_matrix(rotation), translation);
}

/// Transforms a point by a pose: R x + t.
template <class T, Promotable<T> U>
[[nodiscard]] vector3<promote_t<T, U>> transform_point(const dual_quaternion<T>& a,
                                                       const vector3<U>& x) {
  const auto rotated = rotate(rotation(a), x);
  const vector3<T> t = translation(a);
  return {rotated[0] + t[0], rotated[1] + t[1],
          rotated[2] + t[2]}; // by components: cheaper than to assemble SIMD packets
}
/// Transforms a direction (a vector without position, such as a normal) by a pose: R n.
template <class T, Promotable<T> U>
[[nodiscard]] vector3<promote_t<T, U>> transform_direction(const dual_quaternion<T>& a,
                                                           const vector3<U>& n) {
  return rotate(rotation(a), n);
}

/// Transforms a line by a pose: A (l + εm) A*, in Plücker coordinates, direction l and moment
/// m = point × l. Also transforms screws and twists.
template <class T, Promotable<T> U>
[[nodiscard]] dual_vector<promote_t<T, U>> transform_line(const dual_quaternion<T>& a,
                                                          const dual_vector<U>& line) {
  return rotate(a, line);
}

/// Plane n·x = offset. The default is z = 0.
template <class T>
struct plane {
  vector3<T> normal = vector3<T>::UnitZ(); ///< n, a unit vector
  T offset = T(0); ///< offset of the plane along n from the origin, in units of length

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("normal", normal);
    f("offset", offset);
  }
};

/// Transforms a plane by a pose: n ↦ R n, offset ↦ offset + R n·t.
template <class T, Promotable<T> U>
[[nodiscard]] plane<promote_t<T, U>> transform_plane(const dual_quaternion<T>& a,
                                                     const plane<U>& p) {
  using R = promote_t<T, U>;
  const vector3<R> normal = rotate(rotation(a), p.normal);
  return {normal, R(p.offset) + normal.dot(translation(a).template cast<R>())};
}

/// The 4 × 4 homogeneous transformation matrix [R t; 0 1] of a pose.
template <class T>
[[nodiscard]] Eigen::Matrix<T, 4, 4> transform_matrix(const dual_quaternion<T>& a) {
  Eigen::Matrix<T, 4, 4> m = Eigen::Matrix<T, 4, 4>::Identity();
  m.template topLeftCorner<3, 3>() = rotation_matrix(rotation(a));
  m.template topRightCorner<3, 1>() = translation(a);
  return m;
}

/// The pose of a 4 × 4 homogeneous transformation matrix [R t; 0 1].
///
/// \throws invalid_input if the last row is not 0 0 0 1, and as `from_rotation_matrix`
template <class T>
[[nodiscard]] dual_quaternion<T> from_transform_matrix(const Eigen::Matrix<T, 4, 4>& m) {
  detail::require(!detail::surely_any(!(innermost(m(3, 0)) == 0 && innermost(m(3, 1)) == 0 &&
                                        innermost(m(3, 2)) == 0 && innermost(m(3, 3)) == 1)),
                  "duet: from_transform_matrix: the last row is ", innermost(m(3, 0)), " ",
                  innermost(m(3, 1)), " ", innermost(m(3, 2)), " ", innermost(m(3, 3)),
                  " (expected 0 0 0 1)");
  return pose(matrix3<T>(m.template topLeftCorner<3, 3>()),
              vector3<T>(m.template topRightCorner<3, 1>()));
}

DUET_REFUSES_FOREIGN(pose, dual_quaternion<double>)
DUET_REFUSES_FOREIGN(transform_point, vector3<double>)
DUET_REFUSES_FOREIGN(transform_direction, vector3<double>)
DUET_REFUSES_FOREIGN(transform_line, dual_vector<double>)
DUET_REFUSES_FOREIGN(transform_matrix, Eigen::Matrix4d)
DUET_REFUSES_FOREIGN(from_transform_matrix, dual_quaternion<double>)

template <class V, class T>
DUET_REFUSED("the rotation is the first argument: pose(q, t)")
dual_quaternion<T> pose(const Eigen::MatrixBase<V>&, const quaternion<T>&);
template <Real T, class V>
DUET_REFUSED("transform_point takes a pose, as pose(q, t); a rotation is applied by rotate(q, v)")
vector3<T> transform_point(const quaternion<T>&, const Eigen::MatrixBase<V>&);

} // namespace duet
