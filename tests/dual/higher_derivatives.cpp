// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/function_cases.hpp"
#include "support/multiprecision.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

namespace test_dual_higher_derivatives {
namespace {

using duet::dual, duet::taylor, duet_test::central_difference, duet_test::domain,
    duet_test::for_each_function, duet_test::real_100, duet_test::scale, duet_test::ulps,
    duet_test::worst_error;

struct tag_1;
struct tag_2;
struct tag_3;
using once = dual<double, 1, tag_1>;
using twice = dual<once, 1, tag_2>;
using thrice = dual<twice, 1, tag_3>;

/// x + ε₁ + ε₂ + ε₃
thrice variable_of_three(double x) { return {twice(once(x, 1), once(1)), twice(once(1))}; }

TEST_CASE(
    "functions over Taylor and nested duals: derivatives to the fourth agree with 100 digits") {
  for_each_function([](const std::string& name, auto f, auto df, const domain& d, auto length) {
    worst_error worst(name);
    for (const double x : d.inputs) {
      const real_100 wide(x);
      // A difference quotient keeps no digits of an even derivative that nearly vanishes.
      if (x != 0 && abs(wide) < 1e-10 * length(wide)) {
        continue;
      }
      std::array<real_100, 6> exact;
      exact[1] = df(wide);
      for (int k = 2; k <= 5; ++k) {
        exact[std::size_t(k)] = central_difference(df, wide, k - 1, length(wide));
      }
      const auto add = [&](const std::string& how, std::size_t k, double computed) {
        if (abs(exact[k]) > std::numeric_limits<double>::max()) {
          CHECK_FALSE(std::isfinite(computed)); // infinite, or NaN from sums of infinities
          return;
        }
        // At 0 the vanishing derivatives of odd and even functions are exact except for the
        // quotient.
        const real_100 noise = x == 0 ? real_100(1e-20) : real_100(0);
        worst.add(ulps(computed, exact[k], real_100(scale(exact[k], exact[k + 1], wide) + noise)),
                  how, k, x);
      };
      const auto series = f(taylor<double, 4>::variable(x));
      const auto nested = f(variable_of_three(x));
      for (int k = 1; k <= 4; ++k) {
        add("taylor", std::size_t(k), series.derivative(k));
      }
      add("nested", 2, nested.value().epsilon().epsilon());
      add("nested", 2, nested.epsilon().value().epsilon());
      add("nested", 2, nested.epsilon().epsilon().value());
      add("nested", 3, nested.epsilon().epsilon().epsilon());
    }
    CHECK_MESSAGE(worst <= 16, worst);
  });
}

TEST_CASE("odd functions: even derivatives near 0 vanish with x") {
  // f″(x) → f‴(0) x and f⁗(x) → f⁽⁵⁾(0) x, where rounding errors of order 1 would swamp them.
  struct odd {
    const char* name;
    double third, fifth;
  };
  const double erf_slope = 2 / std::sqrt(std::atan(1.0) * 4);
  for (const odd& o : {odd{"sin", -1, 1}, odd{"tan", 2, 16}, odd{"asin", 1, 9}, odd{"atan", -2, 24},
                       odd{"sinh", 1, 1}, odd{"tanh", -2, 16}, odd{"asinh", -1, 9},
                       odd{"atanh", 2, 24}, odd{"erf", -2 * erf_slope, 12 * erf_slope}}) {
    for_each_function([&](const std::string& name, auto f, auto, const domain&, auto) {
      if (name != o.name) {
        return;
      }
      CAPTURE(name);
      for (const double x : {1e-300, -1e-160, 1e-20, -1e-9}) {
        CAPTURE(x);
        const auto series = f(taylor<double, 4>::variable(x));
        const auto nested = f(variable_of_three(x));
        CHECK(series.derivative(2) == doctest::Approx(o.third * x).epsilon(1e-15).scale(0));
        CHECK(series.derivative(4) == doctest::Approx(o.fifth * x).epsilon(1e-15).scale(0));
        CHECK(nested.epsilon().epsilon().value() ==
              doctest::Approx(o.third * x).epsilon(1e-15).scale(0));
      }
      CHECK(f(taylor<double, 4>::variable(0)).coefficient(2) == 0);
      CHECK(f(taylor<double, 4>::variable(0)).coefficient(4) == 0);
    });
  }
}

} // namespace
} // namespace test_dual_higher_derivatives
