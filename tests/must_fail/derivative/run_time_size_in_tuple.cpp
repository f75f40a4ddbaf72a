// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: with a frame, a vector of run-time size must be the only argument

#include <duet/derivative/tangent_coordinates.hpp>

int main() {
  const auto f = [](const auto& x, const auto& k) { return duet::make_vector(x[0] * k, x[1]); };
#ifdef DUET_MUST_FAIL
  const Eigen::VectorXd x = Eigen::Vector2d(1, 2);
#else
  const Eigen::Vector2d x(1, 2);
#endif
  return int(duet::jacobian(f, std::tuple(x, 2.0), duet::frame::body).jacobian.rows()) - 2;
}
