// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: a symbol of the formula has no value; say f\(u = 0.3, ...\) with all of them
// within: 2
// forms: 6

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
  static_cast<void>(f(u = 0.3));
#elif DUET_MUST_FAIL == 2
  std::cout << f(u = 0.3) << "\n";
#elif DUET_MUST_FAIL == 3
  const double y = f();
#elif DUET_MUST_FAIL == 4
  const auto [y, g] = gradient(f, wrt(u))(u = 0.3);
#elif DUET_MUST_FAIL == 5
  std::cout << hessian(f, wrt(w))(w = w0).hessian << "\n";
#elif DUET_MUST_FAIL == 6
  const Eigen::MatrixXd j = jacobian(u * w, wrt(u))(w = w0).jacobian;
#else
  std::cout << f(u = 0.3, w = w0) << gradient(f, wrt(u))(u = 0.3, w = w0).gradient << "\n";
#endif
}
