// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a function must return a scalar, an Eigen vector or matrix, a rotation

#include <duet/derivative/derivative.hpp>

#include <array>
#include <list>

int main() {
#ifdef DUET_MUST_FAIL
  const auto f = [](auto x) { return std::list{x, x}; };
#else
  const auto f = [](auto x) { return std::array{x, x}; };
#endif
  return duet::derivative(f, 2.0).derivative[0] == 1 ? 0 : 1;
}
