// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/random_source.hpp>
#include <duet/dual/taylor.hpp>
#include <duet/robotics/closed_tree.hpp>

#include <Eigen/Core>

#include <optional>
#include <vector>

/// \file
/// Second derivatives of the equations of loops. For those who extend duet.

namespace duet::detail {
DUET_ABI_BEGIN

/// Scalar for second derivatives of the equations.
using along_line = taylor<double, 2, derivative_tag<closed_chain_mechanism>>;

/// The quadratic forms wᵀ ∂²F(K v, K v) in v, a symmetric matrix for each column w, from F along
/// the lines of single columns of K and of sums of two: 2 b(u, v) = b(u + v, u + v) − b(u, u) −
/// b(v, v).
///
/// \param columns  K, each row per unit of its coordinate
[[nodiscard]] std::vector<Eigen::MatrixXd> quadratic_forms(const closed_chain_mechanism& of,
                                                           const Eigen::VectorXd& q,
                                                           const Eigen::MatrixXd& w,
                                                           const Eigen::MatrixXd& columns);

/// A uniformly distributed unit vector.
[[nodiscard]] Eigen::VectorXd random_direction(random_source& random, Eigen::Index n);

/// A unit vector v for which all forms vanish, by Newton's method from an initial guess; empty if
/// it does not converge.
[[nodiscard]] std::optional<Eigen::VectorXd> common_zero(const std::vector<Eigen::MatrixXd>& forms,
                                                         Eigen::VectorXd v, double rounding);

DUET_ABI_END
} // namespace duet::detail
