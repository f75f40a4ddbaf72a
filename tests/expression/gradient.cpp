// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/duet.hpp>

namespace test_expression_gradient {
namespace {

using namespace duet::expression;

template <class X>
auto formula_of(const X& a, const X& b, const X& d) {
  using std::cos;
  using std::exp;
  using std::sin;
  return sin(a * b) * exp(-d / (1 + a * a)) + b * cos(d) * d - a / b;
}

TEST_CASE("gradient, Hessian and directional derivative against dual numbers") {
  constexpr symbol<"a"> a;
  constexpr symbol<"b"> b;
  constexpr symbol<"d"> d;
  const auto f = sin(a * b) * exp(-d / (1 + a * a)) + b * cos(d) * d - a / b;
  const auto generic = [](const auto& x) { return formula_of(x[0], x[1], x[2]); };
  const Eigen::Vector3d at(0.7, -1.3, 0.4);
  const auto expected = duet::hessian(generic, at);

  const auto [y, g] = gradient(f, wrt(a, b, d))(a = at[0], b = at[1], d = at[2]);
  CHECK(y == doctest::Approx(expected.value).epsilon(1e-15));
  CHECK((g - expected.gradient).norm() < 1e-15 * (1 + g.norm()));

  const auto all = hessian(f, wrt(a, b, d))(d = at[2], a = at[0], b = at[1]);
  CHECK(all.value == y);
  CHECK((all.gradient - g).norm() == 0);
  CHECK((all.hessian - expected.hessian).norm() < 1e-14);

  const auto [z, part] = gradient(f, wrt(d, a))(a = at[0], b = at[1], d = at[2]);
  CHECK(z == y);
  CHECK(part == Eigen::Vector2d(g[2], g[0]));

  constexpr symbol<"s"> s;
  const auto along_s = directional_derivative(f, along(a, s), along(d, 2.0 * s));
  CHECK(along_s(a = at[0], b = at[1], d = at[2], s = 0.5) ==
        doctest::Approx(0.5 * g[0] + g[2]).epsilon(1e-14));

  // Over duals, the gradient has a derivative: a row of the Hessian.
  const auto by_b = duet::derivative(
      [&](auto t) { return gradient(f, wrt(a, b, d))(a = at[0], b = t, d = at[2]).gradient; },
      at[1]);
  CHECK((by_b.derivative - expected.hessian.col(1)).norm() < 1e-14);
}

TEST_CASE("zeros are known") {
  constexpr symbol<"a"> a;
  constexpr symbol<"b"> b;
  const auto [y, g] = gradient(a * a + c<0> * b, wrt(a, b))(a = 3.0, b = std::nan(""));
  CHECK(y == 9);
  CHECK(g == Eigen::Vector2d(6, 0));
  const auto H = hessian(a * a + sqrt(b), wrt(a, b))(a = 3.0, b = 0.0).hessian;
  CHECK(H(0, 1) == 0); // no 0 · ∞
}

} // namespace
} // namespace test_expression_gradient
