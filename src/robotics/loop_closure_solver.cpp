// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loops/loop_closure_solver.hpp"

#include <duet/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

std::vector<int> all_but(int n, const std::vector<int>& these) {
  std::vector<int> result;
  for (const int i : these) {
    require(0 <= i && i < n, "duet: closed_chain_mechanism: coordinate ", i,
            " does not exist, the mechanism has ", n);
  }
  for (int i = 0; i < n; ++i) {
    if (std::find(these.begin(), these.end(), i) == these.end()) {
      result.push_back(i);
    }
  }
  return result;
}

Eigen::MatrixXd unit_jacobian(const closed_chain_mechanism& of, const Eigen::VectorXd& q) {
  return of.constraint_jacobian(q) * of.units().asDiagonal();
}

rank_revealing_svd linearised(const closed_chain_mechanism& of, const Eigen::VectorXd& q) {
  return rank_revealing_svd(unit_jacobian(of, q));
}

Eigen::MatrixXd columns(const Eigen::MatrixXd& of, const std::vector<int>& these) {
  Eigen::MatrixXd result(of.rows(), Eigen::Index(these.size()));
  for (std::size_t i = 0; i < these.size(); ++i) {
    result.col(Eigen::Index(i)) = of.col(these[i]);
  }
  return result;
}

loop_closure_solver::loop_closure_solver(const closed_chain_mechanism& of,
                                         const Eigen::VectorXd& guess, const std::vector<int>& free,
                                         int max_steps)
    : of_(of), free_(free), q_(guess), f_(of.residuals(guess)), norm_(f_.norm()) {
  for (int i = 0; i < max_steps && norm_ > 0 && step(); ++i) {
  }
}

bool loop_closure_solver::has_closed() const {
  return norm_ <= 1e-12 * std::max(1.0, q_.cwiseQuotient(of_.units()).norm());
}

bool loop_closure_solver::step() {
  const Eigen::MatrixXd j = columns(unit_jacobian(of_, q_), free_);
  const rank_revealing_svd svd(j);
  for (int i = 0; i < 25; ++i) {
    Eigen::VectorXd dx = -svd.damped_solve(f_, damping_ * norm_);
    const double length = dx.norm();
    if (!(length > 1e-16)) {
      return false;
    }
    dx *= std::min(1.0, max_norm / length);
    Eigen::VectorXd next = q_;
    next(free_) += dx.cwiseProduct(of_.units()(free_));
    const Eigen::VectorXd f = of_.residuals(next);
    const double norm = f.norm();
    if (norm < norm_) {
      const double foreseen = norm_ * norm_ - (f_ + j * dx).squaredNorm();
      const double gain = (norm_ * norm_ - norm * norm) / foreseen;
      damping_ = std::max(1e-8, damping_ * (gain > .75 ? .1 : gain < .25 ? 4 : 1));
      const bool goes_on = norm < (1 - 1e-5) * norm_;
      q_ = next;
      f_ = f;
      norm_ = norm;
      return goes_on;
    }
    if (norm_ < 1e-14) {
      return false; // round-off
    }
    damping_ *= 10;
  }
  return false;
}
DUET_ABI_END
} // namespace duet::detail
