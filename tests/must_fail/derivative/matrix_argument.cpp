// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: differentiate with respect to a vector, .*f, x.reshaped\(\)

#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>

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
#else
  std::cout << duet::gradient(f, x.reshaped()).gradient << duet::hessian(f, x.reshaped()).hessian;
#endif
}
