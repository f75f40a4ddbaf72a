// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a function returns an expression of Eigen

#include <duet/kinematics/closed_loop.hpp>

int main() {
  const Eigen::Vector2d start(1, 1);
#ifdef DUET_MUST_FAIL
  const auto closure = [](const auto& x, const auto& u) { return x * u - x; };
#else
  const auto closure = [](const auto& x, const auto& u) { return (x * u - x).eval(); };
#endif
  const duet::constrained_mechanism loop(closure, start, 2.0); // mistake
  return loop(2.0)[0] == 0 ? 0 : 1;
}
