// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/implicit_function.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Core>

#include <array>
#include <type_traits>

/// \file
/// Branches of inverse kinematics with derivatives.

namespace duet {

/// Six joint coordinates of a branch of inverse kinematics as a function of the goal, and of the
/// arm's geometry, by the implicit function theorem: those near `joints` with A(θ) = `goal`, over
/// all their scalars.
///
/// Example: `jacobian([&](const auto& goal) { return differentiable_branch(arm, theta, goal); },
/// goal)` with `theta` from `all_inverse_kinematics`.
///
/// \param forward  forward kinematics: the chain; or a callable that returns the pose A of the tip
/// for an Eigen vector of six coordinates of any scalar, with the derivatives with respect to
/// geometry in what it captures
/// \param joints   joint coordinates of a branch, in double
/// \param goal     a pose, of any scalar of duet
/// \return an Eigen vector of six coordinates
/// \throws no_convergence if branches meet at `joints`: the Jacobian is singular there
/// \throws invalid_input for a number of coordinates other than six
template <class Forward, VectorLike X, class S>
[[nodiscard]] auto differentiable_branch(const Forward& forward, const X& joints,
                                         const dual_quaternion<S>& goal) {
  using argument = detail::vector_argument<X>;
  detail::require(argument::size(joints) == 6,
                  "duet: differentiable_branch: ", argument::size(joints),
                  " coordinates (expected 6)");
  Eigen::Matrix<double, 6, 1> start;
  for (int i = 0; i < 6; ++i) {
    start[i] = argument::get(joints, i);
  }
  // The goal as eight numbers: derivatives are not taken with respect to the dual unit of rigid
  // motions.
  const auto p = real_part(goal), q = dual_part(goal);
  const std::array<S, 8> numbers{p.w(), p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
  // Components of the tip's pose in the frame of the goal that are zero if the two poses agree
  // (±1).
  const auto residual = [&](const auto& theta, const auto& to) {
    using T = std::decay_t<decltype(to[0])>;
    const auto opposite = conj(make_dual_quaternion(quaternion<T>(to[0], to[1], to[2], to[3]),
                                                    quaternion<T>(to[4], to[5], to[6], to[7])));
    const auto difference = opposite * [&] {
      if constexpr (SerialChain<Forward>) {
        return forward.pose(theta);
      } else {
        return forward(theta);
      }
    }();
    const auto r = real_part(difference), d = dual_part(difference);
    return std::array{d.x(), d.y(), d.z(), r.x(), r.y(), r.z()};
  };
  return implicit_solution(residual, start, numbers);
}

} // namespace duet
