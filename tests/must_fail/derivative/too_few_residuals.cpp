// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: implicit_function: F must return as many residuals as the unknown has coordinates

#include <duet/derivative/implicit_function.hpp>

int main() {
#ifdef DUET_MUST_FAIL
  const auto f = [](const auto& x, const auto& p) { return duet::make_vector(x[0] * x[1] - p); };
#else
  const auto f = [](const auto& x, const auto& p) {
    return duet::make_vector(x[0] * x[1] - p, x[0] - x[1]);
  };
#endif
  return duet::implicit_solution(f, Eigen::Vector2d(1, 1), 4.0)[0] > 1.5 ? 0 : 1;
}
