// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a value is given for a symbol that the formula does not have
// within: 2
// forms: 3

#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/gradient.hpp>
#include <duet/expression/jacobian.hpp>
#include <duet/expression/symbol.hpp>

#include <iostream>

int main() {
  using namespace duet::expression;
  constexpr symbol<"u"> u;
  constexpr vector_symbol<"w"> w;
  const Eigen::Vector3d w0(1, 2, 3);
  const auto f = sin(u) * norm(w);
#if DUET_MUST_FAIL == 1
  static_cast<void>(f(u = 0.3, w = w0, symbol<"x">{} = 1.0));
#elif DUET_MUST_FAIL == 2
  std::cout << sin(u)(u = 0.3, w = w0) << "\n";
#elif DUET_MUST_FAIL == 3
  std::cout << gradient(sin(u), wrt(u))(u = 0.3, w = w0).gradient << "\n";
#else
  std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n";
#endif
}
