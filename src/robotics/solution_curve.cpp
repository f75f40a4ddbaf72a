// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "loops/solution_curve.hpp"
#include "loops/rank_revealing_svd.hpp"
#include "loops/second_derivatives.hpp"

#include <duet/core/text/printable.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

std::optional<curve_point> solution_curve::start(double direction) const {
  Eigen::VectorXd x(Eigen::Index(dependent_.size()) + 1);
  x << q0_.cwiseQuotient(of_.units())(dependent_), 0;
  return point(x, Eigen::VectorXd::Unit(x.size(), x.size() - 1) * direction);
}

Eigen::VectorXd solution_curve::coordinates(const Eigen::VectorXd& x) const {
  Eigen::VectorXd q = q0_.cwiseQuotient(of_.units());
  q(dependent_) = x.head(x.size() - 1);
  q(drives_) += x[x.size() - 1] * direction_;
  return q.cwiseProduct(of_.units());
}

Eigen::VectorXd solution_curve::rates(const Eigen::VectorXd& tangent) const {
  Eigen::VectorXd v(of_.size());
  v(dependent_) = tangent.head(tangent.size() - 1);
  v(drives_) = tangent[tangent.size() - 1] * direction_;
  return v.cwiseProduct(of_.units());
}

std::optional<curve_point> solution_curve::advance(const curve_point& from, double step) const {
  const auto to = reached(from, step);
  if (to && from.min_singular_value + to->min_singular_value < 2 * step &&
      !reached(from, step / 2)) {
    return std::nullopt;
  }
  return to;
}

std::optional<curve_point> solution_curve::nearest_point(Eigen::VectorXd x,
                                                         const Eigen::VectorXd& before,
                                                         double max_norm) const {
  return correct(x, false, max_norm) ? point(x, before) : std::nullopt;
}

std::optional<curve_point> solution_curve::at(double s, const curve_point& guess,
                                              double max_norm) const {
  Eigen::VectorXd x = guess.x;
  x[x.size() - 1] = s;
  return correct(x, true, max_norm) ? point(x, guess.tangent) : std::nullopt;
}

Eigen::VectorXd solution_curve::residuals(const Eigen::VectorXd& x) const {
  return of_.residuals(coordinates(x));
}

Eigen::MatrixXd solution_curve::matrix(const Eigen::VectorXd& x) const {
  const Eigen::MatrixXd j = unit_jacobian(of_, coordinates(x));
  Eigen::MatrixXd a(j.rows(), x.size());
  a << columns(j, dependent_), columns(j, drives_) * direction_;
  return a;
}

std::vector<Eigen::MatrixXd> solution_curve::forms(const Eigen::VectorXd& x,
                                                   const Eigen::MatrixXd& w,
                                                   const Eigen::MatrixXd& k) const {
  Eigen::MatrixXd unit_rates(of_.size(), k.cols());
  for (Eigen::Index i = 0; i < k.cols(); ++i) {
    unit_rates.col(i) = rates(k.col(i)).cwiseQuotient(of_.units());
  }
  return quadratic_forms(of_, coordinates(x), w, unit_rates);
}

std::optional<curve_point> solution_curve::reached(const curve_point& from, double step) const {
  const auto to = nearest_point(from.x + step * from.tangent, from.tangent, step / 4);
  if (!to || to->tangent.dot(from.tangent) < .95) {
    return std::nullopt;
  }
  const double change = volume(*to, from.image) / volume(from, from.image);
  return change > .25 && change < 4 ? to : std::nullopt;
}

std::optional<curve_point> solution_curve::point(const Eigen::VectorXd& x,
                                                 const Eigen::VectorXd& before) const {
  curve_point result{x, {}, matrix(x), {}, 0};
  const rank_revealing_svd svd(result.matrix);
  if (svd.rank() != x.size() - 1) {
    return std::nullopt;
  }
  result.tangent = svd.kernel();
  result.tangent *= result.tangent.dot(before) < 0 ? -1 : 1;
  result.image = svd.image();
  result.min_singular_value = svd.rank() > 0 ? svd.singular_values()[svd.rank() - 1] : 1;
  return result;
}

double solution_curve::volume(const curve_point& at, const Eigen::MatrixXd& image) {
  Eigen::MatrixXd m(at.x.size(), at.x.size());
  m << image.transpose().lazyProduct(at.matrix), at.tangent.transpose();
  return m.fullPivLu().determinant();
}

bool solution_curve::correct(Eigen::VectorXd& x, bool s_is_fixed, double max_norm) const {
  const Eigen::Index n = x.size() - (s_is_fixed ? 1 : 0);
  double before = max_norm;
  for (int i = 0; i < 12; ++i) {
    const Eigen::VectorXd f = residuals(x);
    const rank_revealing_svd svd(matrix(x).leftCols(n));
    if (svd.rank() < x.size() - 1) {
      return false;
    }
    const Eigen::VectorXd dx = -svd.solve(f, x.size() - 1);
    const double length = dx.norm();
    if (!(length <= max_norm)) {
      return false;
    }
    const double rounding = 1e-14 * std::max(1.0, x.norm());
    x.head(n) += dx;
    if (length <= rounding || (length < 1e-10 && length > before / 4)) {
      return residuals(x).norm() <= 1e-11 * std::max(1.0, x.norm());
    }
    if (i > 0 && length > before / 2) {
      return false;
    }
    before = length;
  }
  return false;
}
std::string moving_coordinates(const closed_chain_mechanism& of, const Eigen::VectorXd& rates) {
  const Eigen::VectorXd sizes = rates.cwiseQuotient(of.units()).cwiseAbs();
  std::string result;
  for (int i = 0; i < of.size(); ++i) {
    if (sizes[i] > 1e-4 * sizes.maxCoeff()) {
      result += (result.empty() ? "" : ", ") + of.tree().coordinate_names()[std::size_t(i)];
    }
  }
  return printable(result);
}

DUET_ABI_END
} // namespace duet::detail
