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

template <int Steps, class X, class Y>
auto nested(const X& x, const Y& y) {
  using std::sin;
  if constexpr (Steps == 0) {
    return x;
  } else {
    return nested<Steps - 1>(sin(x + y) * y, y);
  }
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

TEST_CASE("a formula of more operations than first fit in the memory of the compiler") {
  constexpr symbol<"x"> x;
  constexpr symbol<"y"> y;
  constexpr int steps = 60; // of three operations
  const auto f = nested<steps>(x, y);
  const Eigen::Vector2d at(0.4, 1.3);
  const auto expected = duet::hessian([](const auto& z) { return nested<steps>(z[0], z[1]); }, at);
  CHECK(f(x = at[0], y = at[1]) == doctest::Approx(expected.value).epsilon(1e-14));
  const auto all = hessian(f, wrt(x, y))(x = at[0], y = at[1]);
  CHECK(all.value == f(x = at[0], y = at[1]));
  CHECK((all.gradient - expected.gradient).norm() < 1e-13 * expected.gradient.norm());
  CHECK((all.hessian - expected.hessian).norm() < 1e-13 * expected.hessian.norm());
}

TEST_CASE("real parts of a formula stay real where other arguments are dual") {
  using number = duet::dual<double>;
  constexpr symbol<"a"> a;
  constexpr symbol<"b"> b;
  constexpr vector_symbol<"v"> v;
  const auto real = sin(a) * norm(v);
  const Eigen::Vector3d w(0.3, -0.4, 0.7);
  static_assert(std::is_same_v<decltype((real + c<0> * b)(a = 0.3, b = number(1), v = w)), double>);
  const number y = (real * b)(a = 0.3, b = number(0.7, 1), v = w);
  CHECK(y.value() == real(a = 0.3, v = w) * 0.7);
  CHECK(y.epsilon() == real(a = 0.3, v = w));
}

TEST_CASE("powers that only derivatives contain") {
  constexpr symbol<"x"> x;
  constexpr symbol<"z"> z;
  const auto [y, g, h] = hessian((x * x * z) * x + (x * z) * x, wrt(z, x))(x = 3.0, z = 2.0);
  CHECK(y == 72);
  CHECK(g == Eigen::Vector2d(36, 66));
  CHECK(h == Eigen::Matrix2d{{0, 33}, {33, 40}});
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
