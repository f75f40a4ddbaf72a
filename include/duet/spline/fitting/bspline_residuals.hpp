// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual_quaternion/exponential_jacobian.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/fit_options.hpp>
#include <duet/spline/fitting/fit_start.hpp>
#include <duet/spline/orientations.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// Distances of samples from a cumulative B-spline, and their derivatives with respect to its
/// control points.

namespace duet::detail {

/// Residuals of samples at given parameters, as functions of the control points of the curve.
template <class T, int Order>
class bspline_residuals {
protected:
  using R = real_type_t<T>;
  using element = quaternion<T>;
  static constexpr int dimension = manifold<element>::dimension;
  static constexpr int unknowns = Order * dimension;
  static constexpr std::size_t factors = std::size_t(Order) - 1;
  using tangent = Eigen::Matrix<R, dimension, 1>;
  using square = Eigen::Matrix<R, dimension, dimension>;
  using basis_type = bspline_basis<Order, R>;

  bspline_residuals(const basis_type& basis, const std::vector<R>& u, std::vector<element> data,
                    const fit_options& options)
      : samples_(std::move(data)), characteristic_length_(R(options.characteristic_length)),
        sample_weights_(options.weights), whitening_(inverse_roots(options.covariances)) {
    first_.reserve(u.size());
    weights_.reserve(u.size());
    for (const R& parameter : u) {
      const std::size_t span = basis.find_span(parameter);
      first_.push_back(basis.first_function(span));
      weights_.push_back(basis.template weights<0>(span, parameter)[0]);
    }
  }

  [[nodiscard]] const std::vector<element>& samples() const { return samples_; }
  /// Index of the first of the `Order` control points on which each sample depends.
  [[nodiscard]] const std::vector<std::size_t>& first() const { return first_; }

  /// Norm, without overflow.
  [[nodiscard]] static R size_of(const tangent& r) {
    const R norm = r.norm();
    return norm <= std::numeric_limits<R>::max() ? norm : R(r.stableNorm());
  }

  [[nodiscard]] std::vector<R> residuals(const std::vector<element>& controls) const {
    std::vector<R> result;
    result.reserve(samples_.size());
    last_span last;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      result.push_back(size_of(residual_at(i, controls, last)));
    }
    return result;
  }

  /// Half-angle vector from control point i − 1 to i.
  [[nodiscard]] static vector3<T> increment(const std::vector<element>& controls, std::size_t i) {
    return log_vector(relative_rotation(controls[i - 1], controls[i]), "fit");
  }

  /// Control points perturbed by tangent vectors in their body axes, one after the other.
  [[nodiscard]] static std::vector<element>
  moved_by(std::vector<element> controls, const Eigen::Matrix<R, Eigen::Dynamic, 1>& step) {
    for (std::size_t i = 0; i < controls.size(); ++i) {
      const tangent d = step.template segment<dimension>(Eigen::Index(i) * dimension);
      controls[i] = normalized(element(manifold<element>::plus(controls[i], d, frame::body)));
    }
    return controls;
  }

  [[nodiscard]] R weight_of(std::size_t i) const {
    return sample_weights_.empty() ? R(1) : R(sample_weights_[i]);
  }
  /// Cost Σ wᵢ ρ(rᵢ) with a limit of Huber's loss for each sample; samples with limit 0 do not
  /// count.
  [[nodiscard]] R cost_of(const std::vector<element>& controls,
                          const std::vector<R>& limits) const {
    R sum(0);
    last_span last;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (limits[i] > 0) {
        sum += weight_of(i) * huber_loss(size_of(residual_at(i, controls, last)), limits[i]);
      }
    }
    return sum;
  }

  /// Common data of samples on one span: the control point at its start, the increments, and their
  /// derivatives with respect to the control points.
  struct segment {
    element start;
    std::array<vector3<T>, factors> increments; ///< half-angle vectors
    /// J_r⁻¹ and J_l⁻¹ of the increments: their derivatives with respect to the control points
    /// after and before.
    std::array<matrix3<T>, factors> by_next, by_last;
  };
  /// Span of the caller's last sample, valid until the control points change.
  struct last_span {
    std::size_t first = std::size_t(-1);
    bool has_rates = false;
    segment shared;
  };

  [[nodiscard]] tangent residual_at(std::size_t i, const std::vector<element>& controls,
                                    last_span& last) const {
    move_to(first_[i], controls, last);
    element value = last.shared.start;
    for (std::size_t j = 0; j < factors; ++j) {
      value = value * duet::exp(part(i, j, last));
    }
    return scaled(twice(residual(value, i)), i);
  }

  struct linear_residual {
    tangent value;
    /// Derivatives with respect to the control points in body axes, one after the other,
    /// transposed.
    Eigen::Matrix<R, unknowns, dimension> gradient;
  };

  /// Residual i and its derivatives. With c exp(δ/2) for a control point c, φ = 2 log(c* c⁺) has
  /// the rate φ̇ = J_r⁻¹(φ) δ⁺ − J_l⁻¹(φ) δ, and the factor exp(wφ/2) has the rate w J_r(wφ) φ̇ in
  /// its body axes. The factors behind it transform this rate to the axes of the value. The
  /// residual r changes by −J_l⁻¹(r) times the rate of the value.
  [[nodiscard]] linear_residual linearised(std::size_t i, const std::vector<element>& controls,
                                           last_span& last) const {
    move_to(first_[i], controls, last);
    add_rates(last);
    std::array<element, factors> exponentials;
    element value = last.shared.start;
    for (std::size_t j = 0; j < factors; ++j) {
      exponentials[j] = duet::exp(part(i, j, last));
      value = value * exponentials[j];
    }
    linear_residual result;
    const vector3<T> r = twice(residual(value, i));
    result.value = scaled(r, i);
    matrix3<T> by_value = -left_jacobian_inverse(r);
    matrix3<T> by_element = matrix3<T>::Zero();
    for (std::size_t j = factors; j-- > 0;) {
      matrix3<T> by_increment = product(by_value, right_jacobian(twice(part(i, j, last))));
      for (T& each : by_increment.reshaped()) {
        each *= weights_[i][j];
      }
      put(by_element + product(by_increment, last.shared.by_next[j]), j + 1, i, result.gradient);
      by_element = -product(by_increment, last.shared.by_last[j]);
      by_value = product(by_value, rotation_matrix(conj(exponentials[j])));
    }
    put(by_element + by_value, 0, i, result.gradient);
    return result;
  }

private:
  /// Moves to the span of the control points from `first` on.
  static void move_to(std::size_t first, const std::vector<element>& controls, last_span& last) {
    if (last.first == first) {
      return;
    }
    last.first = first;
    last.has_rates = false;
    last.shared.start = controls[first];
    for (std::size_t j = 0; j < factors; ++j) {
      last.shared.increments[j] = increment(controls, first + j + 1);
    }
  }
  static void add_rates(last_span& last) {
    for (std::size_t j = 0; j < factors && !last.has_rates; ++j) {
      const vector3<T> phi = twice(last.shared.increments[j]);
      last.shared.by_next[j] = right_jacobian_inverse(phi);
      last.shared.by_last[j] = left_jacobian_inverse(phi);
    }
    last.has_rates = true;
  }

  [[nodiscard]] vector3<T> part(std::size_t i, std::size_t j, const last_span& last) const {
    return weights_[i][j] * components(last.shared.increments[j]);
  }

  /// Logarithm log(S* Q) along the shorter arc.
  [[nodiscard]] vector3<T> residual(const element& value, std::size_t i) const {
    const bool is_opposite = innermost(dot(value, samples_[i])) < 0;
    return log_vector(relative_rotation(value, is_opposite ? element(-samples_[i]) : samples_[i]),
                      "fit");
  }

  [[nodiscard]] static vector3<T> twice(const vector3<T>& half) { return R(2) * components(half); }
  [[nodiscard]] static matrix3<T> product(const matrix3<T>& a, const matrix3<T>& b) {
    return a.lazyProduct(b);
  }

  /// Whitening matrices L⁻¹ of the covariances L Lᵀ.
  ///
  /// \throws invalid_input for a wrong number or size of covariances, and for a covariance that is
  /// not symmetric or not positive definite
  [[nodiscard]] std::vector<square> inverse_roots(const std::vector<Eigen::MatrixXd>& covariances) {
    const std::size_t count = covariances.size();
    require(count <= 1 || count == samples_.size(), "duet: fit: ", count, " covariances for ",
            samples_.size(), " samples (expected one for each, or one for all)");
    std::vector<square> result;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::MatrixXd& covariance = covariances[i];
      require(covariance.rows() == dimension && covariance.cols() == dimension,
              "duet: fit: covariance ", i, " is ", covariance.rows(), " x ", covariance.cols(),
              ", not ", dimension, " x ", dimension);
      require(covariance.isApprox(covariance.transpose()), "duet: fit: covariance ", i,
              " is not symmetric");
      const Eigen::LLT<square> root(covariance.template cast<R>());
      require(covariance.allFinite() && root.info() == Eigen::Success, "duet: fit: covariance ", i,
              " is not positive definite");
      result.push_back(root.matrixL().solve(square::Identity()));
    }
    return result;
  }
  [[nodiscard]] const square& whitening(std::size_t i) const {
    return whitening_[whitening_.size() > 1 ? i : 0];
  }

  /// Residual in its unit: [v/characteristic length; ω] for poses; in standard deviations if there
  /// are covariances.
  [[nodiscard]] tangent scaled(const vector3<T>& r, std::size_t i) const {
    tangent result;
    if constexpr (dimension == 3) {
      result = r;
    } else {
      result = twist_of<R>(r);
    }
    if (!whitening_.empty()) {
      result = whitening(i).lazyProduct(result).eval();
    } else if constexpr (dimension == 6) {
      result.template head<3>() /= characteristic_length_;
    }
    return result;
  }

  /// Stores the transposed linear map m from rates of control point j to residual i.
  void put(const matrix3<T>& m, std::size_t j, std::size_t i,
           Eigen::Matrix<R, unknowns, dimension>& gradient) const {
    auto block = gradient.template middleRows<dimension>(Eigen::Index(j) * dimension);
    if constexpr (dimension == 3) {
      block = m.transpose();
    } else {
      block = unfolded(m).transpose();
    }
    if (!whitening_.empty()) {
      block = block.lazyProduct(whitening(i).transpose()).eval();
    } else if constexpr (dimension == 6) {
      block.template leftCols<3>() /= characteristic_length_;
    }
  }

  std::vector<element> samples_;
  R characteristic_length_;
  std::vector<double> sample_weights_;
  std::vector<square> whitening_; ///< empty, one for all samples or one for each
  std::vector<std::size_t> first_;
  std::vector<std::array<R, factors>> weights_;
};

} // namespace duet::detail
