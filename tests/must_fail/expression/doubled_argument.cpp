// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: two values are given for one symbol
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
  static_cast<void>(f(u = 0.3, w = w0, u = 0.4));
#elif DUET_MUST_FAIL == 2
  const double y = f(u = 0.3, w = w0, u = 0.4);
#elif DUET_MUST_FAIL == 3
  const auto [y, g] = gradient(f, wrt(u))(u = 0.3, w = w0, u = 0.4);
#else
  std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n";
#endif
}
