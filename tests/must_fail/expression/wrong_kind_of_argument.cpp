// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a symbol is given a value of another kind
// within: 2
// forms: 2

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
  static_cast<void>(f(u = w0, w = w0));
#elif DUET_MUST_FAIL == 2
  std::cout << f(u = 0.3, w = 0.4) << "\n";
#else
  std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n";
#endif
}
