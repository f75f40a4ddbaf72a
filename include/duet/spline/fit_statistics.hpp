// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual/dual.hpp>
#include <duet/spline/blocks.hpp>
#include <duet/spline/cumulative_bspline.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Statistics of fitted curves: covariance of control points and of the motion, runs test of the
/// residuals.

namespace duet {

/// Covariance of the motion of a curve at a parameter: of the value in tangent coordinates
/// (rotation vector in rad, of poses [v; ω]) on its right, that is in body axes, and of the rates
/// in the frame of the call.
template <class R, int Dimension>
struct motion_covariance {
  /// Covariance of [value; velocity; acceleration], which depend on each other.
  Eigen::Matrix<R, 3 * Dimension, 3 * Dimension> joint =
      Eigen::Matrix<R, 3 * Dimension, 3 * Dimension>::Zero();

  /// Covariance of the value.
  [[nodiscard]] auto value() const { return joint.template block<Dimension, Dimension>(0, 0); }
  /// Covariance of the velocity: of ω, of poses of [v; ω].
  [[nodiscard]] auto velocity() const {
    return joint.template block<Dimension, Dimension>(Dimension, Dimension);
  }
  /// Covariance of the acceleration: of dω/dt, of poses of that of [v; ω].
  [[nodiscard]] auto acceleration() const {
    return joint.template block<Dimension, Dimension>(2 * Dimension, 2 * Dimension);
  }
};

namespace detail {

/// Terms of the covariance H⁻¹ M H⁻¹ of estimates: second derivative H of the cost, and covariance
/// M of its gradient.
template <class R, int N, std::size_t Band>
struct sandwich_terms {
  using matrix = block_band_matrix<R, N, Band>;
  matrix of_cost, of_gradient;

  /// The band of H⁻¹ M H⁻¹, by selected inversion over dual numbers: it is the derivative of
  /// (H − ε M)⁻¹. NaN where H is not positive definite.
  [[nodiscard]] matrix covariance() const {
    const auto for_each_entry = [this](const auto& f) {
      of_cost.for_each_block([&](std::size_t i, std::size_t j) {
        for (Eigen::Index k = 0; k < N * N; ++k) {
          f(i, j, k);
        }
      });
    };
    block_band_matrix<dual<R>, N, Band> factors;
    factors.set_zero(of_cost.rows());
    for_each_entry([&](std::size_t i, std::size_t j, Eigen::Index k) {
      factors.at(i, j)(k) = dual<R>(of_cost.at(i, j)(k), -of_gradient.at(i, j)(k));
    });
    const bool is_definite = factors.factorise();
    const auto inverse = factors.selected_inverse();
    matrix result;
    result.set_zero(of_cost.rows());
    for_each_entry([&](std::size_t i, std::size_t j, Eigen::Index k) {
      result.at(i, j)(k) =
          is_definite ? inverse.at(i, j)(k).epsilon() : std::numeric_limits<R>::quiet_NaN();
    });
    return result;
  }
};

} // namespace detail

/// Covariance of a fitted curve, to first order in the errors of the samples: of its control points
/// and of its motion at any parameter.
template <class Spline>
class curve_covariance {
  using element = manifold<quaternion<typename Spline::scalar_type>>;
  using R = typename Spline::real_type;
  static constexpr std::size_t band = std::size_t(Spline::order) - 1;

public:
  static constexpr int dimension = element::dimension; ///< 3 of rotations, 6 of poses
  using block_type = Eigen::Matrix<R, dimension, dimension>;

  /// For those who extend duet: made by `fit_result::covariance`.
  curve_covariance(Spline curve, detail::block_band_matrix<R, dimension, band> blocks)
      : curve_(std::move(curve)), blocks_(std::move(blocks)) {}

  /// Number of control points.
  [[nodiscard]] std::size_t size() const { return blocks_.rows(); }

  /// Covariance of control points i and j: E(δᵢ δⱼᵀ), δ their errors in tangent coordinates in body
  /// axes, rotation vectors (rad) or [v; ω].
  ///
  /// \throws invalid_input for a control point that does not exist, or two that are never active
  /// together, |i − j| ≥ Spline::order; the motion does not depend on their covariance
  [[nodiscard]] block_type block(std::size_t i, std::size_t j) const {
    const std::size_t distance = i > j ? i - j : j - i;
    detail::require(i < size() && j < size() && distance <= band,
                    "duet: curve_covariance: control points ", i, " and ", j, " of ", size(),
                    " (expected two less than ", Spline::order, " apart)");
    if (i < j) {
      return blocks_.at(j, i).transpose();
    }
    return blocks_.at(i, j);
  }

  /// Covariance of the motion at u: J Σ Jᵀ, J the Jacobian of the value, the velocity and the
  /// acceleration with respect to the active control points.
  ///
  /// \param frame  frame of the rates
  /// \throws invalid_input outside the domain
  template <FrameConstant Frame>
  [[nodiscard]] motion_covariance<R, dimension> motion(const R& u, Frame frame) const {
    const auto m = curve_.template motion_jacobian<2>(u, frame);
    constexpr int columns = dimension * Spline::order;
    Eigen::Matrix<R, 3 * dimension, columns> jacobian;
    jacobian << m.value.matrix(), m.velocity.matrix(), m.acceleration.matrix();
    Eigen::Matrix<R, columns, columns> active;
    for (int i = 0; i < Spline::order; ++i) {
      for (int j = 0; j < Spline::order; ++j) {
        active.template block<dimension, dimension>(i * dimension, j * dimension) =
            block(m.first + std::size_t(i), m.first + std::size_t(j));
      }
    }
    return {jacobian * active * jacobian.transpose()};
  }

private:
  Spline curve_;
  detail::block_band_matrix<R, dimension, band> blocks_;
};

namespace detail {

/// Runs test of Wald and Wolfowitz, component by component: residuals of independent errors change
/// their signs about every other sample. Returns a sentence on the component with the fewest sign
/// changes if so few have a probability below 1/1000 in any component; else an empty text.
///
/// \param round_off  root mean square of a component that may be round-off, which is not tested
template <class Tangent>
[[nodiscard]] std::string remark_on_runs(const std::vector<Tangent>& residuals, double round_off) {
  using std::erfc;
  using std::sqrt;
  constexpr int dimension = Tangent::RowsAtCompileTime;
  constexpr std::array<const char*, 6> names = {"v_x",     "v_y",     "v_z",
                                                "omega_x", "omega_y", "omega_z"};
  std::array<double, std::size_t(dimension)> squares{};
  double largest = 0;
  for (const Tangent& r : residuals) {
    for (int c = 0; c < dimension; ++c) {
      squares[std::size_t(c)] += double(r[c]) * double(r[c]);
      largest = std::max(largest, squares[std::size_t(c)]);
    }
  }
  double least = 1e-3;
  std::string remark;
  for (int c = 0; c < dimension; ++c) {
    const double mean = squares[std::size_t(c)] / double(residuals.size());
    if (!(squares[std::size_t(c)] > 1e-12 * largest && mean > round_off * round_off)) {
      continue; // round-off of a motion in a plane, for example
    }
    double positive = 0, negative = 0, runs = 0, last = 0;
    for (const Tangent& r : residuals) {
      const double sign = r[c] > 0 ? 1 : r[c] < 0 ? -1 : 0;
      positive += sign > 0;
      negative += sign < 0;
      runs += sign != 0 && sign != last;
      last = sign != 0 ? sign : last;
    }
    const double count = positive + negative, product = 2 * positive * negative;
    const double expected = product / count + 1;
    const double variance = product * (product - count) / (count * count * (count - 1));
    if (!(count >= 20 && variance > 0)) {
      continue; // too few for the normal distribution
    }
    const double deviations = (expected - runs - 0.5) / sqrt(variance);
    const double probability = dimension * erfc(deviations / sqrt(2.)) / 2;
    if (probability < least) {
      least = probability;
      remark = message("the residuals change their signs too rarely (runs test, component ",
                       names[std::size_t(c + 6 - dimension)], ": ", runs - 1, " times in ", count,
                       " samples, where ", std::round(expected) - 1,
                       " are expected): the knots are too wide for the ",
                       "motion, or the errors of neighbouring samples depend on each other");
    }
  }
  return remark;
}

} // namespace detail
} // namespace duet
