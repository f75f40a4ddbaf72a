// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// An arm of seven turning joints as a formula, with its spatial Jacobian.

#include <duet/expression/jacobian.hpp>
#include <duet/expression/symbol.hpp>

using namespace duet::expression;

Eigen::Matrix<double, 6, 7> twists(const Eigen::Matrix<double, 7, 1>& x) {
  constexpr symbol<"a"> a;
  constexpr symbol<"b"> b;
  constexpr symbol<"c"> c;
  constexpr symbol<"d"> d;
  constexpr symbol<"e"> e;
  constexpr symbol<"f"> f;
  constexpr symbol<"g"> g;
  const auto link = translation_along(axis::x, 0.1);
  const auto arm = screw(axis::z, a) * link * screw(axis::y, b) * link * screw(axis::z, c) * link *
                   screw(axis::y, d) * link * screw(axis::z, e) * link * screw(axis::y, f) * link *
                   screw(axis::z, g) * translation_along(axis::z, 0.3);
  return jacobian(arm, wrt(a, b, c, d, e, f, g), duet::frame::spatial)(
             a = x[0], b = x[1], c = x[2], d = x[3], e = x[4], f = x[5], g = x[6])
      .jacobian;
}
