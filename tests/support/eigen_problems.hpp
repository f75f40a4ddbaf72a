// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/eigen_traits.hpp>

#include <Eigen/Core>

#include <string>
#include <vector>

/// \file
/// Systems A(t) x(t) = b(t) with the closed form x′ = A⁻¹(b′ − A′x), among them those where entries
/// of A, b or x are zero and their derivatives are not. What of it is plain numbers is compiled
/// once, in eigen_problems.cpp.

namespace duet_test {

struct linear_problem {
  std::string name;
  bool positive; ///< symmetric and positive definite, with a symmetric derivative
  Eigen::MatrixXd a, a_slope;
  Eigen::VectorXd b, b_slope;

  /// A⁻¹ r
  [[nodiscard]] Eigen::VectorXd solved(const Eigen::VectorXd& r) const;
  [[nodiscard]] Eigen::VectorXd x() const;
  [[nodiscard]] Eigen::VectorXd x_slope() const;
};

linear_problem random_problem(int n, bool positive);

/// Of size n, every kind of zero.
std::vector<linear_problem> problems(int n);

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
void check_parts(const Eigen::MatrixXd& parts, const linear_problem& p);

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
