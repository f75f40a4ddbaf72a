// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/block_tridiagonal.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

/// \file
/// The increments of an interpolating curve where turns are small: the start of Newton's method.

namespace duet::detail {

/// Σ weights_j x_j = right: where turns are so small that their order does not matter, coordinates
/// do not mix.
template <class T>
struct small_turn_equation {
  std::array<real_type_t<T>, 3> weights;
  vector3<T> right;
};

/// The solution of all these equations, a tridiagonal system of numbers; zero where it is singular.
template <class R, class Equations>
[[nodiscard]] std::vector<vector3<R>> small_turn_solution(const Equations& equations) {
  const std::size_t n = equations.size();
  block_tridiagonal<R, 1> matrix;
  auto& rows = matrix.rows();
  rows.resize(n);
  std::vector<Eigen::Matrix<R, 1, 3>> x(n);
  for (std::size_t row = 0; row < n; ++row) {
    const small_turn_equation<R> equation = equations.small_turns(row);
    for (std::size_t j = 0; j < 3; ++j) {
      const int at = equations.place(row, j);
      auto& block = at == 0 ? rows[row].lower : at == 1 ? rows[row].diagonal : rows[row].upper;
      block(0, 0) = equation.weights[j];
    }
    x[row] = equation.right;
  }
  if (!matrix.factorise(equations.corner_columns())) {
    return std::vector<vector3<R>>(n, vector3<R>::Zero());
  }
  matrix.solve(x);
  return std::vector<vector3<R>>(x.begin(), x.end());
}

} // namespace duet::detail
