// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <cstddef>

/// \file
/// One joint of a chain as an evaluation step; forward kinematics and Jacobians are made of these.

namespace duet::detail {

/// A joint prepared for evaluation. With the joint's frame displaced by (a, l) from the previous
/// one and n its axis, the rotation q of the previous link becomes q (cos(θ/2) a + sin(θ/2) a n).
template <class T>
struct joint_step {
  quaternion<T> a{T(1)};
  quaternion<T> an{};
  three_vector<T> offset{}; ///< l
  three_vector<T> axis{};   ///< a n a*, the axis in the frame of the previous joint
  T pitch{};                ///< translation along the axis per unit of θ; 1 if purely prismatic
  bool is_rotational = true;
  bool is_translational = false;
};

/// A step of a table in memory. (If functions of chains read `joint_step` directly, clang takes 8 %
/// more instructions for a Jacobian.)
template <class T>
struct step_in_memory {
  const joint_step<T>& s;

  [[nodiscard]] bool is_rotational() const { return s.is_rotational; }
  [[nodiscard]] bool is_translational() const { return s.is_translational; }
  template <class S, class HalfAngles>
  [[nodiscard]] DUET_ALWAYS_INLINE quaternion<S> rotation(const HalfAngles& half_angles,
                                                          Eigen::Index i) const {
    if (!s.is_rotational) {
      return quaternion<S>(s.a);
    }
    const sine_cosine<S> half = half_angles[int(i)];
    const S &c = half.cosine, &sine = half.sine; // no intermediate quaternions of duals
    return {c * s.a.w() + sine * s.an.w(), c * s.a.x() + sine * s.an.x(),
            c * s.a.y() + sine * s.an.y(), c * s.a.z() + sine * s.an.z()};
  }
  [[nodiscard]] const three_vector<T>& offset() const { return s.offset; }
  [[nodiscard]] const three_vector<T>& axis() const { return s.axis; }
  [[nodiscard]] T pitch() const { return s.pitch; }
};

/// The I-th step of a table known to the compiler.
template <class Arm, std::size_t I>
struct known_step {
  static constexpr const auto& s() { return Arm::chain.steps()[I]; }

  [[nodiscard]] static constexpr bool is_rotational() { return s().is_rotational; }
  [[nodiscard]] static constexpr bool is_translational() { return s().is_translational; }
  template <class S, class HalfAngles>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto rotation(const HalfAngles& half_angles,
                                                        Eigen::Index i) {
    constexpr auto a = known_quaternion([] { return s().a; });
    if constexpr (!is_rotational()) {
      return a;
    } else {
      const sine_cosine<S> half = half_angles[int(i)];
      return half.cosine * a + half.sine * known_quaternion([] { return s().an; });
    }
  }
  [[nodiscard]] static constexpr auto offset() {
    return known_vector([] { return s().offset; });
  }
  [[nodiscard]] static constexpr auto axis() {
    return known_vector([] { return s().axis; });
  }
  [[nodiscard]] static constexpr auto pitch() { return s().pitch; }
};

/// Pose of the link after joint i. Calls `visit(i, step, axis, position)` with the joint's axis in
/// space and a point on it.
///
/// \tparam WithRotation  true if the rotation after the joint is required
template <bool WithRotation, class Link, class Step, class S, class HalfAngles, class Visit>
[[nodiscard]] DUET_ALWAYS_INLINE auto
after_joint(const Link& link, const Step& step, Eigen::Index i, const S& theta,
            const HalfAngles& half_angles, const Visit& visit) {
  three_vector<S> p = link.point(step.offset());
  const three_vector<S> axis = rotated(link.rotation, step.axis());
  if (step.is_translational()) {
    p = p + theta * step.pitch() * axis;
  }
  visit(i, step, axis, p);
  if constexpr (WithRotation) {
    return displacement{link.rotation * step.template rotation<S>(half_angles, i), p};
  } else {
    return displacement{link.rotation, p};
  }
}

} // namespace duet::detail
