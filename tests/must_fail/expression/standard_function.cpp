// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: std::[a-z_0-9]* does not accept numbers with derivatives or formulas
// within: 2
// forms: 5

#include <duet/expression/functions_of_many.hpp>
#include <duet/expression/special_functions.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/text.hpp>

#include <cmath>
#include <iostream>

int main() {
  using namespace duet::expression;
  constexpr symbol<"u"> u;
#if DUET_MUST_FAIL == 1
  const auto g = std::sin(u);
#elif DUET_MUST_FAIL == 2
  std::cout << to_text(std::sin(u) * u) << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << to_text(std::pow(u, 2)) << "\n";
#elif DUET_MUST_FAIL == 4
  const auto g = std::atan2(u, 2 * u);
#elif DUET_MUST_FAIL == 5
  const auto g = std::cyl_bessel_j(0, u);
#else
  using std::sin;
  std::cout << to_text(sin(u) * pow(u, 2) * atan2(u, 2 * u)) << "\n";
#endif
}
