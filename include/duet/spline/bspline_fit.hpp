// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/tag.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/tangent.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/cumulative_bspline.hpp>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
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
  /// A residual beyond this counts by its size, not by its square (Huber's loss), so that outliers
  /// pull the curve with a bounded force. Infinite: plain least squares.
  double outlier = std::numeric_limits<double>::infinity();
  int max_iterations = 100;
};

namespace detail {

/// The least-squares problem: control elements c, moved by tangent vectors in body axes, such that
/// Σ ρ(rᵢ) is least. Normal equations are banded, as a row meets `Order` neighbouring controls.
template <class T, int Order>
class bspline_fit {
  using R = real_type_t<T>;
  using element = quaternion<T>;
  static constexpr int dimension = manifold<element>::dimension;
  static constexpr int unknowns = Order * dimension;
  using D = dual<R, dimension, derivative_tag<bspline_fit>>; // one control element at a time
  template <class S>
  using tangent = Eigen::Matrix<S, dimension, 1>;
  using basis_type = bspline_basis<Order, R>;
  using weights_type = std::array<R, std::size_t(Order) - 1>;

public:
  bspline_fit(const basis_type& basis, const std::vector<R>& u, std::vector<element> rows,
              const fit_options& options)
      : rows_(std::move(rows)), options_(options), controls_(start(basis, u)) {
    for (const R& parameter : u) {
      const std::size_t span = basis.span_of(parameter);
      first_.push_back(basis.first_function(span));
      weights_.push_back(basis.template weights<0>(span, parameter)[0]);
    }
  }

  [[nodiscard]] cumulative_bspline<T, Order> curve(const basis_type& basis) const {
    std::vector<vector3<T>> increments{vector3<T>::Zero()};
    for (std::size_t i = 1; i < controls_.size(); ++i) {
      increments.push_back(log(conj(controls_[i - 1]) * controls_[i]).vec());
    }
    return {basis, controls_, std::move(increments)};
  }

  [[nodiscard]] std::vector<R> residuals() const {
    std::vector<R> result;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      result.push_back(residual_at(i, controls_).norm());
    }
    return result;
  }

  /// Levenberg's and Marquardt's iteration: the number of steps.
  /// \throws no_convergence
  int solve() {
    R cost = cost_of(controls_);
    R damping(0);
    for (int iteration = 1; iteration <= options_.max_iterations; ++iteration) {
      assemble();
      const R last = cost;
      R step(0);
      for (;;) {
        std::vector<element> moved = moved_controls(damping, step);
        const R next = moved.empty() ? std::numeric_limits<R>::infinity() : cost_of(moved);
        if (next <= cost) {
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
          fail("finds no step that brings the curve nearer", iteration, step);
        }
      }
      if (step <= tolerance || last - cost <= std::numeric_limits<R>::epsilon() * cost) {
        return iteration;
      }
    }
    fail("does not converge", options_.max_iterations, R(0));
  }

private:
  static constexpr R tolerance = R(1e-11); // rad
  static constexpr R longest_step = R(0.5);

  /// Where the rows are at the knots' averages (Greville's abscissae).
  [[nodiscard]] std::vector<element> start(const basis_type& basis, const std::vector<R>& u) const {
    std::vector<element> result;
    for (std::size_t i = 0; i < basis.size(); ++i) {
      R sum(0);
      for (std::size_t j = 1; j < std::size_t(Order); ++j) {
        sum += basis.knots()[i + j];
      }
      const R at = sum / R(Order - 1);
      const auto above = std::size_t(std::upper_bound(u.begin(), u.end(), at) - u.begin());
      const std::size_t right = std::clamp<std::size_t>(above, 1, u.size() - 1);
      const R fraction = std::clamp(R((at - u[right - 1]) / (u[right] - u[right - 1])), R(0), R(1));
      result.push_back(slerp(rows_[right - 1], rows_[right], fraction));
      if (i > 0 && innermost(dot(result[i - 1], result[i])) < 0) {
        result[i] = -result[i];
      }
    }
    return result;
  }

  /// 2 log(S* Q), the shorter way; of poses [v/length; ω].
  template <class S>
  [[nodiscard]] tangent<S> residual(std::size_t i,
                                    const std::array<quaternion<promote_t<T, S>>, Order>& c) const {
    using P = promote_t<T, S>;
    quaternion<P> value = c[0];
    for (std::size_t j = 0; j + 1 < c.size(); ++j) {
      const vector3<P> increment = log(conj(c[j]) * c[j + 1]).vec();
      value = value * duet::exp(vector3<P>(increment * P(weights_[i][j])));
    }
    quaternion<P> error = conj(value) * quaternion<P>(rows_[i]);
    if (innermost(error.w()) < 0) {
      error = -error;
    }
    const vector3<P> half = log(error).vec();
    if constexpr (dimension == 3) {
      return half * S(R(2));
    } else {
      vector6<S> r = twist_of<S>(half) * S(R(2));
      r.template head<3>() /= S(R(options_.length));
      return r;
    }
  }

  [[nodiscard]] tangent<R> residual_at(std::size_t i, const std::vector<element>& controls) const {
    std::array<element, Order> c;
    std::copy_n(controls.begin() + std::ptrdiff_t(first_[i]), Order, c.begin());
    return residual<R>(i, c);
  }

  struct linear_residual {
    tangent<R> value;
    Eigen::Matrix<R, dimension, unknowns> slope;
  };

  [[nodiscard]] linear_residual linearised(std::size_t i) const {
    linear_residual result;
    std::array<quaternion<promote_t<T, D>>, Order> c;
    std::copy_n(controls_.begin() + std::ptrdiff_t(first_[i]), Order, c.begin());
    tangent<D> delta;
    for (int b = 0; b < dimension; ++b) {
      delta[b] = D::variable(R(0), b);
    }
    for (int j = 0; j < Order; ++j) {
      const element& control = controls_[first_[i] + std::size_t(j)];
      c[std::size_t(j)] = manifold<element>::plus(control, delta, frame::body);
      const tangent<D> r = residual<D>(i, c);
      c[std::size_t(j)] = quaternion<promote_t<T, D>>(control);
      for (int a = 0; a < dimension; ++a) {
        result.value[a] = r[a].value();
        for (int b = 0; b < dimension; ++b) {
          result.slope(a, dimension * j + b) = r[a].partial(b);
        }
      }
    }
    return result;
  }

  /// ½ r² up to the limit, from there on along the tangent
  [[nodiscard]] R cost_of(const std::vector<element>& controls) const {
    const R limit(options_.outlier);
    R sum(0);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const R r = residual_at(i, controls).norm();
      sum += r <= limit ? R(r * r / 2) : R(limit * (r - limit / 2));
    }
    return sum;
  }

  /// JᵀWJ and −JᵀW r at the controls, W the weights of Huber's loss.
  void assemble() {
    const auto size = Eigen::Index(controls_.size()) * dimension;
    gradient_.setZero(size);
    std::vector<Eigen::Triplet<R>> entries;
    entries.reserve(rows_.size() * std::size_t(unknowns * (unknowns + 1) / 2));
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto [value, slope] = linearised(i);
      const R length = value.norm();
      const R weight = length <= R(options_.outlier) ? R(1) : R(R(options_.outlier) / length);
      const Eigen::Index at = Eigen::Index(first_[i]) * dimension;
      gradient_.segment(at, unknowns) -= weight * (slope.transpose() * value);
      const Eigen::Matrix<R, unknowns, unknowns> square = weight * (slope.transpose() * slope);
      for (int a = 0; a < unknowns; ++a) {
        for (int b = 0; b <= a; ++b) {
          entries.emplace_back(at + a, at + b, square(a, b));
        }
      }
    }
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
    const R fraction = step > longest_step ? R(longest_step / step) : R(1);
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
    message << "duet: fit: the iteration " << what << " after " << iterations
            << " steps, the last one " << step;
    throw no_convergence(message.str());
  }

  std::vector<element> rows_;
  fit_options options_;
  std::vector<element> controls_;
  std::vector<std::size_t> first_;
  std::vector<weights_type> weights_;
  Eigen::SparseMatrix<R> normal_;
  Eigen::Matrix<R, Eigen::Dynamic, 1> gradient_;
};

} // namespace detail
} // namespace duet
