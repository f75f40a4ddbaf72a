// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/select.hpp>
#include <duet/derivative/linear_solve.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/kinematics/jacobian.hpp>

#include <Eigen/Core>

/// \file
/// Resolved motion rate: joint velocities of least norm for a given velocity of the tip (N22), and
/// the step that follows from them (N23).

namespace duet {

/// Resolved rate matrix (N22): B = Jᵀ(J Jᵀ)⁻¹ J2 of a chain's tip, n × 7: Θ̇ = B γ̇ are the joint
/// velocities of least norm |Θ̇| that move the tip with the rate γ̇ of γ = [t; α]. J is the spatial
/// Jacobian. Relative errors are about cond(J) ε, cond the condition number, as long as cond(J)² ε
/// is small.
///
/// \throws invalid_input if J does not have full row rank, in any lane of batches, and as
/// `jacobian`
template <SerialChain C, VectorLike X>
[[nodiscard]] auto resolved_rate_matrix(const C& chain, const X& theta) {
  using S = detail::chain_scalar<C, X>;
  const auto [a, m] = pose_and_jacobian(chain, theta, frame::spatial);
  const Eigen::Matrix<S, 6, 7> rates = pose_rate_matrix(a);
  const matrix6<S> gram = m.lazyProduct(m.transpose());
  Eigen::Matrix<S, (C::joints > 0 ? C::joints : Eigen::Dynamic), 7, Eigen::ColMajor,
                detail::max_joints<C::joints>, 7>
      b = m.transpose().lazyProduct(solve(gram, rates));
  // J Jᵀ has the squared condition number of J. Solving once more for the residual of J B = J2
  // takes that back: the error is that of a QR decomposition of Jᵀ (corrected seminormal
  // equations).
  const Eigen::Matrix<S, 6, 7> rest = rates - m.lazyProduct(b);
  b += m.transpose().lazyProduct(solve(gram, rest));
  return b;
}

/// Resolved-rate step (N23): Θ(t+h) = Θ(t) + β B (γ(t+h) − γ(t)) towards a pose near that of the
/// tip, α(t+h) taken with the sign nearer to α(t).
///
/// \throws invalid_input as `resolved_rate_matrix`
template <SerialChain C, VectorLike X, class T>
[[nodiscard]] auto resolved_step(const C& chain, const X& theta, const dual_quaternion<T>& next,
                                 double beta) {
  using S = promote_t<detail::chain_scalar<C, X>, T>;
  using argument = detail::vector_argument<X>;
  const dual_quaternion<S> current(chain.pose(theta));
  const dual_quaternion<S> target(next);
  const auto aligned = select(
      innermost(dot(rotation(current), rotation(target))) < 0,
      [&] { return dual_quaternion<S>(-target); }, [&] { return target; });
  const vector7<S> difference = pose_coordinates(aligned) - pose_coordinates(current);
  const auto b = resolved_rate_matrix(chain, theta);
  detail::joint_vector<S, C::joints> result(chain.size());
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    S step(0);
    for (Eigen::Index k = 0; k < 7; ++k) {
      step += b(i, k) * difference[k];
    }
    result[i] = argument::get(theta, i) + beta * step;
  }
  return result;
}

} // namespace duet
