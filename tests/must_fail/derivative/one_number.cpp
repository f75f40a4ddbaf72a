// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: .* with respect to (one number|a vector)
// within: 2
// forms: 4

#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>

#include <Eigen/Core>

#include <iostream>

int main() {
  const auto f = [](const auto& x) { return x[0] * x[1]; };
  const auto g = [](const auto& x) { return x * x; };
  const Eigen::Vector3d v(1, 2, 3);
#if DUET_MUST_FAIL == 1
  std::cout << duet::derivative(f, v).value << "\n";
#elif DUET_MUST_FAIL == 2
  std::cout << duet::gradient(g, 2.0).gradient << "\n";
#elif DUET_MUST_FAIL == 3
  const auto [y, j] = duet::jacobian(g, 2);
#elif DUET_MUST_FAIL == 4
  std::cout << duet::hessian(g, 2.0).hessian << "\n";
#else
  std::cout << duet::gradient(f, v).gradient << duet::derivative(g, 2.0).value << "\n";
#endif
}
