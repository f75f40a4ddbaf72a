// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: .*std::tuple\(a, b\)
// within: 2
// forms: 5

#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>

#include <Eigen/Core>

#include <iostream>
#include <tuple>

int main() {
  const auto f = [](const auto& a, const auto& b) { return a * b; };
  const auto g = [](const auto& a, const auto& b) { return a[0] * b; };
  const Eigen::Vector3d v(1, 2, 3);
#if DUET_MUST_FAIL == 1
  std::cout << duet::gradient(f, 1.0, 2.0).gradient << "\n";
#elif DUET_MUST_FAIL == 2
  std::cout << duet::gradient(g, v, 2.0).gradient << "\n";
#elif DUET_MUST_FAIL == 3
  const auto [y, j] = duet::jacobian(g, v, 2.0);
#elif DUET_MUST_FAIL == 4
  std::cout << duet::hessian(f, 1.0, 2.0).hessian << "\n";
#elif DUET_MUST_FAIL == 5
  const double slope = duet::derivative(f, 1.0, 2.0).derivative;
#else
  std::cout << duet::gradient(f, std::tuple(1.0, 2.0)).gradient
            << duet::gradient(g, std::tuple(v, 2.0)).gradient
            << duet::hessian(f, std::tuple(1.0, 2.0)).hessian << "\n";
#endif
}
