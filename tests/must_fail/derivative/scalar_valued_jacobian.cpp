// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: jacobian needs a function that returns a vector

#include <duet/derivative/jacobian.hpp>

int main() {
#ifdef DUET_MUST_FAIL
  const auto f = [](const auto& x) { return x[0] * x[1]; };
#else
  const auto f = [](const auto& x) { return duet::make_vector(x[0] * x[1], x[1]); };
#endif
  return duet::jacobian(f, Eigen::Vector2d(1, 2)).value[0] == 2 ? 0 : 1;
}
