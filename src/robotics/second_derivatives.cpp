// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loops/second_derivatives.hpp"

#include "loops/rank_revealing_svd.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

std::vector<Eigen::MatrixXd> quadratic_forms(const closed_chain_mechanism& of,
                                             const Eigen::VectorXd& q, const Eigen::MatrixXd& w,
                                             const Eigen::MatrixXd& columns) {
  const Eigen::Index n = columns.cols();
  std::vector<Eigen::MatrixXd> result(std::size_t(w.cols()), Eigen::MatrixXd(n, n));
  const auto second = [&](const Eigen::VectorXd& direction) {
    Eigen::Matrix<along_line, Eigen::Dynamic, 1> x(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      x[i] = q[i] + of.units()[i] * direction[i] * along_line::variable(0);
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
        result[k](i, j) = along[Eigen::Index(k)];
      }
    }
  }
  for (Eigen::MatrixXd& form : result) {
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = 0; i < j; ++i) {
        form(j, i) = form(i, j) = (form(i, j) - form(i, i) - form(j, j)) / 2;
      }
    }
  }
  return result;
}

Eigen::VectorXd random_direction(random_source& random, Eigen::Index n) {
  Eigen::VectorXd result(n);
  do {
    for (double& x : result) {
      x = random.normal();
    }
  } while (result.norm() < 1e-3);
  return result.normalized();
}

std::optional<Eigen::VectorXd> common_zero(const std::vector<Eigen::MatrixXd>& forms,
                                           Eigen::VectorXd v, double rounding) {
  const auto count = Eigen::Index(forms.size());
  Eigen::VectorXd f(count + 1);
  Eigen::MatrixXd j(count + 1, v.size());
  for (int i = 0; i < 40; ++i) {
    for (Eigen::Index k = 0; k < count; ++k) {
      j.row(k) = 2 * (forms[std::size_t(k)] * v).transpose();
    }
    j.row(count) = v.transpose();
    f << j.topRows(count) * v / 2, (v.squaredNorm() - 1) / 2;
    if (f.norm() < rounding) {
      return v;
    }
    const rank_revealing_svd svd(j);
    v -= svd.solve(f, svd.rank());
  }
  return std::nullopt;
}
DUET_ABI_END
} // namespace duet::detail
