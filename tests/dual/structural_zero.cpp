// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/dual/math.hpp>

// Singular points: values are never damaged, constants never poison gradients, and a genuine
// singularity gives the IEEE answer.

namespace test_dual_structural_zero {
namespace {

using duet::dual, duet::taylor;

struct outer_tag;

constexpr double infinity = std::numeric_limits<double>::infinity();

using D = dual<double>;
using pair = dual<double, 2>;

D variable(double x) { return D::variable(x); }
pair first(double x) { return pair::variable(x, 0); }

TEST_CASE("structural zero: power with constants") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), log2 = std::log(2.0);
  struct row {
    double base;
    int exponent;
    double value, by_base, by_exponent;
  };
  for (const row& r : {row{0, 0, 1, 0, -infinity},
                       {0, 1, 0, 1, 0},
                       {0, 2, 0, 0, 0},
                       {0, 3, 0, 0, 0},
                       {2, 3, 8, 12, 8 * log2},
                       {-2, 2, 4, -4, nan},
                       {-2, -1, -0.5, -0.25, nan},
                       {1, 0, 1, 0, 0}}) {
    CAPTURE(r.base);
    CAPTURE(r.exponent);
    const D x = variable(r.base);
    for (const D& y : {pow(x, r.exponent), pow(x, double(r.exponent)), pow(x, D(r.exponent))}) {
      CHECK(y.value() == r.value);
      CHECK(y.epsilon() == r.by_base);
    }
    const D z = pow(int(r.base), variable(r.exponent));
    CHECK(z.value() == r.value);
    CHECK((z.epsilon() == r.by_exponent || (std::isnan(z.epsilon()) && std::isnan(r.by_exponent))));
    CHECK(pow(int(r.base), D(r.exponent)).epsilon() == 0);
  }
  CHECK(pow(variable(0), -0.).epsilon() == 0);
  CHECK(pow(variable(infinity), 0.).epsilon() == 0);
  CHECK(pow(1, variable(infinity)).epsilon() == 0);
  CHECK(pow(first(0), .5).partial(1) == 0);
}

TEST_CASE("structural zero: higher derivatives of powers at 0") {
  const auto x = taylor<double, 4>::variable(0);
  const auto cube = pow(x, 3);
  CHECK(cube.coefficient(2) == 0);
  CHECK(cube.coefficient(3) == 1);
  CHECK(cube.coefficient(4) == 0);
  CHECK(pow(x, 0).coefficient(4) == 0);
  CHECK(pow(x, 1).coefficient(1) == 1);
  CHECK(pow(x, 1).coefficient(2) == 0);
  using nested = dual<D, 1, outer_tag>;
  const auto square = pow(nested(D(0, 1), 1), 2);
  CHECK(square.epsilon().epsilon() == 2);
  // ∂²/∂x∂p x^p = 1/x at p = 0, though ∂/∂x vanishes there.
  const auto mixed = pow(nested(D(4, 1)), nested(D(0), 1));
  CHECK(mixed.value().epsilon() == 0);
  CHECK(mixed.epsilon().value() == std::log(4.0));
  CHECK(mixed.epsilon().epsilon() == 0.25);
  CHECK(pow(nested(D(4), 1), nested(D(0, 1))).epsilon().epsilon() == 0.25);
  // 0^p log 0 is flat for p > 1 in the first derivative with respect to the base, singular at p
  // = 1.
  CHECK(pow(nested(D(0, 1)), nested(D(2), 1)).epsilon().epsilon() == 0);
  CHECK(pow(nested(D(0, 1)), nested(D(1), 1)).epsilon().value() == 0);
  CHECK_FALSE(std::isfinite(pow(nested(D(0, 1)), nested(D(1), 1)).epsilon().epsilon()));
}

TEST_CASE("structural zero: hypot of three and atan2 at the origin") {
  CHECK(hypot(D(0), D(0), D(0)).epsilon() == 0);
  CHECK(hypot(variable(0), D(0), 2).epsilon() == 0);
  CHECK(atan2(pair(0), pair(0)).partial(1) == 0);
}

TEST_CASE("structural zero: saturated functions are flat to every order") {
  const auto x = taylor<double, 4>::variable(800);
  for (int k = 1; k <= 4; ++k) {
    CHECK(tanh(x).coefficient(k) == 0);
    CHECK(tanh(-x).coefficient(k) == 0);
    CHECK(erf(x).coefficient(k) == 0);
    CHECK(exp(-x).coefficient(k) == 0);
    CHECK(atan(taylor<double, 4>::variable(1e300)).coefficient(k) == 0);
  }
  CHECK(tanh(variable(800)).value() == 1);
  const auto constant = taylor<double, 4>(800);
  for (int k = 1; k <= 4; ++k) {
    CHECK(sinh(constant).coefficient(k) == 0);
    CHECK(cosh(constant).coefficient(k) == 0);
    CHECK(exp(constant).coefficient(k) == 0);
    CHECK(sin(taylor<double, 4>(infinity)).coefficient(k) == 0);
  }
}

TEST_CASE("structural zero: parts that do not depend on the inner variable stay finite") {
  using nested = dual<D, 2, outer_tag>;
  // x = 0 varies in the outer level, y = 3 in the inner one: ∂²/∂x∂y (√x + y) = 0.
  const nested x = nested::variable(D(0), 0);
  const nested y(D(3, 1));
  const nested z = sqrt(x) + y;
  CHECK(z.value().epsilon() == 1);
  CHECK(z.partial(0).value() == infinity);
  CHECK(z.partial(0).epsilon() == 0);
  CHECK(z.partial(1) == 0);
  CHECK(z.partial(1).epsilon() == 0);
}

TEST_CASE("structural zero: in quotients no nesting level affects another") {
  using nested = dual<D, 1, outer_tag>;
  const nested x = nested::variable(D(0)); // varies in the outer level only
  for (const nested& y : {1 / x, nested(1) / x, x / x, 0 / x, infinity / x, 1 / (x * 2)}) {
    CHECK(y.value().epsilon() == 0);
    CHECK(y.epsilon().epsilon() == 0);
  }
  CHECK((1 / x).epsilon().value() == -infinity);
  // Second derivatives are those of the series.
  const nested both(variable(0), 1);
  CHECK((1 / both).epsilon().epsilon() == infinity);
  CHECK((nested(1) / both).epsilon().epsilon() == infinity);
  CHECK((1 / taylor<double, 2>::variable(0)).derivative(2) == infinity);
}

TEST_CASE("structural zero: arithmetic constants keep infinite values at every nesting level") {
  using nested = dual<D, 2, outer_tag>;
  const nested x(variable(infinity));
  for (const nested& y : {x * 2, 2 * x, x / 2, x + 1, 1 - x, -x}) {
    CHECK(std::isfinite(y.value().epsilon()));
    CHECK(y.partial(1).value() == 0);
    CHECK(y.partial(1).epsilon() == 0);
  }
  CHECK((nested(infinity) * 2).value().epsilon() == 0);
  CHECK((taylor<D, 2, outer_tag>(infinity) * 2).value().epsilon() == 0);
}

/// x is the last of N variables; the zeros of the others must survive its singularity.
template <int N>
void check_last_of() {
  using row = dual<double, N>;
  const auto last = [](double x) { return row::variable(x, N - 1); };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto check = [](const row& y, double value, double slope) {
    const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    CHECK(same(y.value(), value));
    for (int i = 0; i < N - 1; ++i) {
      CHECK(y.partial(i) == 0);
    }
    CHECK(same(y.partial(N - 1), slope));
  };
  check(sqrt(last(0)), 0, infinity);
  check(sqrt(last(4)), 2, 0.25);
  check(exp(last(1000)), infinity, infinity);
  check(sin(last(infinity)), nan, nan);
  check(cos(last(nan)), nan, nan);
  check(sin(last(0)), 0, 1);
  check(cos(last(0)), 1, 0);
  check(1.0 / last(0), infinity, -infinity);
  check(row(1.0) / last(0), infinity, -infinity);
  check(row(1.0) / last(2), 0.5, -0.25);
  check(last(1) / 0.0, infinity, infinity);
  check(atan2(last(0), row(0.0)), 0, nan);
  check(sqrt(last(0) * last(0)), 0, 0);
}

TEST_CASE("structural zero: rows of any length keep their zeros") {
  check_last_of<2>();
  check_last_of<5>();
  check_last_of<9>();
  check_last_of<17>();
  check_last_of<70>();
}

} // namespace
} // namespace test_dual_structural_zero
