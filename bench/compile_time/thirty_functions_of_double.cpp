// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// What thirty_functions_of_dual.cpp has, of double.

#include <duet/dual/math.hpp>

#include <cmath>
#include <utility>

namespace {

template <int I, class S>
S function(const S& x, const S& y) {
  using std::cos, std::exp, std::sin, std::sqrt;
  const S a = x * y + I;
  const S b = sin(a) * exp(-x * x) / (1 + y * y);
  return a > b ? a * b + sqrt(1 + b * b) : cos(b) - a / I;
}

template <class S, int... I>
S sum(const S& x, const S& y, std::integer_sequence<int, I...>) {
  return (function<I + 1>(x, y) + ...);
}

} // namespace

double thirty_functions(const double& x, const double& y) {
  return sum(x, y, std::make_integer_sequence<int, 30>());
}
