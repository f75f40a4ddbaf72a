// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// The iteration of Levenberg and Marquardt, for least-squares problems of any structure; weights
/// and covariances of their residuals.

namespace duet {

/// Termination reason of an iteration of least squares.
enum class least_squares_stop {
  small_step,     ///< steps are down to the round-off of the estimate
  small_decrease, ///< the cost is at a minimum to round-off
  no_decrease,    ///< no step reduces the cost, however short
  iteration_limit ///< the maximum number of iterations is used up
};

/// Name of a `least_squares_stop`.
[[nodiscard]] inline const char* to_text(least_squares_stop reason) {
  constexpr std::array names{"small_step", "small_decrease", "no_decrease", "iteration_limit"};
  return names[std::size_t(reason)];
}

namespace detail {

/// Options of `levenberg_marquardt`.
template <Real R>
struct descent_options {
  int max_iterations;
  R initial_damping;                                  ///< 0: a Gauss–Newton step first
  R rounding;                                         ///< relative round-off of the cost
  R min_decrease = std::numeric_limits<R>::epsilon(); ///< relative; smaller decreases end it
  R tolerance = R(1e-11);                             ///< size of steps that are tiny
  bool is_polished = true; ///< true to go on while tiny steps still shrink
};

/// Result of `levenberg_marquardt`.
template <Real R>
struct descent {
  int iterations;            ///< number of steps
  least_squares_stop reason; ///< termination reason
  R step;                    ///< size of the last step
};

/// Minimises a sum of squares by damped Gauss–Newton steps (Levenberg, Marquardt). The damping λ
/// follows the gain ratio, the decrease of the cost over that of the linearised problem.
///
/// \param problem  its functions: `linearise()` at the estimate, returns the cost; `solve(λ)`
///   computes a step, or returns false; of that step `step_size()`,
///   `predicted_decrease()` and `cost_after_step()`; `accept()` moves the estimate;
///   `solve_better()` is called before the damping is increased, true if it changed the linear
///   problem
template <Real R, class Problem>
[[nodiscard]] descent<R> levenberg_marquardt(Problem& problem, const descent_options<R>& options) {
  R damping = options.initial_damping, step(0), before(std::numeric_limits<R>::max()), rate(1);
  for (int iteration = 1; iteration <= options.max_iterations; ++iteration) {
    const R cost = problem.linearise();
    R next(0);
    for (;;) {
      const bool has_step = problem.solve(damping);
      step = has_step ? problem.step_size() : R(0);
      next = has_step ? problem.cost_after_step() : std::numeric_limits<R>::infinity();
      const bool is_tiny = has_step && step <= options.tolerance;
      if (next <= cost * (1 + options.rounding) || (is_tiny && damping == 0)) {
        break;
      }
      if (is_tiny) {
        return {iteration, least_squares_stop::small_decrease, step};
      }
      if (problem.solve_better()) {
        continue;
      }
      damping = damping > 0 ? R(damping * 3) : R(1e-6);
      if (!(damping < R(1e12))) {
        return {iteration, least_squares_stop::no_decrease, step};
      }
    }
    const R gain = (cost - next) / problem.predicted_decrease();
    problem.accept();
    damping *= gain > R(.75) ? R(.2) : R(1);
    if (!(damping > R(1e-14))) {
      damping = 0;
    }
    // An error e of the estimate adds e² to the cost, which therefore stops changing before the
    // steps vanish. Steps shrink, at a rate given by the last two, down to round-off.
    const bool is_tiny = step <= options.tolerance;
    const bool is_shrinking = options.is_polished && 2 * step <= before;
    const R last_rate = std::exchange(rate, damping > 0 ? R(1) : R(step / before));
    before = step;
    if ((is_tiny || cost - next <= options.min_decrease * next) &&
        (!is_shrinking || iteration == options.max_iterations ||
         step * std::max(rate, last_rate) <= std::numeric_limits<R>::epsilon())) {
      return {iteration,
              is_tiny ? least_squares_stop::small_step : least_squares_stop::small_decrease, step};
    }
  }
  return {options.max_iterations, least_squares_stop::iteration_limit, step};
}

/// \param function  name for messages
/// \param of        plural of what has the weights, for messages
/// \throws invalid_input unless there are no weights, or `count`, positive and finite
inline void require_weights(const char* function, const std::vector<double>& weights,
                            std::size_t count, const char* of) {
  require(weights.empty() || weights.size() == count, "duet: ", function, ": ", weights.size(),
          " weights for ", count, " ", of);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    require(weights[i] > 0 && weights[i] <= std::numeric_limits<double>::max(), "duet: ", function,
            ": weight ", i, " is ", weights[i], " (expected a finite positive number; omit ", of,
            " that should not count)");
  }
}

/// Whitening matrices L⁻¹ of covariances L Lᵀ, `size` × `size`, over the scalar of `Square`.
///
/// \throws invalid_input unless there are no covariances, one for all, or `count`, symmetric and
///   positive definite
template <class Square>
[[nodiscard]] std::vector<Square>
inverse_roots(const char* function, const std::vector<Eigen::MatrixXd>& covariances,
              std::size_t count, Eigen::Index size, const char* of) {
  require(covariances.size() <= 1 || covariances.size() == count, "duet: ", function, ": ",
          covariances.size(), " covariances for ", count, " ", of,
          " (expected one for each, or one for all)");
  std::vector<Square> result;
  for (std::size_t i = 0; i < covariances.size(); ++i) {
    const Eigen::MatrixXd& covariance = covariances[i];
    require(covariance.rows() == size && covariance.cols() == size, "duet: ", function,
            ": covariance ", i, " is ", covariance.rows(), " x ", covariance.cols(), ", not ", size,
            " x ", size);
    require(covariance.isApprox(covariance.transpose()), "duet: ", function, ": covariance ", i,
            " is not symmetric");
    const Eigen::LLT<Square> root(covariance.template cast<typename Square::Scalar>());
    require(covariance.allFinite() && root.info() == Eigen::Success, "duet: ", function,
            ": covariance ", i, " is not positive definite");
    result.push_back(root.matrixL().solve(Square::Identity(size, size)));
  }
  return result;
}

/// Ratio of the expectation of Σ gᵢgᵢᵀ, gᵢ the gradients of single losses, to its value at the
/// estimate, for the covariance H⁻¹(Σ gᵢgᵢᵀ)H⁻¹ of robust estimates. Let ψᵢ = wᵢ ρ′ be the
/// derivative of a loss, Wᵢ = wᵢ(ρ′/r across the residual, ρ″ along it) that of ψᵢ by the residual,
/// and h the number of unknowns over that of components. An error of the estimate takes from ψᵢ its
/// part of WᵢJᵢ(H⁻¹Jᵢᵀψᵢ), so that on average the sum is too small by the factor
///
/// 1 − h (2 Σ ψᵢᵀWᵢψᵢ/(τ Σ|ψᵢ|²) − υ/τ²), τ and υ the means of the eigenvalues of W and of W².
///
/// For plain least squares with equal weights this is 1 − h.
template <Real R>
class gradient_bias {
public:
  /// Adds a residual of size r and `dimension` components, its weight w, ρ′/r and ρ″.
  void add(const R& r, int dimension, const R& w, const R& across, const R& along) {
    const R psi = w * across * r, by_across = w * across, by_along = w * along;
    squares_ += psi * psi;
    inner_ += by_along * (psi * psi);
    trace_ += R(dimension - 1) * by_across + by_along;
    trace_of_square_ += R(dimension - 1) * (by_across * by_across) + by_along * by_along;
    components_ += R(dimension);
  }

  /// The ratio; NaN if the components are too few.
  [[nodiscard]] R factor(const R& unknowns) const {
    const R mean = trace_ / components_, h = unknowns / components_;
    const R left =
        1 - h * (2 * inner_ / (mean * squares_) - trace_of_square_ / (components_ * mean * mean));
    return left > 0 ? R(1 / left) : std::numeric_limits<R>::quiet_NaN();
  }

private:
  R squares_{0}, inner_{0}, trace_{0}, trace_of_square_{0}, components_{0};
};

} // namespace detail
} // namespace duet
