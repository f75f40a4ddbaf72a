// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: differentiate with respect to a vector, .*f, x.reshaped\(\)
// within: 5
// forms: 10

#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/sparse.hpp>

#include <Eigen/Core>

#include <iostream>

int main() {
  const auto f = [](const auto& x) { return x.sum(); };
  const Eigen::Matrix2d x = Eigen::Matrix2d::Ones();
#if DUET_MUST_FAIL == 1
  return duet::gradient(f, x).value == 4 ? 0 : 1;
#elif DUET_MUST_FAIL == 2
  std::cout << duet::gradient(f, Eigen::MatrixXd(x)).gradient << "\n";
#elif DUET_MUST_FAIL == 3
  const auto [y, h] = duet::jacobian(f, x);
#elif DUET_MUST_FAIL == 4
  std::cout << duet::hessian(f, 2 * x).hessian << "\n";
#elif DUET_MUST_FAIL == 5
  Eigen::VectorXd g(4);
  return duet::gradient_into(f, x, g) == 4 ? 0 : 1;
#elif DUET_MUST_FAIL == 6
  Eigen::MatrixXd j(1, 4);
  std::cout << duet::jacobian_into<2>(f, x, j);
#elif DUET_MUST_FAIL == 7
  const auto [y, dy] = duet::directional_derivative(f, x, x);
#elif DUET_MUST_FAIL == 8
  std::cout << duet::hessian_vector_product(f, x, x).value;
#elif DUET_MUST_FAIL == 9
  std::cout << duet::sparse_jacobian(f, x, Eigen::SparseMatrix<double>(1, 4)).jacobian;
#elif DUET_MUST_FAIL == 10
  std::cout << duet::sparse_hessian(f, x, Eigen::SparseMatrix<double>(4, 4)).hessian;
#else
  std::cout << duet::gradient(f, x.reshaped()).gradient << duet::hessian(f, x.reshaped()).hessian;
#endif
}
