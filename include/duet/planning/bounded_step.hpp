// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/twist.hpp>
#include <duet/planning/cholesky.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

/// \file
/// The least step of the joints for a small twist of the tip that keeps the joints within limits.

namespace duet::detail {

/// Below this singular value steps are damped.
inline constexpr double damping_threshold = 1e-3;

/// m + x xᵀ, in place.
template <class M>
void add_square(M& m, const vector6<double>& x) {
  for (Eigen::Index j = 0; j < 6; ++j) {
    for (Eigen::Index i = j; i < 6; ++i) {
      m(i, j) += x[i] * x[j];
    }
  }
}

/// J Jᵀ of a matrix J of 6 rows.
template <class J>
[[nodiscard]] auto gram_matrix(const J& jacobian) {
  matrix6<double> result = matrix6<double>::Zero();
  for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
    add_square(result, jacobian.col(i));
  }
  return result;
}

/// J Jᵀ with as much damping as a small singular value of J asks for.
template <class Gram>
class damped_gram {
public:
  explicit damped_gram(const Gram& gram) : factors_(gram) {
    // The smallest eigenvalue from above: Rayleigh's quotient after two inverse iterations.
    if (factors_.is_positive()) {
      const vector6<double> once = factors_.solve(vector6<double>(vector6<double>::Ones()));
      const vector6<double> twice = factors_.solve(once);
      smallest_ = std::sqrt(std::max(0.0, once.dot(twice) / twice.squaredNorm()));
    }
    if (smallest_ < damping_threshold) {
      const double missing = 1 - smallest_ / damping_threshold;
      const double damping = missing * damping_threshold;
      factors_ = damped(gram, damping * damping);
    }
  }
  /// J Jᵀ + λ.
  damped_gram(const Gram& gram, double lambda) : factors_(damped(gram, lambda)) {}

  [[nodiscard]] vector6<double> solve(const vector6<double>& e) const { return factors_.solve(e); }
  /// The smallest singular value of J, from above; 0 where it was not asked for.
  [[nodiscard]] double smallest() const { return smallest_; }

private:
  [[nodiscard]] static cholesky<Gram> damped(Gram gram, double lambda) {
    for (Eigen::Index i = 0; i < 6; ++i) {
      gram(i, i) += lambda;
    }
    return cholesky<Gram>(gram);
  }

  cholesky<Gram> factors_;
  double smallest_ = 0;
};

template <class V>
struct bounded_step_result {
  V step;
  double smallest_singular_value; ///< of all joints, 0 where λ was given
  bool is_bounded;                ///< did a limit hold a joint back?
};

/// The least Δ with J Δ = e and lower ≤ Δ ≤ upper. Joints that would go beyond a bound are put onto
/// it, the worst one first, and the others make up for them as far as they can.
/// \param lambda  the damping, Δ = Jᵀ(J Jᵀ + λ)⁻¹ e; without, as much as near singularities
template <class J, class V>
[[nodiscard]] bounded_step_result<V> bounded_step(const J& jacobian, const vector6<double>& e,
                                                  const V& lower, const V& upper,
                                                  const std::optional<double>& lambda = {}) {
  const Eigen::Index n = jacobian.cols();
  std::array<bool, std::size_t(J::MaxColsAtCompileTime)> is_fixed{};
  bounded_step_result<V> result{V::Zero(n), 0, false};
  for (Eigen::Index round = 0; round <= n; ++round) {
    matrix6<double> gram = matrix6<double>::Zero();
    vector6<double> rest = e;
    for (Eigen::Index i = 0; i < n; ++i) {
      const vector6<double> column = jacobian.col(i);
      if (is_fixed[std::size_t(i)]) {
        rest -= result.step[i] * column;
      } else {
        add_square(gram, column);
      }
    }
    const auto factors = lambda ? damped_gram(gram, *lambda) : damped_gram(gram);
    if (round == 0) {
      result.smallest_singular_value = factors.smallest();
    }
    const vector6<double> force = factors.solve(rest);
    Eigen::Index worst = -1;
    double excess = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!is_fixed[std::size_t(i)]) {
        double& step = result.step[i];
        step = jacobian.col(i).dot(force);
        const double beyond = std::max(step - upper[i], lower[i] - step);
        if (beyond > excess) {
          excess = beyond;
          worst = i;
        }
      }
    }
    if (worst < 0) {
      break;
    }
    is_fixed[std::size_t(worst)] = true;
    result.is_bounded = true;
    result.step[worst] = std::clamp(result.step[worst], lower[worst], upper[worst]);
  }
  return result;
}

} // namespace duet::detail
