// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: constrained_mechanism: positions and parameters need a size known at compile time

#include <duet/kinematics/closed_loop.hpp>

int main() {
  const auto f = [](const auto& x, const auto& u) {
    return duet::make_vector(x[0] * x[1] - u, x[0] - x[1]);
  };
#ifdef DUET_MUST_FAIL
  const Eigen::VectorXd start = Eigen::Vector2d(1, 1);
#else
  const Eigen::Vector2d start(1, 1);
#endif
  const duet::constrained_mechanism loop(f, start, 1.0);
  return loop.position()[0] > .5 ? 0 : 1;
}
