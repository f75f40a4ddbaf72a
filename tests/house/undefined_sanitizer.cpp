// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Formulas of all kinds, compiled with -fsanitize=undefined: with its checks some addresses and
// divisions are no longer constants.

#include <duet/expression/condition.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/gradient.hpp>
#include <duet/expression/motion.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/symbol.hpp>

int main() {
  using namespace duet::expression;
  constexpr symbol<"u"> u;
  constexpr symbol<"v"> v;
  const auto f = exp(-u) * sin(v * u * u) / (1 + u * u) + select(u < v, u, v);
  const double slope = derivative(f, u)(u = .3, v = 2);
  const auto g = gradient(f, wrt(u, v))(u = .3, v = 2);
  const auto arm = screw(axis::z, u) * translation_along(axis::x, v) * screw(axis::y, u);
  const auto m = motion(arm, u, duet::frame::body)(u = .3, v = 2);
  return slope == g.gradient[0] && m.velocity[5] == m.velocity[5] ? 0 : 1;
}
