// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: gradient needs a function that returns a scalar

#include <duet/derivative/gradient.hpp>

int main() {
#ifdef DUET_MUST_FAIL
  const auto f = [](const auto& x) { return duet::make_vector(x[0], x[1]); };
#else
  const auto f = [](const auto& x) { return x[0] * x[1]; };
#endif
  return duet::gradient(f, Eigen::Vector2d(1, 2)).value == 2 ? 0 : 1;
}
