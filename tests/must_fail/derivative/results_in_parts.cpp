// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: (derivative|gradient|jacobian|hessian) returns value

#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>

#include <Eigen/Core>

int main() {
  const auto f = [](const auto& x) { return x[0] * x[1]; };
  const auto g = [](const auto& x) { return x; };
  const Eigen::Vector2d x(1, 2);
#ifdef DUET_MUST_FAIL
  const double slope = duet::derivative(g, 1.0);         // mistake
  const Eigen::VectorXd gradient = duet::gradient(f, x); // mistake
  const Eigen::MatrixXd jacobian = duet::jacobian(g, x); // mistake
  const Eigen::Matrix2d hessian = duet::hessian(f, x);   // mistake
#else
  const auto [y, slope] = duet::derivative(g, 1.0);
  const Eigen::VectorXd gradient = duet::gradient(f, x).gradient;
  const Eigen::MatrixXd jacobian = duet::jacobian(g, x).jacobian;
  const auto [z, same_gradient, hessian] = duet::hessian(f, x);
  return y == slope && gradient == same_gradient && jacobian == hessian ? 1 : 0;
#endif
}
