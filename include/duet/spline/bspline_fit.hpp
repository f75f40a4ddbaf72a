// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/tangent.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/bspline_residuals.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/fit_start.hpp>
#include <duet/spline/orientations.hpp>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

/// \file
/// The least-squares problem behind `fit`.

namespace duet {

/// Settings of `fit`.
struct fit_options {
  /// Of poses: the distance that counts as much as a turn by one radian.
  double length = 1;
  /// A residual beyond this counts by its size, not by its square (Huber's loss), and rows that are
  /// farther off than four times this, and twelve times the median of those around, do not count:
  /// outliers however far leave the curve where the others take it. Zero: three times the median
  /// residual. Infinite: plain least squares.
  double outlier = std::numeric_limits<double>::infinity();
  int max_iterations = 100;
};

namespace detail {

/// The least-squares problem: control elements c, moved by tangent vectors in body axes, such that
/// Σ ρ(rᵢ) is least. Normal equations are banded, as a row meets `Order` neighbouring controls.
template <class T, int Order>
class bspline_fit : bspline_residuals<T, Order> {
  using residual_type = bspline_residuals<T, Order>;
  using typename residual_type::basis_type;
  using typename residual_type::element;
  using typename residual_type::R;
  template <class S>
  using tangent = typename residual_type::template tangent<S>;
  using residual_type::dimension;
  using residual_type::first;
  using residual_type::residual_at;
  using residual_type::rows;
  using residual_type::size_of;
  using residual_type::unknowns;

public:
  bspline_fit(const basis_type& basis, const std::vector<R>& u, std::vector<element> elements,
              const fit_options& options)
      : residual_type(basis, u, std::move(elements), R(options.length)), options_(options),
        limits_(u.size(), R(options.outlier)) {
    if (is_robust()) {
      controls_ = medoids(basis, u, this->rows(), R(options.length));
      approach();
    } else {
      controls_ = elements_at_averages(basis, u, this->rows());
      const std::vector<R> sizes = residuals();
      if (!(*std::max_element(sizes.begin(), sizes.end()) < too_far())) {
        controls_ = medoids(basis, u, this->rows(), R(options.length));
        fail_at_farthest();
      }
    }
  }

  /// Does row i count? Outliers that are too far off do not.
  [[nodiscard]] bool counts(std::size_t i) const { return limits_[i] > 0; }
  /// The limit of Huber's loss.
  [[nodiscard]] R outlier() const { return R(options_.outlier); }

  [[nodiscard]] cumulative_bspline<T, Order> curve(const basis_type& basis) const {
    std::vector<vector3<T>> increments{vector3<T>::Zero()};
    for (std::size_t i = 1; i < controls_.size(); ++i) {
      increments.push_back(log(conj(controls_[i - 1]) * controls_[i]).vec());
    }
    return {basis, controls_, std::move(increments)};
  }

  [[nodiscard]] std::vector<R> residuals() const { return residual_type::residuals(controls_); }

  /// Moves the controls to where the cost is least: the number of steps.
  /// \throws no_convergence
  int solve() { return iterations_ + descend(options_.max_iterations, true); }

private:
  static constexpr R tolerance = R(1e-11); // rad
  static constexpr R longest_turn = R(0.5);
  static constexpr R least_outlier = R(1e-9); ///< rows that fit to rounding have no outliers

  [[nodiscard]] bool is_robust() const {
    return options_.outlier < std::numeric_limits<double>::infinity();
  }

  /// Levenberg's and Marquardt's iteration, to its end or as long as it gains much: the number of
  /// steps. \throws no_convergence
  int descend(int most, bool must_converge) {
    const R gain = must_converge ? std::numeric_limits<R>::epsilon() : R(0.1);
    R cost = cost_of(controls_);
    R damping(0), step(0);
    for (int iteration = 1; iteration <= most; ++iteration) {
      assemble();
      const R last = cost;
      for (;;) {
        std::vector<element> moved = moved_controls(damping, step);
        const R next = moved.empty() ? std::numeric_limits<R>::infinity() : cost_of(moved);
        if (!moved.empty() && next <= cost) {
          controls_ = std::move(moved);
          cost = next;
          damping = damping > R(1e-9) ? R(damping / 10) : R(0);
          break;
        }
        if (step <= tolerance && !moved.empty()) { // as low as rounding lets it be
          return iteration;
        }
        damping = damping > 0 ? R(damping * 10) : R(1e-6);
        if (!(damping < R(1e12))) {
          if (!must_converge) {
            return iteration;
          }
          fail("finds no step that brings the curve nearer", iteration, step);
        }
      }
      if (step <= tolerance || last - cost <= gain * cost) {
        return iteration;
      }
    }
    if (must_converge) {
      fail("does not converge", most, step);
    }
    return most;
  }

  /// To the rows, by medians: what is an outlier depends on how far the rows around it are from the
  /// curve so far, and the nearer that comes, the less is left to be one.
  void approach() {
    constexpr int rounds = 12, steps = 4;
    R scale = std::numeric_limits<R>::infinity(); // sum of the limits
    for (int round = 0; round < rounds; ++round) {
      const R last = scale;
      scale = set_limits();
      if (!(scale < R(0.9) * last)) {
        break;
      }
      iterations_ += descend(steps, false);
    }
    if (!(options_.outlier > 0)) {
      options_.outlier = double(std::max(R(3 * median(residuals())), least_outlier));
    }
    set_limits();
    for (R& limit : limits_) {
      limit = std::min(limit, R(options_.outlier));
    }
  }

  /// Three times the median residual around each row, at least `options.outlier`; zero for rows
  /// that are four times as far off and more. Returns the sum of the limits.
  R set_limits() {
    const std::vector<R> sizes = residuals();
    const std::vector<R> medians = local_medians(sizes, first());
    R sum(0);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const R limit = std::max({R(3 * medians[i]), R(options_.outlier), least_outlier});
      limits_[i] = sizes[i] <= 4 * limit && sizes[i] < too_far() ? limit : R(0);
      sum += std::min(limit, too_far());
    }
    return sum;
  }

  /// Squares of larger residuals, and products of those, would overflow.
  [[nodiscard]] static R too_far() {
    using std::sqrt;
    return sqrt(sqrt(std::numeric_limits<R>::max()));
  }
  [[noreturn]] void fail_at_farthest() const {
    const std::vector<R> sizes = residuals();
    const auto farthest = std::max_element(sizes.begin(), sizes.end());
    std::ostringstream reason;
    reason << "is " << *farthest << " from the rows around it, too far for least squares: "
           << "fit_options::outlier makes the fit robust";
    throw invalid_row(std::size_t(farthest - sizes.begin()), reason.str());
  }

  /// ½ r² up to the limit, from there on along the tangent
  [[nodiscard]] R cost_of(const std::vector<element>& controls) const {
    R sum(0);
    typename residual_type::last_span last;
    for (std::size_t i = 0; i < rows().size(); ++i) {
      if (const R limit = limits_[i]; limit > 0) { // the row counts
        const R r = size_of(residual_at(i, controls, last));
        sum += r <= limit ? R(r * r / 2) : R(limit * (r - limit / 2));
      }
    }
    return sum;
  }

  /// JᵀWJ and −JᵀW r at the controls, W the weights of Huber's loss.
  void assemble() {
    const auto size = Eigen::Index(controls_.size()) * dimension;
    gradient_.setZero(size);
    std::vector<Eigen::Triplet<R>> entries;
    typename residual_type::last_span last;
    Eigen::Matrix<R, unknowns, unknowns> squares = Eigen::Matrix<R, unknowns, unknowns>::Zero();
    const auto flush = [&] { // once for all rows on a span: else a million of them take gigabytes
      const Eigen::Index at = Eigen::Index(last.first) * dimension;
      for (int a = 0; a < unknowns && !last.varied.empty(); ++a) {
        for (int b = 0; b <= a; ++b) {
          entries.emplace_back(at + a, at + b, squares(a, b));
        }
      }
      squares.setZero();
    };
    for (std::size_t i = 0; i < rows().size(); ++i) {
      if (!counts(i)) {
        continue;
      }
      if (first()[i] != last.first) {
        flush();
      }
      const auto [value, slope] = this->linearised(i, controls_, last);
      const R length = size_of(value);
      const R weight = length <= limits_[i] ? R(1) : R(limits_[i] / length);
      gradient_.segment(Eigen::Index(last.first) * dimension, unknowns) -=
          weight * (slope.transpose() * value);
      squares += weight * slope.transpose().lazyProduct(slope);
      if (weight < 1) { // Huber's loss is linear there: along the residual it does not curve
        const Eigen::Matrix<R, unknowns, 1> along = slope.transpose() * (value / length);
        squares -= R(0.9) * weight * along.lazyProduct(along.transpose());
      }
    }
    flush();
    normal_.resize(size, size);
    normal_.setFromTriplets(entries.begin(), entries.end());
  }

  /// The controls after one step, none where there is no step with this damping.
  [[nodiscard]] std::vector<element> moved_controls(const R& damping, R& step) const {
    Eigen::SparseMatrix<R> damped = normal_;
    if (damping > 0) {
      for (Eigen::Index i = 0; i < damped.rows(); ++i) {
        damped.coeffRef(i, i) *= 1 + damping;
      }
    }
    // The band is as narrow as any order of the unknowns would make it.
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<R>, Eigen::Lower, Eigen::NaturalOrdering<int>>
        factors(damped);
    if (factors.info() != Eigen::Success) {
      return {};
    }
    const Eigen::Matrix<R, Eigen::Dynamic, 1> delta = factors.solve(gradient_);
    step = delta.template lpNorm<Eigen::Infinity>();
    if (!delta.allFinite()) {
      return {};
    }
    R turn(0); // of the controls: shifts are linear, and may be of any length
    for (Eigen::Index i = dimension; i <= delta.size(); i += dimension) {
      turn = std::max(turn, R(delta.template segment<3>(i - 3).norm()));
    }
    const R fraction = turn > longest_turn ? R(longest_turn / turn) : R(1);
    std::vector<element> moved = controls_;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const tangent<R> d =
          fraction * delta.template segment<dimension>(Eigen::Index(i) * dimension);
      moved[i] = normalized(element(manifold<element>::plus(moved[i], d, frame::body)));
    }
    return moved;
  }

  [[noreturn]] void fail(const char* what, int iterations, const R& step) const {
    std::ostringstream message;
    message << "duet: fit: the iteration " << what << " after " << iterations_ + iterations
            << " steps, the last one " << step;
    throw no_convergence(message.str());
  }

  fit_options options_;
  std::vector<R> limits_; ///< of Huber's loss, row by row; zero: does not count
  std::vector<element> controls_;
  int iterations_ = 0;
  Eigen::SparseMatrix<R> normal_;
  Eigen::Matrix<R, Eigen::Dynamic, 1> gradient_;
};

} // namespace detail
} // namespace duet
