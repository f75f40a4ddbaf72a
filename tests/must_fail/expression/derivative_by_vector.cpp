// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: derivative\(f, u\) is by a scalar symbol
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
  static_cast<void>(derivative(f, w));
#elif DUET_MUST_FAIL == 2
  std::cout << derivative(f, w)(u = 0.3, w = w0) << "\n";
#else
  std::cout << derivative(f, u)(u = 0.3, w = w0) << gradient(f, wrt(w))(u = 0.3, w = w0).value;
#endif
}
