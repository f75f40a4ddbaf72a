// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "constrained_step.hpp"
#include "small_vector.hpp"
#include <duet/core/config.hpp>

#include <Eigen/Core>

#include <optional>
#include <vector>

/// \file
/// Quadratic programming: the step that minimises a quadratic function under linear constraints.

namespace duet::detail {
DUET_ABI_BEGIN

/// Equality and inequality constraints of a step.
template <class V>
struct step_conditions {
  std::vector<inequality<V>> equations;    ///< normal·x = bound
  std::vector<inequality<V>> inequalities; ///< normal·x ≥ bound
};

/// Orthonormal vectors (Gram–Schmidt), and the projection onto their orthogonal complement.
template <class V>
class orthonormal_rows {
public:
  /// Adds a vector, unless it is linearly dependent on those added before.
  ///
  /// \return length of its new component, 0 for none
  double add(const V& row) {
    const V rest = (*this)(row);
    const double length = rest.norm();
    const bool is_new = length > 1e-9 * row.norm();
    if (is_new) {
      rows_.push_back(rest / length);
    }
    return is_new ? length : 0;
  }
  [[nodiscard]] const V& back() const { return rows_.back(); }
  /// Component of x that is orthogonal to all of them.
  [[nodiscard]] V operator()(V x) const {
    for (int twice = 0; twice < 2; ++twice) { // the second pass removes round-off
      for (const V& row : rows_) {
        x -= row.dot(x) * row;
      }
    }
    return x;
  }

private:
  std::vector<V> rows_;
};

/// Minimiser x of gradient·x + ½ xᵀ B x under the constraints, B = `curvature` positive definite;
/// nothing if no x satisfies them. With B = L Lᵀ and y = Lᵀx + L⁻¹ gradient the objective is ½|y|²
/// up to a constant: a least-norm problem for y.
template <class V, class M>
[[nodiscard]] std::optional<V> quadratic_step(const V& gradient, const M& curvature,
                                              const step_conditions<V>& conditions) {
  const cholesky<M> factors(curvature);
  orthonormal_rows<V> equality_rows;
  V aim = V::Zero(gradient.size()); // the least-norm y that satisfies the equations
  for (const inequality<V>& each : conditions.equations) {
    const V row = factors.forward(each.normal);
    const double residual = each.bound - row.dot(aim), length = equality_rows.add(row);
    if (length > 0) {
      aim +=
          residual * length / (length * length + 1e-14 * row.squaredNorm()) * equality_rows.back();
    }
  }
  aim -= equality_rows(factors.forward(gradient));
  std::vector<inequality<V>> reduced;
  reduced.reserve(conditions.inequalities.size());
  for (const inequality<V>& each : conditions.inequalities) {
    const V row = factors.forward(each.normal);
    reduced.push_back({equality_rows(row), each.bound - row.dot(aim)});
  }
  const std::optional<V> correction = least_distance(reduced, gradient.size());
  return correction ? std::optional<V>(factors.backward(V(aim + *correction))) : std::nullopt;
}

DUET_ABI_END
} // namespace duet::detail
