// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/eigen_problems.hpp"

#include "support/random.hpp"

#include <Eigen/LU>
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

namespace duet_test {

Eigen::VectorXd linear_problem::solved(const Eigen::VectorXd& r) const {
  return a.fullPivLu().solve(r);
}
Eigen::VectorXd linear_problem::x() const { return solved(b); }
Eigen::VectorXd linear_problem::x_slope() const { return solved(b_slope - a_slope * x()); }

linear_problem random_problem(int n, bool positive) {
  random_source random(std::uint64_t(n) + 100);
  const auto draw = [&](int rows, int columns) -> Eigen::MatrixXd {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return random.uniform(-1, 1); });
  };
  linear_problem p{"random", positive, draw(n, n), draw(n, n), draw(n, 1), draw(n, 1)};
  p.a += 2 * Eigen::MatrixXd::Identity(n, n);
  if (positive) {
    p.a = (p.a * p.a.transpose()).eval();
    p.a_slope = (p.a_slope + p.a_slope.transpose()).eval();
  }
  return p;
}

std::vector<linear_problem> problems(int n) {
  std::vector<linear_problem> all{random_problem(n, false), random_problem(n, true)};
  const auto add = [&](const char* name, bool positive) -> linear_problem& {
    all.push_back(random_problem(n, positive));
    all.back().name = name;
    return all.back();
  };
  linear_problem& zero_in_x = add("a zero in the solution", true);
  Eigen::VectorXd x = zero_in_x.x();
  x(0) = 0;
  zero_in_x.b = zero_in_x.a * x;
  add("b is zero", true).b.setZero();
  add("b ends in zeros", true).b.tail(n - 1).setZero();
  add("b begins with zeros", false).b.head(n - 1).setZero();
  const auto keep = [n](linear_problem& p, bool below, bool above) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        if ((i > j && !below) || (i < j && !above)) {
          p.a(i, j) = 0;
        }
      }
    }
  };
  keep(add("A is upper triangular", false), false, true);
  keep(add("A is lower triangular", false), true, false);
  keep(add("A is diagonal", true), false, false);
  add("A is the identity", true).a.setIdentity();
  return all;
}

void check_parts(const Eigen::MatrixXd& parts, const linear_problem& p) {
  const Eigen::VectorXd value = p.x();
  const Eigen::VectorXd slope = p.x_slope();
  const double tolerance = 1e-12 * (1 + value.norm() + slope.norm());
  REQUIRE(parts.rows() == value.size());
  for (int i = 0; i < parts.rows(); ++i) {
    CHECK(std::abs(parts(i, 0) - value(i)) <= tolerance);
    for (int k = 1; k < parts.cols(); ++k) {
      CHECK(std::abs(parts(i, k) - k * slope(i)) <= k * tolerance);
    }
  }
}

} // namespace duet_test
