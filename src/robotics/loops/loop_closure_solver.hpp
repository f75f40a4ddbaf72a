// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "rank_revealing_svd.hpp"

#include <duet/robotics/closed_tree.hpp>

#include <Eigen/Core>

#include <vector>

/// \file
/// Loop closure by damped least squares. For those who extend duet.

namespace duet::detail {
DUET_ABI_BEGIN

/// The numbers from 0 to n − 1 except for these.
[[nodiscard]] std::vector<int> all_but(int n, const std::vector<int>& these);

/// Constraint Jacobian ∂F/∂q, each column per unit of its coordinate.
[[nodiscard]] Eigen::MatrixXd unit_jacobian(const closed_chain_mechanism& of,
                                            const Eigen::VectorXd& q);
[[nodiscard]] rank_revealing_svd linearised(const closed_chain_mechanism& of,
                                            const Eigen::VectorXd& q);

/// The columns of a matrix at these indices.
[[nodiscard]] Eigen::MatrixXd columns(const Eigen::MatrixXd& of, const std::vector<int>& these);

/// Damped least squares (Levenberg–Marquardt method) for F(q) = 0.
class loop_closure_solver {
public:
  /// \param free  numbers of the coordinates that may move
  loop_closure_solver(const closed_chain_mechanism& of, const Eigen::VectorXd& guess,
                      const std::vector<int>& free, int max_steps = 200);

  [[nodiscard]] bool has_closed() const;
  [[nodiscard]] double residual() const { return norm_; }
  [[nodiscard]] const Eigen::VectorXd& coordinates() const { return q_; }

private:
  /// Makes a step that reduces the residual; false if no step reduces it.
  [[nodiscard]] bool step();

  static constexpr double max_norm = 1; ///< maximum norm of a step
  const closed_chain_mechanism& of_;
  std::vector<int> free_;
  Eigen::VectorXd q_, f_;
  double norm_;
  double damping_ = 1e-2;
};

DUET_ABI_END
} // namespace duet::detail
