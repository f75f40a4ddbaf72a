// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/twist.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// The least step of the joints for a small twist of the tip that keeps the joints within limits.

namespace duet::detail {

/// Below this singular value steps are damped.
inline constexpr double damping_threshold = 1e-3;

/// Solves J Jᵀ y = e with as much damping as a small singular value asks for. A template so that
/// compilers make its factorisation for those alone who use it.
template <class Gram>
class damped_gram {
public:
  explicit damped_gram(const Gram& gram) : factors_(gram) {
    // The smallest eigenvalue from above: Rayleigh's quotient after two inverse iterations.
    if (factors_.info() == Eigen::Success) {
      const vector6<double> once = factors_.solve(vector6<double>::Ones());
      const vector6<double> twice = factors_.solve(once);
      smallest_ = once.dot(twice) / twice.squaredNorm();
    }
    smallest_ = smallest_ > 0 ? std::sqrt(smallest_) : 0;
    if (smallest_ < damping_threshold) {
      const double missing = 1 - smallest_ / damping_threshold;
      const double damping = missing * damping_threshold;
      factors_.compute(gram + damping * damping * Gram::Identity());
    }
  }

  [[nodiscard]] vector6<double> solve(const vector6<double>& e) const { return factors_.solve(e); }
  /// The smallest singular value of J, from above.
  [[nodiscard]] double smallest() const { return smallest_; }

private:
  Eigen::LLT<Gram> factors_;
  double smallest_ = 0;
};

template <class V>
struct bounded_step_result {
  V step;
  double smallest_singular_value; ///< of all joints, 0 where it was not asked for
  bool is_bounded;                ///< did a limit hold a joint back?
};

/// The least Δ with J Δ = e and lower ≤ Δ ≤ upper. Joints that would go beyond a bound are put onto
/// it, the worst one first, and the others make up for them as far as they can.
/// \param factors  of J Jᵀ: what solves J Jᵀ y = e
template <class J, class V, class Factors>
[[nodiscard]] bounded_step_result<V> bounded_step(const J& jacobian, const vector6<double>& e,
                                                  const V& lower, const V& upper,
                                                  const Factors& factors) {
  const Eigen::Index n = jacobian.cols();
  J free = jacobian;
  V fixed = V::Zero(n);
  std::array<bool, std::size_t(J::MaxColsAtCompileTime)> is_fixed{};
  bounded_step_result<V> result{V::Zero(n), 0, false};
  for (Eigen::Index round = 0; round <= n; ++round) {
    const auto gram = factors(matrix6<double>(free * free.transpose()));
    if constexpr (requires { gram.smallest(); }) {
      if (round == 0) {
        result.smallest_singular_value = gram.smallest();
      }
    }
    const vector6<double> rest = e - jacobian * fixed;
    result.step = fixed + free.transpose() * gram.solve(rest);
    Eigen::Index worst = -1;
    double excess = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double beyond = std::max(result.step[i] - upper[i], lower[i] - result.step[i]);
      if (!is_fixed[std::size_t(i)] && beyond > excess) {
        excess = beyond;
        worst = i;
      }
    }
    if (worst < 0) {
      break;
    }
    is_fixed[std::size_t(worst)] = true;
    result.is_bounded = true;
    fixed[worst] = std::clamp(result.step[worst], lower[worst], upper[worst]);
    free.col(worst).setZero();
  }
  return result;
}
template <class J, class V>
[[nodiscard]] bounded_step_result<V> bounded_step(const J& jacobian, const vector6<double>& e,
                                                  const V& lower, const V& upper) {
  return bounded_step(jacobian, e, lower, upper,
                      [](const auto& gram) { return damped_gram(gram); });
}

} // namespace duet::detail
