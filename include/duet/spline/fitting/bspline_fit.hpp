// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/blocks/cholesky.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/fit_options.hpp>
#include <duet/spline/fitting/bspline_residuals.hpp>
#include <duet/spline/fitting/fit_start.hpp>
#include <duet/spline/fitting/gradient_changes.hpp>
#include <duet/spline/orientations.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Least-squares problem of `fit`, solved by the Levenberg–Marquardt method.

namespace duet::detail {

/// Least-squares problem of `fit`: minimises Σ wᵢ ρ(rᵢ) over the control points, which are
/// perturbed in their tangent spaces (body axes). The normal equations are banded, as a sample
/// depends on `Order` neighbouring control points.
template <class T, int Order>
class bspline_fit : bspline_residuals<T, Order> {
  using residual_type = bspline_residuals<T, Order>;
  using residual_type::dimension;
  using residual_type::first;
  using residual_type::residual_at;
  using residual_type::samples;
  using residual_type::size_of;
  using residual_type::unknowns;
  using typename residual_type::basis_type;
  using typename residual_type::element;
  using typename residual_type::R;
  using typename residual_type::tangent;
  using vector = Eigen::Matrix<R, Eigen::Dynamic, 1>;

public:
  bspline_fit(const basis_type& basis, const std::vector<R>& u, std::vector<element> data,
              const fit_options& options)
      : bspline_fit(basis, u, central_sample(data, R(options.characteristic_length)), data,
                    options) {}

private:
  /// Constructs the problem with samples relative to one of them, which preserves digits of small
  /// rotations and translations between samples.
  bspline_fit(const basis_type& basis, const std::vector<R>& u, const element& origin,
              std::vector<element> data, const fit_options& options)
      : residual_type(basis, u, samples_relative_to(origin, std::move(data)), options),
        options_(options), basis_(&basis), u_(&u), origin_(origin),
        limits_(u.size(), R(options.outlier_threshold)) {
    if (is_robust()) {
      controls_ =
          robust_centre<T>().controls(basis, u, this->samples(), R(options.characteristic_length));
      approach();
    } else {
      controls_ = control_points_at_averages(basis, u, this->samples());
      const std::vector<R> sizes = residuals();
      if (!(*std::max_element(sizes.begin(), sizes.end()) < too_far<R>())) {
        const auto [index, size] = farthest_from_neighbours();
        raise(invalid_sample(
            index, message("is ", size, " from the samples around it, too far for least ",
                           "squares (fit_options::outlier_threshold makes the fit robust)")));
      }
    }
  }

public:
  /// True if sample i counts; outliers that are too far off do not.
  [[nodiscard]] bool counts(std::size_t i) const { return limits_[i] > 0; }
  [[nodiscard]] R outlier_threshold() const { return R(options_.outlier_threshold); }

  [[nodiscard]] cumulative_bspline<T, Order> curve(const basis_type& basis) const {
    std::vector<element> controls;
    for (const element& control : controls_) {
      controls.push_back(origin_ * control);
    }
    std::vector<vector3<T>> increments{vector3<T>::Zero()};
    for (std::size_t i = 1; i < controls_.size(); ++i) {
      increments.push_back(this->increment(controls_, i));
    }
    return {basis, std::move(controls), std::move(increments)};
  }

  [[nodiscard]] std::vector<R> residuals() const { return residual_type::residuals(controls_); }

  /// Minimises the cost over the control points; returns the number of steps.
  ///
  /// \throws no_convergence if the iteration does not converge
  int solve() { return iterations_ + descend(options_.max_iterations, true); }

private:
  static constexpr R tolerance = R(1e-11); // rad
  static constexpr R max_rotation = R(0.5);
  static constexpr R min_outlier_threshold =
      R(1e-9); ///< samples that fit to round-off have no outliers

  [[nodiscard]] bool is_robust() const {
    return options_.outlier_threshold < std::numeric_limits<double>::infinity();
  }

  /// Damped least squares (Levenberg–Marquardt); returns the number of steps.
  ///
  /// \throws no_convergence if `must_converge` and the iteration does not
  int descend(int max_steps, bool must_converge) {
    const R gain = must_converge ? std::numeric_limits<R>::epsilon() : R(0.1);
    using std::sqrt;
    const R rounding = 8 * std::numeric_limits<R>::epsilon() * sqrt(R(samples().size()));
    R damping(0), step(0), before(std::numeric_limits<R>::max()), rate(1);
    for (int iteration = 1; iteration <= max_steps; ++iteration) {
      bool is_bold = must_converge && is_robust();
      const R cost = assemble(is_bold);
      if (iteration > 10) { // Gauss–Newton steps alone are mostly enough, and faster at the end
        changes_.arrive(-gradient_);
      }
      R next(0);
      for (;;) {
        std::vector<element> moved = moved_control_points(damping, step);
        next = moved.empty() ? std::numeric_limits<R>::infinity() : this->cost_of(moved, limits_);
        const bool is_tiny = !moved.empty() && step <= tolerance;
        if (next <= cost * (1 + rounding) || (is_tiny && damping == 0)) {
          controls_ = std::move(moved);
          changes_.step(last_step_, -gradient_);
          damping = damping > R(1e-9) ? R(damping / 10) : R(0);
          break;
        }
        if (is_tiny) { // the cost is at its minimum to round-off
          return iteration;
        }
        if (!changes_.empty()) {
          changes_.clear();
          continue;
        }
        if (is_bold) {
          is_bold = false;
          static_cast<void>(assemble(false));
          continue;
        }
        damping = damping > 0 ? R(damping * 10) : R(1e-6);
        if (!(damping < R(1e12))) {
          if (!must_converge) {
            return iteration;
          }
          fail("finds no step that reduces the cost", iteration, step);
        }
      }
      // An error e in the control points adds e² to the cost, which therefore stops changing before
      // the steps vanish. Steps shrink, at a rate given by the last two, down to round-off.
      const bool is_low = step <= tolerance || cost - next <= gain * next;
      const bool is_shrinking = 2 * step <= before;
      const R last_rate = std::exchange(rate, damping > 0 ? R(1) : R(step / before));
      before = step;
      if (is_low && (!must_converge || !is_shrinking || iteration == max_steps ||
                     step * std::max(rate, last_rate) <= std::numeric_limits<R>::epsilon())) {
        return iteration;
      }
    }
    if (must_converge) {
      fail("does not converge", max_steps, step);
    }
    return max_steps;
  }

  /// Approaches the samples robustly: the outlier limits follow from medians of the distances of
  /// the surrounding samples from the curve so far.
  void approach() {
    constexpr int rounds = 12;
    R scale = std::numeric_limits<R>::infinity(); // sum of the limits
    for (int round = 0; round < rounds; ++round) {
      const R last = scale;
      scale = set_limits();
      if (!(scale < R(0.9) * last)) {
        break;
      }
      iterations_ += descend(round == 0 ? 1 : 4, false);
    }
    if (!(options_.outlier_threshold > 0)) {
      options_.outlier_threshold =
          double(std::max(R(3 * median_of(residuals())), min_outlier_threshold));
    }
    static_cast<void>(set_limits());
    for (R& limit : limits_) {
      limit = std::min(limit, R(options_.outlier_threshold));
    }
  }

  R set_limits() {
    const R min_limit = std::max(R(options_.outlier_threshold), min_outlier_threshold);
    return set_outlier_limits(residuals(), first(), min_limit, limits_);
  }

  /// Assembles JᵀWJ and −JᵀW r at the control points, W the weights of Huber's loss; returns the
  /// cost there.
  ///
  /// \param is_bold  true to omit most of the curvature along residuals beyond the limit, which the
  ///                 loss does not have: steps are then correct near the solution, but possibly too
  ///                 long far from it; with the curvature they are too short
  [[nodiscard]] R assemble(bool is_bold) {
    R cost(0);
    gradient_.setZero(Eigen::Index(controls_.size()) * dimension);
    normal_.set_zero(controls_.size());
    typename residual_type::last_span last;
    Eigen::Matrix<R, unknowns, unknowns> squares = Eigen::Matrix<R, unknowns, unknowns>::Zero();
    const auto flush = [&](std::size_t span) { // called once for all samples on a span
      for (std::size_t a = 0; a < std::size_t(Order); ++a) {
        for (std::size_t b = 0; b <= a; ++b) {
          normal_.at(span + a, span + b) += squares.template block<dimension, dimension>(
              Eigen::Index(a) * dimension, Eigen::Index(b) * dimension);
        }
      }
      squares.setZero();
    };
    for (std::size_t i = 0; i < samples().size(); ++i) {
      if (!counts(i)) {
        continue;
      }
      if (first()[i] != last.first && last.first != std::size_t(-1)) {
        flush(last.first);
      }
      const auto [value, gradient] = this->linearised(i, controls_, last);
      const R length = size_of(value), sample_weight = this->weight_of(i);
      cost += sample_weight * huber_loss(length, limits_[i]);
      const R weight =
          length <= limits_[i] ? sample_weight : R(sample_weight * (limits_[i] / length));
      gradient_.template segment<unknowns>(Eigen::Index(last.first) * dimension) -=
          weight * (gradient * value);
      const Eigen::Matrix<R, unknowns, dimension> weighted = weight * gradient;
      for (int a = 0; a < unknowns; ++a) { // by columns, which Eigen handles fast
        squares.col(a).noalias() += gradient.lazyProduct(weighted.row(a).transpose());
      }
      if (weight < sample_weight && is_bold) {
        const Eigen::Matrix<R, unknowns, 1> along = gradient * (value / length);
        squares -= R(0.9) * weight * along.lazyProduct(along.transpose());
      }
    }
    if (last.first != std::size_t(-1)) {
      flush(last.first);
    }
    return cost;
  }

  /// Control points after one step; empty if there is no step with this damping.
  [[nodiscard]] std::vector<element> moved_control_points(const R& damping, R& step) {
    factors_ = normal_;
    if (damping > 0) {
      factors_.scale_diagonal(1 + damping);
    }
    if (!factors_.factorise()) {
      return {};
    }
    vector delta = gradient_;
    changes_.solve(factors_, delta);
    step = delta.template lpNorm<Eigen::Infinity>();
    if (!delta.allFinite()) {
      return {};
    }
    // Only rotations of control points are bounded: the curve is linear in translations.
    R largest_angle(0);
    for (Eigen::Index i = dimension; i <= delta.size(); i += dimension) {
      largest_angle = std::max(largest_angle, R(delta.template segment<3>(i - 3).norm()));
    }
    const R fraction = largest_angle > max_rotation ? R(max_rotation / largest_angle) : R(1);
    last_step_ = fraction * delta;
    return this->moved_by(controls_, last_step_);
  }

  /// Index of the sample farthest from the samples around it, and its distance from them.
  [[nodiscard]] std::pair<std::size_t, R> farthest_from_neighbours() const {
    const std::vector<R> sizes = residual_type::residuals(
        robust_centre<T>().controls(*basis_, *u_, samples(), R(options_.characteristic_length)));
    const auto farthest = std::max_element(sizes.begin(), sizes.end());
    return {std::size_t(farthest - sizes.begin()), *farthest};
  }

  /// Reports failure. If plain least squares fail because of a sample far from all others, the
  /// message names it.
  [[noreturn]] void fail(const char* what, int iterations, const R& step) const {
    const auto [index, size] = farthest_from_neighbours();
    std::string cause;
    if (!is_robust() && size > 30) {
      cause = message(": sample ", index, " is ", size, " from the samples around it ",
                      "(fit_options::outlier_threshold makes the fit robust)");
    }
    raise(no_convergence(message("duet: fit: the iteration ", what, " after ",
                                 iterations_ + iterations, " steps, the last one ", step, cause)));
  }

  fit_options options_;
  const basis_type* basis_;
  const std::vector<R>* u_;
  element origin_;        ///< sample to which the others are relative
  std::vector<R> limits_; ///< outlier limits of Huber's loss for each sample; 0: does not count
  std::vector<element> controls_;
  int iterations_ = 0;
  block_band_matrix<R, dimension, std::size_t(Order) - 1> normal_, factors_;
  vector gradient_, last_step_; ///< negative gradient
  gradient_changes<R> changes_;
};

} // namespace duet::detail
