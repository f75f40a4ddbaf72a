// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/twist.hpp>
#include <duet/kinematics/jacobian.hpp>

/// \file
/// Joint torques and forces that correspond to a wrench on a link.

namespace duet {

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
