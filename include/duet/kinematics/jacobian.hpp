// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <concepts>
#include <type_traits>

/// \file
/// Geometric Jacobians of a chain (spatial, body and hybrid), in closed form; analytical Jacobians
/// with respect to pose coordinates (translation and quaternion or Euler angles); and the joint
/// efforts that correspond to a wrench on a link.

namespace duet {

namespace detail {

/// A matrix with one column for each joint of a chain.
template <class S, int Rows, int N>
using joint_columns =
    Eigen::Matrix<S, Rows, (N > 0 ? N : Eigen::Dynamic), Eigen::ColMajor, Rows, max_joints<N>>;

template <class C, class X>
using chain_jacobian = joint_columns<chain_scalar<C, X>, 6, C::joints>;

/// A column [v; ω].
template <class S>
struct twist_column {
  three_vector<S> v, omega;
};

template <class S>
[[nodiscard]] DUET_ALWAYS_INLINE twist_column<S> no_twist() {
  return {{S(0), S(0), S(0)}, {S(0), S(0), S(0)}};
}

template <class J>
[[nodiscard]] DUET_ALWAYS_INLINE auto column_of(const J& m, Eigen::Index i) {
  using vector = three_vector<typename J::Scalar>;
  return twist_column<typename J::Scalar>{vector{m(0, i), m(1, i), m(2, i)},
                                          vector{m(3, i), m(4, i), m(5, i)}};
}

template <class J, class S, class... At>
DUET_ALWAYS_INLINE void set_column(J& m, const twist_column<S>& twist, At... at) {
  m(0, at...) = twist.v.x;
  m(1, at...) = twist.v.y;
  m(2, at...) = twist.v.z;
  m(3, at...) = twist.omega.x;
  m(4, at...) = twist.omega.y;
  m(5, at...) = twist.omega.z;
}

/// Screw of a joint in space, v at the fixed origin, for its axis and a point on it.
template <class S, class Step>
[[nodiscard]] DUET_ALWAYS_INLINE twist_column<S>
screw_of(const Step& step, const three_vector<S>& axis, const three_vector<S>& point) {
  auto screw = no_twist<S>();
  if (step.is_rotational()) {
    screw = {cross(point, axis), axis};
  }
  if (step.is_translational()) {
    screw.v = screw.v + step.pitch() * axis;
  }
  return screw;
}

/// Takes v of all columns at the point p instead of the origin: v + ω × p (N20).
template <class J, class S>
DUET_ALWAYS_INLINE void take_at(J& m, const three_vector<S>& p) {
  for (Eigen::Index i = 0; i < m.cols(); ++i) {
    const auto twist = column_of(m, i);
    set_column(m, twist_column<S>{twist.v + cross(twist.omega, p), twist.omega}, i);
  }
}

/// Expresses all columns in the axes of a rotation R: Rᵀv, Rᵀω.
template <class J, class S>
DUET_ALWAYS_INLINE void express_in(J& m, const quaternion<S>& r) {
  const rotation_of_many to_axes(conj(r));
  for (Eigen::Index i = 0; i < m.cols(); ++i) {
    const auto twist = column_of(m, i);
    set_column(m, twist_column<S>{to_axes(twist.v), to_axes(twist.omega)}, i);
  }
}

/// Sets m to the Jacobian of a frame on a chain and returns the pose of that frame, with its
/// rotation only if m needs it or `WithRotation` is true.
template <class Frame, bool WithRotation, class S, class C, class X, class At, class J>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S> fill_jacobian(J& m, const C& chain,
                                                                    const X& theta, const At& at) {
  constexpr bool is_spatial = std::same_as<Frame, spatial_frame>;
  const auto& on = frame_on(chain, at);
  m.resize(6, chain.size());
  const auto put_screw = [&](Eigen::Index i, const auto& step, const auto& axis, const auto& point)
                             DUET_INLINE_LAMBDA { set_column(m, screw_of(step, axis, point), i); };
  constexpr bool needs_rotation = WithRotation || !is_spatial;
  const auto link = walk<needs_rotation, S>(chain, theta, on.link, put_screw);
  for (Eigen::Index i = on.link; i < chain.size(); ++i) { // these joints only move other links
    set_column(m, no_twist<S>(), i);
  }
  const auto at_frame = attached(link, on.offset);
  if constexpr (!is_spatial) {
    take_at(m, at_frame.translation);
  }
  if constexpr (std::same_as<Frame, body_frame>) {
    express_in(m, at_frame.rotation);
  }
  return at_frame;
}

} // namespace detail

/// Forward kinematics and geometric Jacobian: the pose A of a frame on a chain, and its
/// Jacobian there.
///
/// \tparam Frame           see `jacobian`
/// \param at               a link number, or an `attached_frame`; default: the tip
/// \return `value_and_jacobian`
template <SerialChain C, VectorLike X, FrameConstant Frame, FrameOnChain<C> At = tip_of_chain>
[[nodiscard]] DUET_ALWAYS_INLINE auto pose_and_jacobian(const C& chain, const X& theta,
                                                        Frame /*frame*/, const At& at = {}) {
  using S = detail::chain_scalar<C, X>;
  value_and_jacobian<dual_quaternion<S>, detail::chain_jacobian<C, X>> result;
  const auto at_frame = detail::fill_jacobian<Frame, true, S>(result.jacobian, chain, theta, at);
  result.value = detail::pose_of_unit(at_frame.rotation, at_frame.translation.eigen());
  return result;
}

/// The geometric Jacobian J of 6 rows: the twist [v; ω] = J θ̇ of a frame on a chain, by default
/// the end-effector frame (N18, N20). Columns of joints beyond the link are zero. Units: those of θ
/// in the denominator.
///
/// \tparam Frame           `frame::spatial`: fixed axes, v of the body point at the fixed origin,
///                         columns are the joint screws; `frame::body`: axes and origin of the
///                         moving frame; `frame::hybrid`: fixed axes, v of the frame's origin
/// \param at               a link number, or an `attached_frame`, as `chain.tip().at_point({x, y,
///                         z})`; default: the tip
/// \return a matrix of 6 rows and a column for each joint
/// \throws invalid_input if the number of coordinates differs from `size()`, or the link
/// does not exist
template <class C, VectorLike X, FrameConstant Frame,
          FrameOnChain<std::remove_cvref_t<C>> At = tip_of_chain>
  requires SerialChain<std::remove_cvref_t<C>>
[[nodiscard]] DUET_ALWAYS_INLINE auto jacobian(C&& chain, const X& theta, Frame,
                                               const At& at = {}) {
  using chain_type = std::remove_cvref_t<C>;
  using S = detail::chain_scalar<chain_type, X>;
  detail::chain_jacobian<chain_type, X> result;
  static_cast<void>(detail::fill_jacobian<Frame, false, S>(result, chain, theta, at));
  return result;
}

template <class C, VectorLike X>
  requires SerialChain<std::remove_cvref_t<C>> DUET_REFUSED(
      "a chain has three Jacobians, name the frame: jacobian(chain, theta, frame::hybrid)")
detail::chain_jacobian<std::remove_cvref_t<C>, X> jacobian(C&&, const X&);

DUET_ASKS_FOR_ONE_CONFIGURATION(jacobian, Eigen::MatrixXd)
DUET_ASKS_FOR_ONE_CONFIGURATION(pose_and_jacobian,
                                value_and_jacobian<dual_quaternion<double>, Eigen::MatrixXd>)

/// Analytical Jacobian ∂γ/∂θ, 7 rows, of γ = [t; α] (N20, N21): J2 times it is the spatial
/// Jacobian. α is the quaternion of `chain.pose(theta)`, with the sign that it has there. Arguments
/// as `jacobian`.
///
/// \return a matrix of 7 rows and a column for each joint
template <SerialChain C, VectorLike X, FrameOnChain<C> At = tip_of_chain>
[[nodiscard]] auto pose_coordinates_jacobian(const C& chain, const X& theta, const At& at = {}) {
  using S = detail::chain_scalar<C, X>;
  const auto [a, m] = pose_and_jacobian(chain, theta, frame::spatial, at);
  detail::joint_columns<S, 7, C::joints> result(7, m.cols());
  for (Eigen::Index i = 0; i < m.cols(); ++i) {
    result.col(i) = pose_coordinates_rate(a, vector6<S>(m.col(i)));
  }
  return result;
}

/// Analytical Jacobian ∂[t; a, b, c]/∂θ, 6 rows, for the intrinsic Euler angles of a sequence:
/// `euler_jacobian<zyx>(chain, θ)`. Unbounded near gimbal lock, where the rates of the angles do
/// not exist. Arguments as `jacobian`.
///
/// \return a matrix of 6 rows and a column for each joint
template <euler_sequence Sequence, SerialChain C, VectorLike X, FrameOnChain<C> At = tip_of_chain>
[[nodiscard]] auto euler_jacobian(const C& chain, const X& theta, const At& at = {}) {
  using S = detail::chain_scalar<C, X>;
  auto [a, m] = pose_and_jacobian(chain, theta, frame::hybrid, at);
  const auto angles = euler<Sequence>(rotation(a));
  const matrix3<S> axes = euler_rate_matrix<Sequence>(angles[0], angles[1]);
  const vector3<S> x = axes.col(0), y = axes.col(1), z = axes.col(2);
  const vector3<S> yz = y.cross(z), zx = z.cross(x), xy = x.cross(y);
  const S volume = x.dot(yz);
  for (Eigen::Index i = 0; i < m.cols(); ++i) {
    const vector3<S> omega(m(3, i), m(4, i), m(5, i));
    m(3, i) = yz.dot(omega) / volume;
    m(4, i) = zx.dot(omega) / volume;
    m(5, i) = xy.dot(omega) / volume;
  }
  return m;
}

/// τ = Jᵀ F: the joint torques (forces for prismatic joints) of a wrench F = [f; m] that the chain
/// exerts at a frame, with the same power: τ·θ̇ = F·V. Other arguments as `jacobian`.
///
/// \param frame_of_wrench  `frame::spatial`: fixed axes, m about the fixed origin; `frame::body`:
///                         axes and origin of the frame; `frame::hybrid`: fixed axes, m about the
///                         frame's origin
/// \return a column of one effort for each joint
template <SerialChain C, VectorLike X, class W, FrameConstant Frame,
          FrameOnChain<C> At = tip_of_chain>
[[nodiscard]] auto joint_efforts(const C& chain, const X& theta, const vector6<W>& wrench,
                                 Frame frame_of_wrench, const At& at = {}) {
  using S = promote_t<detail::chain_scalar<C, X>, W>;
  const auto m = jacobian(chain, theta, frame_of_wrench, at);
  detail::joint_vector<S, C::joints> result(m.cols());
  for (Eigen::Index i = 0; i < m.cols(); ++i) {
    S sum(0);
    for (Eigen::Index k = 0; k < 6; ++k) {
      sum += m(k, i) * wrench[k];
    }
    result[i] = sum;
  }
  return result;
}

} // namespace duet
