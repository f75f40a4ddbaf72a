// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "small_vector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Least-norm joint step for a small twist of the tip within joint limits (damped least squares).

namespace duet::detail {
DUET_ABI_BEGIN

/// Singular value below which steps are damped.
inline constexpr double damping_threshold = 1e-3;
/// Singular value below which steps fail, except those that reorient joints rapidly at a
/// singularity.
inline constexpr double undamped_threshold = 1e-6;
/// Singular value below which round-off of J Jᵀ would determine the steps.
inline constexpr double undamped_threshold_near_singularity = 1e-7;

/// Twist [v; ω].
using small_twist = small_vector<6>;
using gram_matrix = small_matrix<6, 6>;

/// Adds x xᵀ to the lower half of m for the column x of a matrix of 6 rows.
template <class J>
void add_square(gram_matrix& m, const J& jacobian, std::ptrdiff_t column) {
  for (std::ptrdiff_t j = 0; j < 6; ++j) {
    for (std::ptrdiff_t i = j; i < 6; ++i) {
      m(i, j) += jacobian(i, column) * jacobian(j, column);
    }
  }
}

/// Lower half of J Jᵀ.
template <class J>
[[nodiscard]] gram_matrix gram_of(const J& jacobian) {
  gram_matrix result;
  for (std::ptrdiff_t i = 0; i < jacobian.cols(); ++i) {
    add_square(result, jacobian, i);
  }
  return result;
}

/// Product of a column of J with a force.
template <class J, class V>
[[nodiscard]] double column_dot(const J& jacobian, std::ptrdiff_t column, const V& force) {
  double sum = 0;
  for (std::ptrdiff_t i = 0; i < 6; ++i) {
    sum += jacobian(i, column) * force[i];
  }
  return sum;
}

/// Residual e − Σ x_i column_i after a step x, over all columns of J.
template <class J, class V>
[[nodiscard]] small_twist residual_after_step(small_twist e, const J& jacobian, const V& x) {
  for (std::ptrdiff_t j = 0; j < jacobian.cols(); ++j) {
    for (std::ptrdiff_t i = 0; i < 6; ++i) {
      e[i] -= x[j] * jacobian(i, j);
    }
  }
  return e;
}

/// Damping of J Jᵀ: by λ, and if the smallest singular value σ is below a threshold by (threshold −
/// σ)².
struct damping {
  double threshold = damping_threshold;
  double lambda = 0;
};

/// J Jᵀ with the damping that a small singular value of J requires (damped least squares).
class damped_gram {
public:
  explicit damped_gram(const gram_matrix& gram, const damping& settings = {})
      : factors_(settings.lambda > 0 ? damped(gram, settings.lambda)
                                     : cholesky<gram_matrix>(gram)) {
    if (settings.threshold == 0) {
      return;
    }
    // Smallest eigenvalue, from above: Rayleigh quotient after two inverse iterations.
    if (factors_.is_positive()) {
      const auto once = factors_.solve(small_twist{{1, 1, 1, 1, 1, 1}});
      const auto twice = factors_.solve(once);
      smallest_ = std::sqrt(std::max(0.0, dot(once, twice) / dot(twice, twice)));
    }
    if (smallest_ < settings.threshold) {
      const double shift = settings.threshold - smallest_;
      factors_ = damped(gram, shift * shift);
    }
  }

  template <class V>
  [[nodiscard]] V solve(const V& e) const {
    return factors_.solve(e);
  }
  /// Smallest singular value of J, from above; 0 if it was not computed.
  [[nodiscard]] double smallest() const { return smallest_; }

private:
  [[nodiscard]] static cholesky<gram_matrix> damped(gram_matrix gram, double lambda) {
    for (std::ptrdiff_t i = 0; i < 6; ++i) {
      gram(i, i) += lambda;
    }
    return cholesky<gram_matrix>(gram);
  }

  cholesky<gram_matrix> factors_;
  double smallest_ = 0;
};

template <class V>
struct bounded_step_result {
  V step;
  double smallest_singular_value; ///< that of the Jacobian of all joints, 0 without a threshold
  bool is_bounded;                ///< true if a limit was active
};

/// Least-norm Δ with J Δ = e and lower ≤ Δ ≤ upper, by damped least squares Jᵀ(J Jᵀ + λ)⁻¹ e.
/// Joints that would go beyond a bound are fixed at it, the worst one first, and the others
/// compensate for them as far as they can.
template <int N>
[[nodiscard]] bounded_step_result<small_vector<N>>
bounded_step(const small_matrix<6, N>& jacobian, const small_twist& e, const small_vector<N>& lower,
             const small_vector<N>& upper, const damping& settings = {}) {
  const std::ptrdiff_t n = jacobian.cols();
  std::array<bool, std::size_t(N)> is_fixed{};
  bounded_step_result<small_vector<N>> result{{}, 0, false};
  for (std::ptrdiff_t round = 0; round <= n; ++round) {
    gram_matrix gram;
    small_twist rest = e;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      if (is_fixed[std::size_t(i)]) {
        rest = rest - result.step[i] * jacobian.columns[std::size_t(i)];
      } else {
        add_square(gram, jacobian, i);
      }
    }
    const damped_gram factors(gram, settings);
    if (round == 0) {
      result.smallest_singular_value = factors.smallest();
    }
    const small_twist force = factors.solve(rest);
    std::ptrdiff_t worst = -1;
    double max_violation = 0;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      if (!is_fixed[std::size_t(i)]) {
        double& step = result.step[i];
        step = column_dot(jacobian, i, force);
        const double violation = std::max(step - upper[i], lower[i] - step);
        if (violation > max_violation) {
          max_violation = violation;
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

DUET_ABI_END
} // namespace duet::detail
