// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/rounding.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/blocks/products.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

/// \file
/// Increments of an interpolating curve for small rotations: the initial guess of Newton's method.

namespace duet::detail {

/// Equation Σ weights_j x_j = right for small rotations, which commute to first order, so that
/// coordinates do not mix.
template <class T>
struct small_angle_equation {
  std::array<real_type_t<T>, 3> weights;
  vector3<T> right;
};

/// Solution of all these equations; zero if they are singular.
template <class R, class Equations>
[[nodiscard]] std::vector<vector3<R>> small_angle_solution(const Equations& equations) {
  const std::size_t n = equations.size();
  typename Equations::matrix matrix;
  auto& rows = matrix.rows();
  rows.resize(n);
  std::vector<vector3<R>> x(n);
  for (std::size_t row = 0; row < n; ++row) {
    const small_angle_equation<R> equation = equations.small_angles(row);
    for (std::size_t j = 0; j < 3; ++j) {
      matrix3<R>& block = rows[row].at(equations.block_position(row, j));
      block.setZero();
      for (int k = 0; k < 3; ++k) {
        block(k, k) = equation.weights[j];
      }
    }
    x[row] = equation.right;
  }
  if (!matrix.factorise(equations.corner_columns())) {
    x.assign(n, vector3<R>::Zero());
    return x;
  }
  matrix.solve(x);
  return x;
}

/// Size of a step of the unknowns from x relative to the values it changes: the maximum over all
/// equations of the change divided by the largest term of the equation. So small equations of short
/// intervals count as much as those of long ones.
template <class R, class Equations>
[[nodiscard]] R relative_step(const Equations& equations, const std::vector<vector3<R>>& x,
                              const std::vector<vector3<R>>& step) {
  using std::abs;
  const std::size_t n = x.size();
  std::vector<R> moved(n, R(0)), term(n);
  R largest(0);
  for (std::size_t row = 0; row < n; ++row) {
    const small_angle_equation<R> equation = equations.small_angles(row);
    term[row] = length(equation.right);
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t k = equations.unknown(row, j);
      const R weight = abs(equation.weights[j]);
      const R change = weight * length(step[k]);
      moved[row] += change;
      term[row] = std::max(R(term[row] + change), R(weight * length(x[k])));
    }
    largest = std::max(largest, term[row]);
  }
  // Far from all rotations, terms decay below the smallest numbers: they are bounded from below.
  const R epsilon = std::numeric_limits<R>::epsilon();
  const R min_term = largest * (epsilon * epsilon) * (epsilon * epsilon);
  R result(0);
  for (std::size_t row = 0; row < n; ++row) {
    const R ratio = moved[row] > 0 ? R(moved[row] / std::max(term[row], min_term)) : moved[row];
    result = larger_or_nan(result, ratio);
  }
  return result;
}

/// Size of a step relative to the values it changes, for rates at knots as unknowns, several
/// vectors at each knot, from velocities upwards. Each vector is compared with its own size and
/// with the size that follows from the rotations of the adjacent segments.
///
/// \param rotations  half-angle vectors of the segments
/// \param lengths    lengths of these segments; as many as the knots if the curve is closed
template <class R, int N>
[[nodiscard]] R relative_step_of_rates(const std::vector<Eigen::Matrix<R, N, 1>>& x,
                                       const std::vector<Eigen::Matrix<R, N, 1>>& step,
                                       const std::vector<vector3<R>>& rotations,
                                       const std::vector<R>& lengths) {
  const std::size_t pieces = rotations.size();
  R result(0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t left = i > 0 ? i - 1 : x.size() == pieces ? pieces - 1 : 0;
    const std::size_t right = std::min(i, pieces - 1);
    R size = std::max(R(length(rotations[left]) / lengths[left]),
                      R(length(rotations[right]) / lengths[right]));
    for (int k = 0; k < N; k += 3) {
      const R moved = length(step[i], k);
      const R now = length(x[i], k);
      const R ratio = moved > 0 ? R(moved / std::max(size, std::max(now, moved))) : moved;
      result = larger_or_nan(result, ratio);
      size /= std::max(lengths[left], lengths[right]);
    }
  }
  return result;
}

} // namespace duet::detail
