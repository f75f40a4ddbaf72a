// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/taylor.hpp>
#include <duet/mechanism/closed_tree.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

/// \file
/// Second derivatives of the equations of loops. For those who extend duet.

namespace duet::detail {

/// What the equations are differentiated twice with.
using along_line = taylor<double, 2, derivative_tag<closed_tree>>;

/// The forms wᵀ ∂²F(K v, K v) of v, a symmetric matrix for each column w, by F along the lines of
/// single columns of K and of sums of two: 2 b(u, v) = b(u + v, u + v) − b(u, u) − b(v, v).
/// \param columns  K, per unit of each coordinate
[[nodiscard]] inline std::vector<Eigen::MatrixXd> quadratic_forms(const closed_tree& of,
                                                                  const Eigen::VectorXd& q,
                                                                  const Eigen::MatrixXd& w,
                                                                  const Eigen::MatrixXd& columns) {
  const Eigen::Index n = columns.cols();
  std::vector<Eigen::MatrixXd> result(std::size_t(w.cols()), Eigen::MatrixXd(n, n));
  const auto second = [&](const Eigen::VectorXd& way) {
    Eigen::Matrix<along_line, Eigen::Dynamic, 1> x(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      x[i] = q[i] + of.units()[i] * way[i] * along_line::variable(0);
    }
    const auto f = of.residuals(x);
    Eigen::VectorXd all(f.size());
    for (Eigen::Index i = 0; i < f.size(); ++i) {
      all[i] = f[i].derivative(2);
    }
    return Eigen::VectorXd(w.transpose() * all);
  };
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) {
      const Eigen::VectorXd along =
          i == j ? second(columns.col(j)) : second(columns.col(i) + columns.col(j));
      for (std::size_t k = 0; k < result.size(); ++k) {
        Eigen::MatrixXd& form = result[k];
        form(i, j) = along[Eigen::Index(k)];
      }
    }
  }
  for (Eigen::MatrixXd& form : result) {
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = 0; i < j; ++i) {
        form(i, j) = (form(i, j) - form(i, i) - form(j, j)) / 2;
        form(j, i) = form(i, j);
      }
    }
  }
  return result;
}

} // namespace duet::detail
