// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <concepts>
#include <cstddef>
#include <type_traits>

/// \file
/// The geometric Jacobians of a chain, in closed form.

namespace duet {

namespace detail {

/// A matrix of one column per joint of a chain.
template <class S, int Rows, int N>
using joint_columns =
    Eigen::Matrix<S, Rows, (N > 0 ? N : Eigen::Dynamic), Eigen::ColMajor, Rows, (N > 0 ? N : -N)>;

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

/// The screws of the joints up to a link, as columns [v; ω]: in space, v at the fixed origin.
template <bool WithRotation, class S, class C, class X, class J>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S>
spatial_columns(const C& chain, const X& theta, int link, J& m) {
  m.resize(6, chain.size());
  const auto at_link = walk<WithRotation, S>(chain, theta, link,
                                             [&](Eigen::Index i, const auto& step, const auto& axis,
                                                 const auto& point) DUET_INLINE_LAMBDA {
                                               auto screw = no_twist<S>();
                                               if (step.turns()) {
                                                 screw = {cross(point, axis), axis};
                                               }
                                               if (step.slides()) {
                                                 screw.v = screw.v + step.pitch() * axis;
                                               }
                                               set_column(m, screw, i);
                                             });
  for (Eigen::Index i = link; i < chain.size(); ++i) { // these joints move other links only
    set_column(m, no_twist<S>(), i);
  }
  return at_link;
}

/// Spatial columns [v; ω] with v taken at a point in space instead: v + ω × p (N20).
template <class S, class J>
DUET_ALWAYS_INLINE void move_to_point(J& m, const three_vector<S>& p) {
  for (Eigen::Index i = 0; i < m.cols(); ++i) {
    const auto twist = column_of(m, i);
    set_column(m, twist_column<S>{twist.v + cross(twist.omega, p), twist.omega}, i);
  }
}

/// Columns in fixed axes turned into those of a body: Rᵀv, Rᵀω.
template <class S, class J>
DUET_ALWAYS_INLINE void turn_to_body(J& m, const quaternion<S>& rotation) {
  const rotation_of_many turn(conj(rotation));
  for (Eigen::Index i = 0; i < m.cols(); ++i) {
    const auto twist = column_of(m, i);
    set_column(m, twist_column<S>{turn(twist.v), turn(twist.omega)}, i);
  }
}

} // namespace detail

/// The pose A of a frame on a chain, and its Jacobian there.
///
/// \tparam Frame           see `jacobian`
/// \param at               the number of a link, or an `attached_frame`; nothing for the tip
template <SerialChain C, VectorLike X, FrameConstant Frame, PlaceOnChain<C> At = tip_of_chain>
[[nodiscard]] DUET_ALWAYS_INLINE auto pose_and_jacobian(const C& chain, const X& theta, Frame,
                                                        const At& at = {}) {
  using S = detail::chain_scalar<C, X>;
  const auto& on = detail::frame_on(chain, at);
  value_and_jacobian<dual_quaternion<S>, detail::chain_jacobian<C, X>> result;
  const auto link = detail::spatial_columns<true, S>(chain, theta, on.link, result.jacobian);
  const auto at_frame = detail::attached(link, on.offset);
  if constexpr (!std::same_as<Frame, spatial_frame>) {
    detail::move_to_point(result.jacobian, at_frame.translation);
  }
  if constexpr (std::same_as<Frame, body_frame>) {
    detail::turn_to_body(result.jacobian, at_frame.rotation);
  }
  result.value = detail::pose_of_unit(at_frame.rotation, at_frame.translation.eigen());
  return result;
}

/// The matrix J of 6 rows with the twist [v; ω] = J θ̇ of a frame on a chain (N18, N20).
///
/// \tparam Frame           `frame::spatial`: fixed axes, v of the body point at the fixed origin,
///                         columns are the joints' screws; `frame::body`: axes and origin of the
///                         moving frame; `frame::hybrid`: fixed axes, v of the frame's origin
/// \param at               the number of a link, or an `attached_frame`, as
///                         `chain.tip().at_point({x, y, z})`; nothing for the tip
/// Columns of joints beyond the link are zero. Units: those of θ in the denominator.
/// \throws invalid_input for another number of coordinates than `size()`, and for a link that there
/// is none of
template <class C, VectorLike X, FrameConstant Frame,
          PlaceOnChain<std::remove_cvref_t<C>> At = tip_of_chain>
  requires SerialChain<std::remove_cvref_t<C>>
[[nodiscard]] DUET_ALWAYS_INLINE auto jacobian(C&& chain, const X& theta, Frame,
                                               const At& at = {}) {
  using chain_type = std::remove_cvref_t<C>;
  using S = detail::chain_scalar<chain_type, X>;
  if constexpr (std::same_as<Frame, spatial_frame>) {
    detail::chain_jacobian<chain_type, X> result;
    const auto& on = detail::frame_on(chain, at);
    static_cast<void>(detail::spatial_columns<false, S>(chain, theta, on.link, result));
    return result;
  } else {
    return pose_and_jacobian(chain, theta, Frame{}, at).jacobian;
  }
}

template <class C, VectorLike X>
  requires SerialChain<std::remove_cvref_t<C>>
void jacobian(C&&, const X&) {
  static_assert(!SerialChain<std::remove_cvref_t<C>>,
                "duet: a chain has three Jacobians, say which: jacobian(chain, theta, "
                "frame::hybrid)");
}

} // namespace duet
