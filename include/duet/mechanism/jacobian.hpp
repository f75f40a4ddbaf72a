// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/mechanism/serial_chain.hpp>

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

/// The screws of the joints up to a link, as columns [v; ω]: in space, v at the fixed origin, or at
/// `point` (N20: v + ω × p).
template <bool WithRotation, class S, class C, class X, class J>
[[nodiscard]] DUET_ALWAYS_INLINE numeric_state<S> spatial_columns(const C& chain, const X& theta,
                                                                  int link, J& m) {
  m.resize(6, chain.size());
  const auto state = walk<WithRotation, S>(
      chain, theta, link,
      [&](std::size_t column, const auto& step, const auto& z, const auto& p) DUET_INLINE_LAMBDA {
        const auto i = Eigen::Index(column);
        const S zero(0);
        if (step.turns()) {
          m(0, i) = p.y * z.z - p.z * z.y;
          m(1, i) = p.z * z.x - p.x * z.z;
          m(2, i) = p.x * z.y - p.y * z.x;
          m(3, i) = z.x;
          m(4, i) = z.y;
          m(5, i) = z.z;
        } else {
          m(0, i) = m(1, i) = m(2, i) = m(3, i) = m(4, i) = m(5, i) = zero;
        }
        if (step.slides()) {
          m(0, i) += z.x * step.pitch();
          m(1, i) += z.y * step.pitch();
          m(2, i) += z.z * step.pitch();
        }
      });
  for (Eigen::Index i = link; i < chain.size(); ++i) { // these joints move other links only
    m.col(i).setZero();
  }
  return state;
}

/// Spatial columns [v; ω] with v taken at a point in space instead: v + ω × p.
template <class S, class J>
DUET_ALWAYS_INLINE void move_to_point(J& m, const vector3<S>& p) {
  for (Eigen::Index i = 0; i < m.cols(); ++i) {
    m(0, i) += m(4, i) * p[2] - m(5, i) * p[1];
    m(1, i) += m(5, i) * p[0] - m(3, i) * p[2];
    m(2, i) += m(3, i) * p[1] - m(4, i) * p[0];
  }
}

/// Columns in fixed axes turned into those of a body: Rᵀv, Rᵀω.
template <class S, class J>
DUET_ALWAYS_INLINE void turn_to_body(J& m, const quaternion<S>& rotation) {
  const matrix3<S> r = rotation_matrix(rotation);
  for (Eigen::Index i = 0; i < m.cols(); ++i) {
    for (const Eigen::Index first : {Eigen::Index(0), Eigen::Index(3)}) {
      const S x = m(first, i), y = m(first + 1, i), z = m(first + 2, i);
      for (Eigen::Index k = 0; k < 3; ++k) {
        m(first + k, i) = r(0, k) * x + r(1, k) * y + r(2, k) * z;
      }
    }
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
  const auto state = detail::attach(link, on.offset);
  if constexpr (!std::same_as<Frame, spatial_frame>) {
    detail::move_to_point(result.jacobian, state.position);
  }
  if constexpr (std::same_as<Frame, body_frame>) {
    detail::turn_to_body(result.jacobian, state.rotation);
  }
  result.value = detail::pose_of_unit(state.rotation, state.position);
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
