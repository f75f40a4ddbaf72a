// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

#include <duet/duet.hpp>

namespace test_expression_scalars {
namespace {

using namespace duet::expression;
using duet_test::real_50;
using duet_test::ulps;

constexpr symbol<"x"> x;
constexpr symbol<"y"> y;

TEST_CASE("arithmetic and choices: expression derivatives are dual derivatives") {
  const auto function = [](const auto& t) {
    using std::pow;
    return t / (1 + t) - (2 - t) * -t / t + 3 / t + pow(t, t);
  };
  const auto f = function(x);
  const auto first = derivative(f, x);
  const auto second = derivative(first, x);
  for (const double at : {0.7, 1.9}) {
    const auto expected = duet::derivatives<2>(function, at);
    CHECK(f(x = at) == doctest::Approx(expected[0]).epsilon(1e-15));
    CHECK(first(x = at) == doctest::Approx(expected[1]).epsilon(4e-15));
    CHECK(second(x = at) == doctest::Approx(expected[2]).epsilon(2e-14));
  }
  CHECK(derivative(lerp(x, y, x * y), x)(x = 0.3, y = 0.4) ==
        doctest::Approx(1 - 0.12 + (0.4 - 0.3) * 0.4));
  CHECK(derivative(fma(x, x, y), x)(x = 3.0, y = 1.0) == 6);
  const auto choice = select(x < y, x * x, sqrt(x - y));
  CHECK(derivative(choice, x)(x = 3.0, y = 4.0) == 6);
  CHECK(derivative(choice, x)(x = 3.0, y = 2.0) == 0.5);
  CHECK(derivative(max(x, c<2>), x)(x = 1.0) == 0);
  CHECK(derivative(min(x, 2.0), x)(x = 1.0) == 1);
}

TEST_CASE("products are finite wherever the written order is") {
  CHECK((y * x * x)(x = 1e-200, y = 1e300) == 1e300 * 1e-200 * 1e-200);
  CHECK((0.5_c * x * y)(x = 1.5e308, y = 2.0) == 1.5e308);
  CHECK((x * y * x)(x = 1e-200, y = 1e300) == 1e-100);
}

TEST_CASE("whole powers up to 16: values and slopes within 4 units of the last place") {
  double worst_value = 0, worst_slope = 0;
  const auto check = [&]<int N>(std::integral_constant<int, N>) {
    const auto power = pow(x, c<N>);
    const auto slope = derivative(power, x);
    for (int i = 0; i < 500; ++i) {
      const double at = 1 + i / 499.;
      const real_50 true_value = pow(real_50(at), N);
      const real_50 true_slope = N * pow(real_50(at), N - 1);
      worst_value = std::max(worst_value, ulps(power(x = at), true_value, true_value));
      worst_slope = std::max(worst_slope, ulps(slope(x = at), true_slope, abs(true_slope)));
    }
  };
  [&]<int... N>(std::integer_sequence<int, N...>) {
    (check(std::integral_constant<int, N + 1>{}), ...);
    (check(std::integral_constant<int, -N - 1>{}), ...);
  }
  (std::make_integer_sequence<int, 16>{});
  CHECK(worst_value <= 4);
  CHECK(worst_slope <= 4);
}

TEST_CASE("the derivative of sqrt(x^2) at 0 is that of dual numbers") {
  const auto function = [](const auto& t) {
    using std::sqrt;
    return sqrt(t * t);
  };
  const double by_duals = duet::derivative(function, 0.0).derivative;
  const double by_formula = derivative(function(x), x)(x = 0.0);
  CAPTURE(by_duals);
  CAPTURE(by_formula);
  CHECK(by_formula == by_duals);
}

TEST_CASE("second derivatives have the signs of slopes and rates that are negative") {
  // d2/dx2 sqrt(1 - x^2) = -(1 - x^2)^(-3/2), acos'' = -x (1 - x^2)^(-3/2)
  const double cube = std::pow(1 - 0.36, 1.5);
  CHECK(derivative(derivative(sqrt(c<1> - x * x), x), x)(x = 0.6) == doctest::Approx(-1 / cube));
  CHECK(derivative(derivative(acos(-x), x), x)(x = 0.6) == doctest::Approx(0.6 / cube));
  CHECK(derivative(derivative(log(c<2> - x), x), x)(x = 0.6) == doctest::Approx(-1 / (1.4 * 1.4)));
}

TEST_CASE("any scalar: 50 digits, float, Taylor numbers") {
  const auto f = sin(x) * exp(-x * x) + log(1 + x * x) / sqrt(2 + cos(x)) + pi;
  const auto generic = [](const auto& t) {
    using std::cos;
    using std::exp;
    using std::log;
    using std::sin;
    using std::sqrt;
    return sin(t) * exp(-t * t) + log(1 + t * t) / sqrt(2 + cos(t));
  };
  const real_50 at("0.73");
  const real_50 slope = derivative(f, x)(x = at);
  const real_50 expected = duet::derivative(generic, at).derivative;
  CHECK(abs(slope - expected) < 1e-48);
  CHECK(abs(f(x = at) - generic(at) - duet::constant::pi<real_50>()) < 1e-48);
  static_assert(std::is_same_v<decltype(f(x = 1.0F)), float>);
  const auto series = duet::derivatives<3>([&](auto t) { return f(x = t); }, 0.4);
  const auto third = derivative(derivative(derivative(f, x), x), x);
  CHECK(series[3] == doctest::Approx(third(x = 0.4)).epsilon(1e-13));
}

TEST_CASE("constant expressions") {
  constexpr auto f = (x * x - 2.5) / (y + c<1>);
  static_assert(f(x = 3.0, y = 1.0) == 3.25);
  static_assert(derivative(f, x)(x = 3.0, y = 1.0) == 3);
  static_assert(derivative(f, y)(x = 3.0, y = 1.0) == -1.625);
  CHECK(f(x = 1, y = 2) == -0.5);
}

template <class A, class B>
constexpr bool are_same(const A&, const B&) {
  return std::is_same_v<A, B>;
}
template <class A, class B>
bool have_same_text(const A& a, const B& b) {
  return to_text(a) == to_text(b);
}

TEST_CASE("simplification") {
  CHECK(have_same_text(x + c<0>, x));
  CHECK(have_same_text(x * c<1>, x));
  CHECK(have_same_text(x * c<0>, c<0>));
  CHECK(have_same_text(-(-x), x));
  CHECK(have_same_text(x - x, c<0>));
  CHECK(have_same_text(x + -y, x - y));
  CHECK(have_same_text(-x * -y, x * y));
  CHECK(have_same_text(sin(-x), -sin(x)));
  CHECK(have_same_text(cos(-x), cos(x)));
  CHECK(have_same_text(c<2> * (3.5_c * x), c<7> * x));
  CHECK(have_same_text(pow(x, c<1>), x));
  CHECK(have_same_text(pow(x, c<0>), c<1>));
  CHECK(have_same_text(x * x * x, pow(x, c<3>)));
  CHECK(have_same_text(0.1_c + 0.5_c, 0.1_c + 0.5_c));
  CHECK(to_text(0.1_c * 0.1_c) == "0.1 * 0.1"); // rounding is left to the scalar
  CHECK(to_text(1.5_c / c<2>) == "0.75");
  CHECK(to_text(c<1> / c<3>) == "1 / 3");
  CHECK(to_text(c<1> / c<0>) == "1 / 0");
  CHECK(have_same_text(c<3> * x / c<6>, 0.5_c * x));
  CHECK(have_same_text((c<3> - c<6> * x) / c<6>, 0.5_c - x));
  CHECK(!have_same_text((c<1> + c<6> * x) / c<6>, c<1> / c<6> + x)); // 1/6 is rounded
  CHECK(!have_same_text((x + c<6>) / c<6>, x / c<6> + c<1>));
  CHECK(have_same_text(derivative(x * x * x / c<6>, x), 0.5_c * pow(x, c<2>)));
  CHECK(have_same_text(derivative(sin(y), x), c<0>));
  CHECK((x * c<0>)(x = 2.0) == 0);
  CHECK(derivative(sin(y), x)(y = 2.0) == 0);
}

TEST_CASE("constants written in the code differ by place, even where they are equal") {
  const auto f = sin(2.0 * x) + sin(3.0 * x);
  CHECK(f(x = 0.3) == doctest::Approx(std::sin(0.6) + std::sin(0.9)).epsilon(1e-15));
  CHECK(derivative(f, x)(x = 0.3) ==
        doctest::Approx(2 * std::cos(0.6) + 3 * std::cos(0.9)).epsilon(1e-15));
  static_assert(!are_same(2.0 * x, 2.0 * x));
  static_assert(are_same(c<2> * x, c<2> * x));

  // One place that makes different constants of one type would be taken for one.
  const auto wave = [](double k) { return sin(k * x); };
  const auto twice = wave(2) + wave(2);
  CHECK(twice(x = 0.3) == doctest::Approx(2 * std::sin(0.6)).epsilon(1e-15));
  try {
    (void)(wave(2) + wave(3));
    CHECK(false);
  } catch (const duet::invalid_input& error) {
    CHECK(
        std::string(error.what()) ==
        "duet: a formula: one place in the code made two constants, 2 and 3, which would be taken "
        "for one; make what changes a symbol");
  }
}

} // namespace
} // namespace test_expression_scalars
