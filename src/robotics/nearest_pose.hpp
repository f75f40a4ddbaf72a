// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "bounded_step.hpp"
#include "small_vector.hpp"
#include <duet/quaternion/three_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

/// \file
/// Error of a pose relative to a goal as a function of the joints, to second order: minimised for
/// the nearest pose to a goal out of reach.

namespace duet::detail {
DUET_ABI_BEGIN

/// Squared error ½|e|², e = [displacement of the origin; 2 log r] from the tip to a goal.
template <int Capacity>
struct squared_error {
  small_vector<Capacity> gradient;            ///< gradient
  small_matrix<Capacity, Capacity> curvature; ///< second derivatives (Hessian), the lower half
};

/// Squared error to second order. With [v_k; ω_k] the columns of J in `frame::hybrid` and e = [w;
/// φ], the gradient is −Jᵀe, and the second derivatives are for j ≤ k
///
/// v_j·v_k − w·(ω_j × v_k) + ω_j·ω_k + c (φ × ω_j)·(ω_k × φ) − [j < k] ½ φ·(ω_j × ω_k),
///
/// as ∂v_k/∂θ_j = ω_j × v_k, ∂ω_k/∂θ_j = ω_j × ω_k, and −∂φ/∂θ_j = ω_j + ½ φ × ω_j +
/// c φ × (φ × ω_j), c = (1 − ½|φ| cot ½|φ|)/|φ|².
template <int Capacity>
[[nodiscard]] squared_error<Capacity> squared_error_of(const small_matrix<6, Capacity>& jacobian,
                                                       const small_twist& e) {
  const three_vector<double> w{e[0], e[1], e[2]}, phi{e[3], e[4], e[5]};
  const double angle = std::sqrt(dot(phi, phi)), half = angle / 2;
  // The error of the constant moves the solution less than round-off of the gradient does.
  const double c = angle > 1e-3 ? (1 - half / std::tan(half)) / (angle * angle) : 1. / 12;
  squared_error<Capacity> result;
  for (std::ptrdiff_t k = 0; k < jacobian.cols(); ++k) {
    const auto& column = jacobian.columns[std::size_t(k)];
    const three_vector<double> v_k{column[0], column[1], column[2]};
    const three_vector<double> omega_k{column[3], column[4], column[5]};
    result.gradient[k] = -(dot(w, v_k) + dot(phi, omega_k));
    for (std::ptrdiff_t j = 0; j <= k; ++j) {
      const auto& before = jacobian.columns[std::size_t(j)];
      const three_vector<double> v_j{before[0], before[1], before[2]};
      const three_vector<double> omega_j{before[3], before[4], before[5]};
      result.curvature(k, j) = dot(v_j, v_k) - dot(w, cross(omega_j, v_k)) + dot(omega_j, omega_k) -
                               c * dot(cross(phi, omega_j), cross(phi, omega_k)) -
                               .5 * dot(phi, cross(omega_j, omega_k));
    }
  }
  return result;
}

/// Newton step to the minimum of ½|e|² in the coordinates that are not fixed; nothing if the
/// curvature and λ together are not positive definite.
template <int Capacity>
[[nodiscard]] std::optional<small_vector<Capacity>>
newton_step(const squared_error<Capacity>& error,
            const std::array<bool, std::size_t(Capacity)>& is_fixed, double lambda) {
  small_matrix<Capacity, Capacity> matrix;
  small_vector<Capacity> right;
  for (std::ptrdiff_t j = 0; j < Capacity; ++j) {
    matrix(j, j) = 1;
    if (is_fixed[std::size_t(j)]) {
      continue;
    }
    right[j] = -error.gradient[j];
    matrix(j, j) = error.curvature(j, j) + lambda;
    for (std::ptrdiff_t k = j + 1; k < Capacity; ++k) {
      matrix(k, j) = is_fixed[std::size_t(k)] ? 0 : error.curvature(k, j);
    }
  }
  const cholesky factors(matrix);
  if (!factors.is_positive()) {
    return std::nullopt;
  }
  return factors.solve(right);
}

DUET_ABI_END
} // namespace duet::detail
