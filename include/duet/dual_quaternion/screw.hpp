// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/select.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>

#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Screw motions: interpolation along them (N19), axis, angle and pitch.

namespace duet {

/// N19: ScLERP (screw linear interpolation), the screw motion C(τ) = A (A* B)^τ from A to B, both
/// of unit norm, by default along the shorter arc of rotation: SLERP over dual numbers.
///
/// \return `dual_quaternion<T>`
template <class A, Promotable<A> B, class S>
[[nodiscard]] auto sclerp(const dual_quaternion<A>& a, const dual_quaternion<B>& b, const S& tau,
                          slerp_arc arc = slerp_arc::shortest) {
  return slerp(a, b, tau, arc);
}

/// Kind of a rigid displacement.
enum class screw_kind {
  none,        ///< no motion
  translation, ///< along the axis, whose position is arbitrary
  rotation,    ///< about the axis
  screw        ///< rotation and translation
};

/// The name of a `screw_kind`.
[[nodiscard]] inline const char* to_text(screw_kind kind) {
  constexpr std::array names{"none", "translation", "rotation", "screw"};
  return names[std::size_t(kind)];
}

/// Rigid displacement as a screw motion: rotation about and translation along one line.
template <class T>
struct screw_motion {
  vector3<T> axis = detail::zero_initialized<vector3<T>>();   ///< unit direction n of the line
  vector3<T> moment = detail::zero_initialized<vector3<T>>(); ///< point × n
  T angle = T(0);                                             ///< φ ∈ [0, π], radians
  T translation = T(0);               ///< d along the axis, in units of length
  screw_kind kind = screw_kind::none; ///< components present: rotation, translation or both

  /// The point of the axis nearest to the origin, n × m, in units of length. Zero without rotation,
  /// as the axis is then anywhere.
  [[nodiscard]] vector3<T> point() const { return axis.cross(moment); }

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("axis", axis);
    f("moment", moment);
    f("angle", angle);
    f("translation", translation);
    f("kind", kind);
  }
};

/// Screw parameters of a pose, the same for A and −A: log A = ½ (φ + εd)(n + εm).
///
/// \param tolerance  angles (radians) and translations (units of length) up to this count as zero:
///   a pure translation has angle 0, its direction as axis, moment 0 and d ≥ 0; the identity has
///   zeros. Below about 1e-8, the default, the position of the axis would be round-off.
template <class T>
[[nodiscard]] screw_motion<T> screw_parameters(const dual_quaternion<T>& a,
                                               double tolerance = 1e-8) {
  const dual_quaternion<T> shorter_arc = select(
      innermost(a.w()) < 0, [&] { return -a; }, [&] { return a; });
  using std::abs;
  using std::atan2;
  using D = screw_dual<T>;
  const quaternion<D> v(D(T(0)), shorter_arc.x(), shorter_arc.y(), shorter_arc.z());
  const auto values = detail::innermost_of(real_part(v));
  if (!(2 * atan2(norm(values), innermost(shorter_arc.w())) > tolerance)) {
    const vector3<T> none = vector3<T>::Zero();
    const vector3<T> shift =
        2 * dual_part(detail::log_vector(shorter_arc, "screw_parameters")); // d n + φ m
    const T d = norm(quaternion<T>(T(0), shift));
    if (!(innermost(d) > tolerance)) {
      return {none, none, T(0), T(0), screw_kind::none};
    }
    return {vector3<T>(shift / d), none, T(0), d, screw_kind::translation};
  }
  // Polar form over dual numbers: A = cos ½Φ + (n + εm) sin ½Φ, Φ = φ + εd.
  const D sine = norm(v);
  const D angle = 2 * atan2(sine, shorter_arc.w());
  const dual_vector<T> line = (v / sine).vec();
  return {real_part(line), dual_part(line), angle.value(), angle.epsilon(),
          abs(innermost(angle.epsilon())) > tolerance ? screw_kind::screw : screw_kind::rotation};
}

/// The pose exp(½ (φ + εd)(n + εm)) of a screw motion: unit axis n, moment m perpendicular to it,
/// angle φ in radians, translation d.
///
/// \return `dual_quaternion<T>`
template <class N, class M, class A, class D>
  requires Promotable<promote_t<N, M>, promote_t<A, D>>
[[nodiscard]] auto from_screw(const vector3<N>& axis, const vector3<M>& moment, const A& angle,
                              const D& translation) {
  using T = detail::differentiable_t<promote_t<promote_t<N, M>, promote_t<A, D>>>;
  return exp(dual_vector<T>(make_dual_vector(axis, moment) *
                            screw_dual<T>(T(T(angle) / 2), T(T(translation) / 2))));
}
/// Pose of a screw motion: the inverse of `screw_parameters`, up to sign.
template <class T>
[[nodiscard]] dual_quaternion<T> from_screw(const screw_motion<T>& s) {
  return from_screw(s.axis, s.moment, s.angle, s.translation);
}

} // namespace duet
