// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: formulas are called by name

#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/jacobian.hpp>
#include <duet/expression/symbol.hpp>

int main() {
  using namespace duet::expression;
  constexpr symbol<"u"> u;
  constexpr vector_symbol<"w"> w;
  const duet::vector3<double> w0(1, 2, 3);
  const auto f = sin(u) * norm(w);
#ifdef DUET_MUST_FAIL
  static_cast<void>(f(0.3, w0));
#else
  static_cast<void>(f(u = 0.3, w = w0));
#endif
}
