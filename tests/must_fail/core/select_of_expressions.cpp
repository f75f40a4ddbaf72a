// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a function returns an expression of Eigen

#include <duet/core/select.hpp>

#include <Eigen/Core>

int main() {
  const Eigen::Vector2d a(1, 2);
#ifdef DUET_MUST_FAIL
  const auto minus = [&] { return -a; };
#else
  const auto minus = [&] { return (-a).eval(); };
#endif
  return duet::select(true, minus, minus)[0] == -1 ? 0 : 1; // mistake
}
