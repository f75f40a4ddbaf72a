// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "bounded_step.hpp"
#include "small_vector.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

/// \file
/// Joint step for a small twist of the tip under linear inequalities: the point nearest to the
/// origin that satisfies them.

namespace duet::detail {
DUET_ABI_BEGIN

/// Linear inequality normal·x ≥ bound.
template <class V>
struct inequality {
  V normal;
  double bound;
};

/// Least squares: the residual f − Σ z_i column_i of minimum norm, and z. The second pass removes
/// round-off of the first: a Gram matrix has the squared condition number.
template <class V>
[[nodiscard]] std::pair<V, V> least_squares_on(const std::vector<V>& columns, const V& f) {
  const auto count = Eigen::Index(columns.size());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, V::MaxRowsAtCompileTime,
                V::MaxRowsAtCompileTime>
      gram(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      gram(i, j) = columns[std::size_t(i)].dot(columns[std::size_t(j)]);
    }
  }
  const cholesky factors(gram);
  V z = V::Zero(count), right_side(count), residual = f;
  for (int twice = 0; twice < 2; ++twice) {
    for (Eigen::Index i = 0; i < count; ++i) {
      right_side[i] = columns[std::size_t(i)].dot(residual);
    }
    z += factors.solve(right_side);
    residual = f;
    for (Eigen::Index i = 0; i < count; ++i) {
      residual -= z[i] * columns[std::size_t(i)];
    }
  }
  return {residual, z};
}

/// Nonnegative least squares: the residual f − Σ u_i column_i of minimum norm with all u_i ≥ 0, by
/// Lawson and Hanson's active-set method.
template <class V>
[[nodiscard]] V nonnegative_residual(const std::vector<V>& columns, const V& f) {
  struct share {
    std::size_t column;
    double u;
  };
  std::vector<share> active;
  V residual = f;
  for (std::size_t round = 0; round < 3 * columns.size(); ++round) {
    const auto gain = [&](const V& column) { return column.dot(residual); };
    const auto best = std::max_element(columns.begin(), columns.end(),
                                       [&](const V& a, const V& b) { return gain(a) < gain(b); });
    if (!(gain(*best) > 1e-12)) {
      break;
    }
    active.push_back({std::size_t(best - columns.begin()), 0});
    for (bool is_settled = false; !is_settled && !active.empty();) {
      std::vector<V> chosen;
      for (const share& each : active) {
        chosen.push_back(columns[each.column]);
      }
      const auto [rest, z] = least_squares_on(chosen, f);
      // Step towards z as far as all stay nonnegative; the first that becomes zero leaves the
      // active set.
      double fraction = 1;
      std::size_t first = active.size();
      for (std::size_t i = 0; i < active.size(); ++i) {
        const double u = active[i].u, goal = z[Eigen::Index(i)];
        if (goal <= 0 && u <= fraction * (u - goal)) {
          fraction = u / (u - goal);
          first = i;
        }
      }
      for (std::size_t i = 0; i < active.size(); ++i) {
        active[i].u += fraction * (z[Eigen::Index(i)] - active[i].u);
      }
      is_settled = first == active.size();
      if (is_settled) {
        residual = rest;
      } else {
        active.erase(active.begin() + std::ptrdiff_t(first));
      }
    }
  }
  return residual;
}

/// Least-norm x that satisfies all inequalities (least distance programming); nothing if no x does.
/// With normals and bounds below each other as columns, and f = (0, …, 0, 1), x is a multiple of
/// the residual of the nonnegative least squares (Lawson and Hanson, Solving Least Squares
/// Problems, chapter 23).
template <class V>
[[nodiscard]] std::optional<V> least_distance(const std::vector<inequality<V>>& inequalities,
                                              Eigen::Index n) {
  constexpr int capacity = V::MaxRowsAtCompileTime;
  using column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, capacity + 1, 1>;
  std::vector<column> columns;
  columns.reserve(inequalities.size());
  for (const inequality<V>& each : inequalities) {
    const double length = each.normal.norm();
    if (length > 1e-12) {
      columns.emplace_back(n + 1);
      columns.back().head(n) = each.normal / length;
      columns.back()[n] = each.bound / length;
    } else if (each.bound > 1e-9) {
      return std::nullopt; // independent of x
    }
  }
  if (columns.empty()) {
    return V(V::Zero(n));
  }
  const column residual = nonnegative_residual(columns, column(column::Unit(n + 1, n)));
  // residual[n] is 1 / (1 + |x|²).
  if (!(residual[n] > 1e-8)) {
    return std::nullopt;
  }
  return V(-residual.head(n) / residual[n]);
}

/// Projection of joint steps onto the null space of the Jacobian (self-motion), by Gram–Schmidt
/// orthonormalisation of its rows.
template <class V>
class self_motion {
public:
  template <class J>
  explicit self_motion(const J& jacobian) {
    for (Eigen::Index i = 0; i < 6; ++i) {
      V row = V::Zero(jacobian.cols());
      for (Eigen::Index k = 0; k < row.size(); ++k) {
        row[k] = jacobian(i, k);
      }
      const V rest = (*this)(row);
      const double length = rest.norm();
      if (length > 1e-9 * row.norm()) {
        rows_[count_++] = rest / length;
      }
    }
  }

  [[nodiscard]] V operator()(V step) const {
    for (int twice = 0; twice < 2; ++twice) { // the second pass removes round-off
      for (std::size_t i = 0; i < count_; ++i) {
        step -= rows_[i].dot(step) * rows_[i];
      }
    }
    return step;
  }

private:
  std::array<V, 6> rows_; ///< rows of J, orthonormalised
  std::size_t count_ = 0;
};

template <class V>
struct constrained_step_result {
  std::optional<V> step;          ///< empty if no step satisfies the constraints
  double smallest_singular_value; ///< that of the Jacobian, from above
};

/// Step Δ nearest to `preferred` with lower ≤ Δ ≤ upper and the inequalities, and with J Δ = e up
/// to damping near singularities.
template <class J, class E, class V>
[[nodiscard]] constrained_step_result<V>
constrained_step(const J& jacobian, const E& e, const V& preferred, const V& lower, const V& upper,
                 const std::vector<inequality<V>>& inequalities) {
  const Eigen::Index n = jacobian.cols();
  const damped_gram gram(gram_of(jacobian));
  const E force = gram.solve(e);
  const self_motion<V> null_space(jacobian);
  V unconstrained = null_space(preferred);
  for (Eigen::Index i = 0; i < n; ++i) {
    unconstrained[i] += column_dot(jacobian, i, force);
  }
  std::vector<inequality<V>> reduced; // in the null space
  reduced.reserve(inequalities.size() + 2 * std::size_t(n));
  for (const inequality<V>& each : inequalities) {
    reduced.push_back({null_space(each.normal), each.bound - each.normal.dot(unconstrained)});
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const V normal = null_space(V::Unit(n, i));
    reduced.push_back({normal, lower[i] - unconstrained[i]});
    reduced.push_back({-normal, unconstrained[i] - upper[i]});
  }
  const std::optional<V> correction = least_distance(reduced, n);
  return {correction ? std::optional<V>(unconstrained + *correction) : std::nullopt,
          gram.smallest()};
}

DUET_ABI_END
} // namespace duet::detail
