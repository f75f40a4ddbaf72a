// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: std::[a-z0-9]* does not accept numbers with derivatives
// within: 5
// forms: 6

#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <iostream>

int main() {
  const Eigen::Vector3d x(1, 2, 3);
  using duet::derivative;
#if DUET_MUST_FAIL == 1
  const auto sine = [](auto a) { return std::sin(a); };
  const auto slope = derivative(sine, 0.3);
#elif DUET_MUST_FAIL == 2
  std::cout << derivative([](auto a) { return std::sin(a); }, 0.3).derivative << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << derivative([](auto a) { return std::pow(a, 3) * std::exp(a); }, 0.3).value << "\n";
#elif DUET_MUST_FAIL == 4
  std::cout << duet::derivatives<3>([](auto a) { return std::sqrt(a); }, 0.3)[1] << "\n";
#elif DUET_MUST_FAIL == 5
  std::cout << duet::gradient([](const auto& a) { return std::hypot(a[0], a[1]); }, x).gradient;
#elif DUET_MUST_FAIL == 6
  const auto angles = [](const auto& a) { return std::array{std::atan2(a[0], a[1])}; };
  std::cout << duet::jacobian(angles, x).jacobian << "\n";
#else
  using std::sin;
  std::cout << derivative([](auto a) { return sin(a) + exp(a) * std::exp(2); }, 0.3).derivative;
  std::cout << duet::gradient([](const auto& a) { return hypot(a[0], a[1]); }, x).gradient;
#endif
}
