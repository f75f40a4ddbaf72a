// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: (derivative\(f, u\) is by one|wrt\(u, w\) takes|by which) symbol
// within: 2
// forms: 7

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
  std::cout << derivative(f, sin(u))(u = 0.3, w = w0) << "\n";
#elif DUET_MUST_FAIL == 2
  const auto g = derivative(f, 0.3);
#elif DUET_MUST_FAIL == 3
  const auto g = derivative(f);
#elif DUET_MUST_FAIL == 4
  const auto g = gradient(f, wrt(sin(u)));
#elif DUET_MUST_FAIL == 5
  std::cout << gradient(f, u)(u = 0.3, w = w0).gradient << "\n";
#elif DUET_MUST_FAIL == 6
  const auto [y, g, h] = hessian(f, u, w)(u = 0.3, w = w0);
#elif DUET_MUST_FAIL == 7
  const auto j = jacobian(u * w, u);
#else
  std::cout << derivative(f, u)(u = 0.3, w = w0)
            << jacobian(u * w, wrt(u))(u = 0.3, w = w0).jacobian;
#endif
}
