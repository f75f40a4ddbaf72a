// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: derivative: the function must take any scalar

#include <duet/derivative/derivative.hpp>

#include <concepts>

int main() {
#ifdef DUET_MUST_FAIL
  const auto square = [](std::floating_point auto x) { return x * x; };
#else
  const auto square = [](auto x) { return x * x; };
#endif
  return duet::derivative(square, 2.0).derivative == 4 ? 0 : 1;
}
