// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/planning/constrained_step.hpp>
#include <duet/planning/small_vector.hpp>

#include <Eigen/Core>

#include <optional>
#include <vector>

/// \file
/// Quadratic programming: the step that minimises a quadratic function under linear constraints.

namespace duet::detail {

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

/// Minimiser x of slope·x + ½ xᵀ B x under the constraints, B = `curvature` positive definite;
/// nothing if no x satisfies them. With B = L Lᵀ and y = Lᵀx + L⁻¹ slope that is the least y.
template <class V, class M>
[[nodiscard]] std::optional<V> quadratic_step(const V& slope, const M& curvature,
                                              const step_conditions<V>& conditions) {
  const cholesky<M> factors(curvature);
  orthonormal_rows<V> kept;
  V aim = V::Zero(slope.size()); // the least that satisfies the equations
  for (const inequality<V>& each : conditions.equations) {
    const V row = factors.forward(each.normal);
    const double missing = each.bound - row.dot(aim), length = kept.add(row);
    if (length > 0) {
      aim += missing * length / (length * length + 1e-14 * row.squaredNorm()) * kept.back();
    }
  }
  aim -= kept(factors.forward(slope));
  std::vector<inequality<V>> left;
  left.reserve(conditions.inequalities.size());
  for (const inequality<V>& each : conditions.inequalities) {
    const V row = factors.forward(each.normal);
    left.push_back({kept(row), each.bound - row.dot(aim)});
  }
  const std::optional<V> correction = least_distance(left, slope.size());
  return correction ? std::optional<V>(factors.backward(V(aim + *correction))) : std::nullopt;
}

} // namespace duet::detail
