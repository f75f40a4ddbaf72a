// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A formula written in C++ and its derivatives, printed as text and as LaTeX and evaluated.

#include "support/program.hpp"

#include <duet/duet.hpp>

#include <cstdio>
#include <iostream>

namespace {

using namespace duet::expression;

template <class F>
void print(const char* name, const F& f) {
  std::cout << "  " << name << " = " << to_text(f) << "\n    \\[ " << to_latex(f) << " \\]\n";
}

int run() {
  constexpr symbol<"t"> t;
  constexpr symbol<"omega"> omega;
  constexpr symbol<"delta"> delta;
  const auto x = exp(-delta * t) * cos(omega * t);
  const auto v = derivative(x, t);
  std::cout << "a damped oscillation\n";
  print("x", x);
  print("x'", v);
  print("dx/d delta", derivative(x, delta));

  constexpr symbol<"u"> u;
  constexpr quaternion_symbol<"q"> q;
  constexpr vector_symbol<"n"> n;
  constexpr vector_symbol<"p"> p;
  const auto rotating = q * rotation_about(n, u * u);
  std::cout << "a rotation about n, after q\n";
  print("Q", rotating);
  print("Q'", derivative(rotating, u));
  print("(QpQ*)'", derivative(rotate(rotating, p), u));

  const auto at = [&](const auto& f) { return f(t = 1.5, omega = 2, delta = 0.1); };
  const double by_duals =
      duet::derivative([&](auto s) { return x(t = s, omega = 2, delta = 0.1); }, 1.5).derivative;
  std::printf("x(1.5) = %.15f\nx'(1.5) = %.15f, by dual numbers %.15f\n", at(x), at(v), by_duals);
  return 0;
}

} // namespace

int main() { return example::run_program("formula_to_latex", run); }
