// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
// expect: duet: gradients, Hessians, Jacobians and motions are functions
// within: 2
// forms: 2

#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/gradient.hpp>
#include <duet/expression/jacobian.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/text.hpp>

#include <iostream>
#include <string>

int main() {
  using namespace duet::expression;
  constexpr symbol<"u"> u;
  constexpr vector_symbol<"w"> w;
  const Eigen::Vector3d w0(1, 2, 3);
  const auto f = sin(u) * norm(w);
#if DUET_MUST_FAIL == 1
  std::cout << to_latex(gradient(f, wrt(w))) << "\n";
#elif DUET_MUST_FAIL == 2
  const std::string text = to_text(hessian(f, wrt(u)));
#else
  std::cout << to_latex(derivative(f, u)) << "\n";
#endif
}
