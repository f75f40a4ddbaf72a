// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "bounded_step.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <cstddef>
#include <optional>
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

/// Nonnegative least squares: the residual f − A u of minimum norm with all u ≥ 0, by Lawson and
/// Hanson's active-set method.
[[nodiscard]] inline Eigen::VectorXd nonnegative_residual(const Eigen::MatrixXd& a,
                                                          const Eigen::VectorXd& f) {
  struct share {
    Eigen::Index column;
    double u;
  };
  std::vector<share> active;
  Eigen::VectorXd residual = f;
  for (Eigen::Index round = 0; round < 3 * a.cols(); ++round) {
    Eigen::Index best = 0;
    if (!((a.transpose() * residual).maxCoeff(&best) > 1e-12)) {
      break;
    }
    active.push_back({best, 0});
    for (bool is_settled = false; !is_settled && !active.empty();) {
      const auto count = Eigen::Index(active.size());
      Eigen::MatrixXd chosen(a.rows(), count);
      for (Eigen::Index i = 0; i < count; ++i) {
        chosen.col(i) = a.col(active[std::size_t(i)].column);
      }
      // The second pass removes round-off of the first: a Gram matrix has the squared condition
      // number.
      const Eigen::LDLT<Eigen::MatrixXd> factors(chosen.transpose() * chosen);
      Eigen::VectorXd z = factors.solve(chosen.transpose() * f);
      z += factors.solve(chosen.transpose() * (f - chosen * z));
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
        residual = f - chosen * z;
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
  Eigen::MatrixXd columns(n + 1, Eigen::Index(inequalities.size()));
  Eigen::Index count = 0;
  for (const inequality<V>& each : inequalities) {
    const double length = each.normal.norm();
    if (length > 1e-12) {
      columns.col(count++) << each.normal / length, each.bound / length;
    } else if (each.bound > 1e-9) {
      return std::nullopt; // independent of x
    }
  }
  const Eigen::VectorXd residual =
      nonnegative_residual(columns.leftCols(count), Eigen::VectorXd::Unit(n + 1, n));
  // residual[n] is 1 / (1 + |x|²).
  if (!(residual[n] > 1e-8)) {
    return std::nullopt;
  }
  return V(-residual.head(n) / residual[n]);
}

/// Orthonormal vectors (Gram–Schmidt), and the projection onto their orthogonal complement.
template <class V>
class orthonormal_rows {
public:
  orthonormal_rows() = default;
  /// Rows of a matrix: the projection is that of steps onto its null space (self-motion).
  template <class J>
  explicit orthonormal_rows(const J& matrix, Eigen::Index size) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      V row = V::Zero(size);
      row.head(matrix.cols()) = matrix.row(i);
      add(row);
    }
  }

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

template <class V>
struct constrained_step_result {
  std::optional<V> step;          ///< empty if no step satisfies the constraints
  double smallest_singular_value; ///< that of the Jacobian, from above
};

/// Step Δ nearest to `preferred` with lower ≤ Δ ≤ upper and the inequalities, and with J Δ = e up
/// to damping near singularities.
template <class J, class V>
[[nodiscard]] constrained_step_result<V>
constrained_step(const J& jacobian, const small_twist& e, const V& preferred, const V& lower,
                 const V& upper, const std::vector<inequality<V>>& inequalities) {
  const Eigen::Index n = jacobian.cols(), size = preferred.size();
  const damped_gram gram(gram_of(jacobian));
  const orthonormal_rows<V> null_space(jacobian, size);
  V unconstrained = null_space(preferred);
  unconstrained.head(n) += jacobian.transpose() * gram.solve(e);
  std::vector<inequality<V>> reduced; // in the null space
  reduced.reserve(inequalities.size() + 2 * std::size_t(n));
  for (const inequality<V>& each : inequalities) {
    reduced.push_back({null_space(each.normal), each.bound - each.normal.dot(unconstrained)});
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const V normal = null_space(V::Unit(size, i));
    reduced.push_back({normal, lower[i] - unconstrained[i]});
    reduced.push_back({-normal, unconstrained[i] - upper[i]});
  }
  const std::optional<V> correction = least_distance(reduced, size);
  return {correction ? std::optional<V>(unconstrained + *correction) : std::nullopt,
          gram.smallest()};
}

DUET_ABI_END
} // namespace duet::detail
