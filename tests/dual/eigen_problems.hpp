// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/random.hpp"

#include <duet/dual/eigen_traits.hpp>

#include <Eigen/LU>
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

/// \file
/// Systems A(t) x(t) = b(t) with the closed form x′ = A⁻¹(b′ − A′x), among them those where entries
/// of A, b or x are zero and their derivatives are not.

namespace duet_test {

struct linear_problem {
  std::string name;
  bool positive; ///< symmetric and positive definite, with a symmetric derivative
  Eigen::MatrixXd a, a_slope;
  Eigen::VectorXd b, b_slope;

  /// A⁻¹ r
  [[nodiscard]] Eigen::VectorXd solved(const Eigen::VectorXd& r) const {
    return a.fullPivLu().solve(r);
  }
  [[nodiscard]] Eigen::VectorXd x() const { return solved(b); }
  [[nodiscard]] Eigen::VectorXd x_slope() const { return solved(b_slope - a_slope * x()); }
};

inline linear_problem random_problem(int n, bool positive) {
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

/// Of size n, every kind of zero.
inline std::vector<linear_problem> problems(int n) {
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

/// value + ε slope; further partials are multiples of the first.
template <class D, int Rows, int Columns, int Options = 0>
Eigen::Matrix<D, Rows, Columns, Options> seeded(const Eigen::MatrixXd& value,
                                                const Eigen::MatrixXd& slope, int partials = 1) {
  Eigen::Matrix<D, Rows, Columns, Options> result(value.rows(), value.cols());
  for (int i = 0; i < value.rows(); ++i) {
    for (int j = 0; j < value.cols(); ++j) {
      D d(value(i, j));
      for (int k = 0; k < partials; ++k) {
        d.set_partial(k, (k + 1) * slope(i, j));
      }
      result(i, j) = d;
    }
  }
  return result;
}

/// Row i of `parts` is the value of x_i, then its partials, multiples of the first.
inline void check_parts(const Eigen::MatrixXd& parts, const linear_problem& p) {
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

template <class X>
void check_solution(const X& x, const linear_problem& p, int partials = 1) {
  Eigen::MatrixXd parts(x.size(), partials + 1);
  for (int i = 0; i < x.size(); ++i) {
    parts(i, 0) = x(i).value();
    for (int k = 0; k < partials; ++k) {
      parts(i, k + 1) = x(i).partial(k);
    }
  }
  check_parts(parts, p);
}

} // namespace duet_test
