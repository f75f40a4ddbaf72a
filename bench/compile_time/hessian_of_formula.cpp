// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A typed formula of 20 operations in six symbols, with its gradient and Hessian.

#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/gradient.hpp>
#include <duet/expression/symbol.hpp>

using namespace duet::expression;

Eigen::Matrix<double, 6, 6> curvature(const Eigen::Matrix<double, 6, 1>& x) {
  constexpr symbol<"a"> a;
  constexpr symbol<"b"> b;
  constexpr symbol<"c"> c;
  constexpr symbol<"d"> d;
  constexpr symbol<"e"> e;
  constexpr symbol<"f"> f;
  const auto y = sin(a * b) + exp(-c * d) * cos(e * f + a) / (1 + b * b) +
                 sqrt(c * c + d * d) * log(e + f) - a * d * f;
  return hessian(y, wrt(a, b, c, d, e, f))(a = x[0], b = x[1], c = x[2], d = x[3], e = x[4],
                                           f = x[5])
      .hessian;
}
