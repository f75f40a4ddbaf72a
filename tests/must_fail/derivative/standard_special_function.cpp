// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: std::[a-z_0-9]* does not accept numbers with derivatives or formulas
// within: 5
// forms: 2

#include <duet/derivative/derivative.hpp>
#include <duet/interop/special_functions.hpp>

#include <cmath>
#include <iostream>

int main() {
#if DUET_MUST_FAIL == 1
  std::cout << duet::derivative([](auto x) { return std::cyl_bessel_j(0, x); }, 0.3).derivative;
#elif DUET_MUST_FAIL == 2
  const auto [y, dy] = duet::derivative([](auto x) { return std::beta(x, x); }, 0.3);
#else
  using std::beta;
  std::cout << duet::derivative([](auto x) { return cyl_bessel_j(0, x) + beta(x, x); }, 0.3).value;
#endif
}
