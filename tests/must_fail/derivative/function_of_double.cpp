// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: [a-z_]*: the function must take any scalar
// within: 5
// forms: 12

#include <duet/derivative/nonlinear_least_squares.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/quaternion/exponential.hpp>

#include <Eigen/Core>

#include <iostream>
#include <vector>

double cube(double x) { return x * x * x; }

int main() {
  const Eigen::Vector3d x(1, 2, 3);
#if DUET_MUST_FAIL == 1
  const auto square = [](double a) { return a * a; };
  const auto slope = duet::derivative(square, 2.0);
#elif DUET_MUST_FAIL == 2
  std::cout << duet::derivative([](double a) { return a * a; }, 2.0).derivative << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << duet::derivatives<2>(cube, 2.0)[1] << "\n";
#elif DUET_MUST_FAIL == 4
  std::cout << duet::gradient([](const Eigen::Vector3d& a) { return a[0]; }, x).gradient << "\n";
#elif DUET_MUST_FAIL == 5
  std::cout << duet::gradient([](double a) { return a; }, x).gradient << "\n";
#elif DUET_MUST_FAIL == 6
  const auto scaled = [](const Eigen::Vector3d& a) mutable { return Eigen::Vector3d(2 * a); };
  std::cout << duet::jacobian(scaled, x).jacobian << "\n";
#elif DUET_MUST_FAIL == 7
  const auto sum = [](const std::vector<double>& a) { return a[0] + a[1]; };
  std::cout << duet::hessian(sum, std::vector{1., 2.}).hessian << "\n";
#elif DUET_MUST_FAIL == 8
  const auto rotated = [](const duet::quaternion<double>& q) { return q; };
  std::cout << duet::jacobian(rotated, duet::quaternion<double>(1), duet::frame::body).jacobian;
#elif DUET_MUST_FAIL == 9
  const auto [y, slope] = duet::derivative([](double a) { return a * a; }, 2.0);
#elif DUET_MUST_FAIL == 10
  const auto [y, slopes] = duet::gradient([](const Eigen::Vector3d& a) { return a[0]; }, x);
#elif DUET_MUST_FAIL == 11
  const Eigen::Vector3d slopes =
      duet::jacobian([](const Eigen::Vector3d& a) { return a; }, x).jacobian.col(0);
#elif DUET_MUST_FAIL == 12
  std::cout << duet::nonlinear_least_squares([](double a) { return a - 1; }, 2.0).estimate;
#else
  const auto square = [](auto a) { return a * a; };
  const auto scaled = [](const auto& a) { return (2 * a).eval(); };
  std::cout << duet::derivative(square, 2.0).derivative << duet::derivatives<2>(square, 2.)[1]
            << duet::jacobian(scaled, x).jacobian << "\n";
#endif
}
