// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Derivatives of ordinary functions: any template, or lambda with auto parameters, can be
// differentiated.

#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>

#include <array>
#include <cmath>
#include <iostream>

int main() {
  using std::cos, std::exp, std::sin;

  // A function of one number. The constant is a double, so exp and sin may be std's or duet's: no
  // prefix.
  const auto f = [](auto x) { return exp(-x) * sin(3 * x); };
  const auto [y, slope] = duet::derivative(f, 0.5);
  std::cout << "f = " << y << ", f' = " << slope << "\n";
  for (const double d : duet::derivatives<4>(f, 0.5)) {
    std::cout << d << " ";
  }
  std::cout << "  f and four derivatives\n";

  // A function of several numbers.
  const auto g = [](const auto& x) { return x[0] * x[0] * cos(x[1]) + x[2]; };
  const Eigen::Vector3d x(1, 2, 3);
  std::cout << "gradient " << duet::gradient(g, x).gradient.transpose() << "\n";
  std::cout << "Hessian\n" << duet::hessian(g, x).hessian << "\n";

  // Several results. The function returns an object that owns its data: an array, or .eval().
  const auto polar = [](const auto& p) { return std::array{p[0] * cos(p[1]), p[0] * sin(p[1])}; };
  std::cout << "Jacobian\n" << duet::jacobian(polar, Eigen::Vector2d(2, 0.5)).jacobian << "\n";
}
