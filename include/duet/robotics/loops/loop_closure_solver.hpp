// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/robotics/loops/rank_revealing_svd.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// \file
/// Loop closure by damped least squares. For those who extend duet.

namespace duet::detail {

/// The numbers from 0 to n − 1 except for these.
[[nodiscard]] inline std::vector<int> all_but(int n, const std::vector<int>& these) {
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

/// Constraint Jacobian ∂F/∂q, each column per unit of its coordinate.
template <class Mechanism>
[[nodiscard]] Eigen::MatrixXd unit_jacobian(const Mechanism& of, const Eigen::VectorXd& q) {
  return of.constraint_jacobian(q) * of.units().asDiagonal();
}
template <class Mechanism>
[[nodiscard]] rank_revealing_svd linearised(const Mechanism& of, const Eigen::VectorXd& q) {
  return rank_revealing_svd(unit_jacobian(of, q));
}

/// The columns of a matrix at these indices.
[[nodiscard]] inline Eigen::MatrixXd columns(const Eigen::MatrixXd& of,
                                             const std::vector<int>& these) {
  Eigen::MatrixXd result(of.rows(), Eigen::Index(these.size()));
  for (std::size_t i = 0; i < these.size(); ++i) {
    result.col(Eigen::Index(i)) = of.col(these[i]);
  }
  return result;
}
/// The entries of a vector at these indices.
[[nodiscard]] inline Eigen::VectorXd entries(const Eigen::VectorXd& of,
                                             const std::vector<int>& these) {
  Eigen::VectorXd result(Eigen::Index(these.size()));
  for (std::size_t i = 0; i < these.size(); ++i) {
    result[Eigen::Index(i)] = of[these[i]];
  }
  return result;
}

/// Replaces the entries of a vector at these indices.
inline void put(const Eigen::VectorXd& numbers, const std::vector<int>& these,
                Eigen::VectorXd& into) {
  for (std::size_t i = 0; i < these.size(); ++i) {
    into[these[i]] = numbers[Eigen::Index(i)];
  }
}

/// Damped least squares (Levenberg–Marquardt method) for F(q) = 0.
template <class Mechanism>
class loop_closure_solver {
public:
  /// \param free  numbers of the coordinates that may move
  loop_closure_solver(const Mechanism& of, const Eigen::VectorXd& guess,
                      const std::vector<int>& free, int max_steps = 200)
      : of_(of), free_(free), q_(guess), f_(of.residuals(guess)), norm_(f_.norm()) {
    for (int i = 0; i < max_steps && norm_ > 0 && step(); ++i) {
    }
  }

  [[nodiscard]] bool has_closed() const {
    return norm_ <= 1e-12 * std::max(1.0, q_.cwiseQuotient(of_.units()).norm());
  }
  [[nodiscard]] double residual() const { return norm_; }
  [[nodiscard]] const Eigen::VectorXd& coordinates() const { return q_; }

private:
  /// Makes a step that reduces the residual; false if no step reduces it.
  [[nodiscard]] bool step() {
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
      for (Eigen::Index k = 0; k < dx.size(); ++k) {
        next[free_[std::size_t(k)]] += dx[k] * of_.units()[free_[std::size_t(k)]];
      }
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

  static constexpr double max_norm = 1; ///< maximum norm of a step
  const Mechanism& of_;
  std::vector<int> free_;
  Eigen::VectorXd q_, f_;
  double norm_;
  double damping_ = 1e-2;
};

} // namespace duet::detail
