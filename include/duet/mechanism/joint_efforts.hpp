// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/twist.hpp>
#include <duet/mechanism/jacobian.hpp>

/// \file
/// What a wrench on a link asks of the joints.

namespace duet {

/// τ = Jᵀ F: the torques, or forces where joints slide, of a wrench F = [f; m] that the chain
/// exerts at a frame, with the same power: τ·θ̇ = F·V.
///
/// \param frame_of_wrench  `frame::spatial`: fixed axes, m about the fixed origin; `frame::body`:
/// axes
///                         and origin of the frame; `frame::hybrid`: fixed axes, m about its origin
/// Other arguments as `jacobian`.
template <SerialChain C, VectorLike X, class W, FrameConstant Frame,
          PlaceOnChain<C> At = tip_of_chain>
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
