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

  [[nodiscard]] Eigen::VectorXd x() const { return a.fullPivLu().solve(b); }
  [[nodiscard]] Eigen::VectorXd x_slope() const {
    return a.fullPivLu().solve(b_slope - a_slope * x());
  }
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
  const auto add = [&](const char* name, bool positive, auto change) {
    linear_problem p = random_problem(n, positive);
    p.name = name;
    change(p);
    all.push_back(p);
  };
  add("a zero in the solution", true, [](auto& p) {
    Eigen::VectorXd x = p.x();
    x(0) = 0;
    p.b = p.a * x;
  });
  add("b is zero", true, [](auto& p) { p.b.setZero(); });
  add("b ends in zeros", true, [](auto& p) { p.b.tail(p.b.size() - 1).setZero(); });
  add("b begins with zeros", false, [](auto& p) { p.b.head(p.b.size() - 1).setZero(); });
  add("A is upper triangular", false,
      [](auto& p) { p.a = p.a.template triangularView<Eigen::Upper>().toDenseMatrix().eval(); });
  add("A is lower triangular", false,
      [](auto& p) { p.a = p.a.template triangularView<Eigen::Lower>().toDenseMatrix().eval(); });
  add("A is diagonal", true, [](auto& p) { p.a = Eigen::MatrixXd(p.a.diagonal().asDiagonal()); });
  add("A is the identity", true, [](auto& p) { p.a.setIdentity(); });
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

template <class X>
void check_solution(const X& x, const linear_problem& p, int partials = 1) {
  const Eigen::VectorXd value = p.x();
  const Eigen::VectorXd slope = p.x_slope();
  const double tolerance = 1e-12 * (1 + value.norm() + slope.norm());
  REQUIRE(x.size() == value.size());
  for (int i = 0; i < x.size(); ++i) {
    CHECK(std::abs(x(i).value() - value(i)) <= tolerance);
    for (int k = 0; k < partials; ++k) {
      CHECK(std::abs(x(i).partial(k) - (k + 1) * slope(i)) <= (k + 1) * tolerance);
    }
  }
}

} // namespace duet_test
