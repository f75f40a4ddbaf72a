// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/robotics/timing/path_velocity_constraints.hpp>

#include <cstddef>
#include <optional>
#include <vector>

/// \file
/// Constraint on a squared path velocity, and the Newton model (gradient and banded Hessian) of a
/// function of its coefficients. For those who extend duet.

namespace duet::detail {

/// Constraint |x| + beyond ≤ limit on a squared path velocity, with the derivatives of all three
/// with respect to its coefficients from `first` on. `order` n: limit of the n-th time derivative,
/// for velocities of their squares.
struct barrier_constraint {
  int order;
  std::optional<std::size_t> joint; ///< joint, if the constraint is of a single joint
  std::size_t first;
  double limit, beyond, x;
  const linear_form &limit_by, &beyond_by, &x_by;
};

/// Gradient of a function of the coefficients, and the band of its Hessian: (i, i), (i, i + 1) and
/// (i, i + 2).
struct barrier_newton_model {
  std::vector<double> gradient;
  std::vector<linear_form> matrix;

  explicit barrier_newton_model(std::size_t n) : gradient(n), matrix(n) {}
  /// Adds a function f of a linear form of the coefficients, given f' and f''.
  void add(std::size_t first, const linear_form& by, double derivative, double curvature) {
    for (std::size_t i = 0; i < 3; ++i) {
      gradient[first + i] += derivative * by[i];
      for (std::size_t j = i; j < 3; ++j) {
        matrix[first + i][j - i] += curvature * by[i] * by[j];
      }
    }
  }
  /// Keeps coefficient i constant.
  void fix(std::size_t i) {
    gradient[i] = 0;
    matrix[i] = {1, 0, 0};
    for (std::size_t k = 1; k < 3 && k <= i; ++k) {
      matrix[i - k][k] = 0;
    }
  }
  /// Newton step to the minimum of the model, by a factorisation L D Lᵀ of the matrix,
  /// which is overwritten.
  [[nodiscard]] std::vector<double> solution() {
    const std::size_t n = gradient.size();
    matrix[n - 1][1] = matrix[n - 1][2] = matrix[n - 2][2] = 0;
    std::vector<double> x(n + 2);
    for (std::size_t i = 0; i < n; ++i) {
      auto& [d, one, two] = matrix[i];
      x[i] -= gradient[i];
      if (i + 1 < n) {
        matrix[i + 1][0] -= one * one / d;
        matrix[i + 1][1] -= one * two / d;
      }
      if (i + 2 < n) {
        matrix[i + 2][0] -= two * two / d;
      }
      one /= d;
      two /= d;
      x[i + 1] -= one * x[i];
      x[i + 2] -= two * x[i];
    }
    x.resize(n);
    for (std::size_t i = n; i-- > 0;) {
      x[i] /= matrix[i][0];
      for (std::size_t k = 1; k < 3 && i + k < n; ++k) {
        x[i] -= matrix[i][k] * x[i + k];
      }
    }
    return x;
  }
};

} // namespace duet::detail
