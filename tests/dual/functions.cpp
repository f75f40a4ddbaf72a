// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/function_cases.hpp"
#include "support/identical.hpp"
#include "support/multiprecision.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

// Every smooth function of one argument over dual numbers: values, first derivatives, partials.

namespace test_dual_functions {
namespace {

using duet::dual, duet::taylor;
using namespace duet_test;

// Checks the references of the other tests: derivatives by hand agree with difference quotients of
// the functions themselves.
TEST_CASE("function_cases: derivatives by hand agree with difference quotients") {
  duet_test::for_each_function([](const std::string& name, auto f, auto df, const domain& d,
                                  auto length) {
    CAPTURE(name);
    int count = 0;
    for (const double input : d.inputs) {
      const real_100 x(input);
      if (abs(x) < 0.01 || abs(x) > 25 || length(x) < 0.01) {
        continue;
      }
      const real_100 difference =
          central_difference([&](const real_100& t) -> real_100 { return f(t); }, x, 1, length(x));
      const real_100 exact = df(x);
      CHECK(abs(difference - exact) <= 1e-45 * (1 + abs(exact)));
      if (++count == 20) {
        break;
      }
    }
    CHECK(count >= 4);
  });
}

TEST_CASE_TEMPLATE("functions over dual: first derivatives agree with 100 digits", T, float, double,
                   long double) {
  for_each_function([](const std::string& name, auto f, auto df, const domain& d, auto length) {
    worst_error worst(name);
    for (const double input : d.inputs) {
      const T x = T(input);
      const real_100 wide(x);
      if (x - x != 0 || (x != 0 && std::abs(x) < std::numeric_limits<T>::min()) ||
          length(wide) <= 0) {
        continue; // out of the range of T, or rounded onto a singularity
      }
      const real_100 exact = df(wide);
      const real_100 second = central_difference(df, wide, 1, length(wide));
      const auto y = f(dual<T>::variable(x));
      CHECK(y.value() == f(x));
      worst.add(ulps(y.epsilon(), exact, scale(exact, second, wide)), x);
    }
    CHECK_MESSAGE(worst <= 4, worst);
  });
}

/// y.partial(i) is the slope of one variable times the i-th seed, for every i.
template <class T, int N, class F>
bool partials_agree(F&& f, T x) {
  const T slope = f(dual<T>::variable(x)).epsilon();
  dual<T, N> seeds(x);
  for (int i = 0; i < N; ++i) {
    seeds.set_partial(i, T(i % 5) - 2);
  }
  const auto y = f(seeds);
  for (int i = 0; i < N; ++i) {
    const T seed = T(i % 5) - 2;
    const T expected = seed == 0 ? T(0) : slope * seed;
    if (y.partial(i) != expected && !(isnan(dual<T>(expected)) && isnan(dual<T>(y.partial(i))))) {
      return false;
    }
  }
  return y.value() == f(x) || f(x) != f(x);
}

TEST_CASE("functions over dual: every number of partials gives the same slope") {
  for_each_function([](const std::string& name, auto f, auto, const domain& d, auto) {
    CAPTURE(name);
    for (const double x : d.inputs) {
      CAPTURE(x);
      [&]<int... N>(std::integer_sequence<int, N...>) {
        CHECK((partials_agree<double, N>(f, x) && ...));
      }
      (std::integer_sequence<int, 1, 2, 3, 4, 5, 7, 8, 12, 17, 33>{});
      [&]<int... N>(std::integer_sequence<int, N...>) {
        CHECK((partials_agree<float, N>(f, float(x)) && ...));
      }
      (std::integer_sequence<int, 1, 3, 8, 17>{});
      CHECK(partials_agree<long double, 3>(f, x));
    }
  });
}

struct outer_tag;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST_CASE("functions over dual: the slope of log10 at the largest numbers is not 0") {
  for (const double x : {5e307, 1e308, 1.7e308}) {
    CHECK(log10(duet::dual<double>::variable(x)).epsilon() * 1e308 ==
          doctest::Approx(1e308 / x / std::log(10.)));
  }
}

TEST_CASE("functions over dual: values equal those of <cmath> bit by bit") {
  for_each_function([](const std::string& name, auto f, auto, domain d, auto) {
    CAPTURE(name);
    d.inputs.insert(d.inputs.end(), {infinity, -infinity, not_a_number, 5e-324, -5e-324, 1e308,
                                     -1e308, 800, -800, 1, -1, 2, -2, 0, -0.0});
    for (const double x : d.inputs) {
      CAPTURE(x);
      CHECK(identical(f(dual<double>::variable(x)).value(), f(x)));
      CHECK(identical(f(dual<double, 7>::variable(x, 3)).value(), f(x)));
      CHECK(identical(f(taylor<double, 3>::variable(x)).value(), f(x)));
      CHECK(identical(f(dual<dual<double>, 1, outer_tag>::variable(x)).value().value(), f(x)));
    }
  });
}

TEST_CASE("functions over dual: a constant at any nesting level has no derivative") {
  for_each_function([](const std::string& name, auto f, auto, domain d, auto) {
    CAPTURE(name);
    d.inputs.insert(d.inputs.end(),
                    {infinity, -infinity, not_a_number, 800, 1, -1, 2, -2, 0, -0.0});
    for (const double x : d.inputs) {
      CAPTURE(x);
      CHECK(f(dual<double>(x)).epsilon() == 0);
      CHECK(f(dual<double, 5>(x)).partial(4) == 0);
      const auto series = f(taylor<double, 3>(x));
      const auto nested = f(dual<dual<double>, 1, outer_tag>(x));
      // A constant of the inner level that varies in the outer one.
      const auto outer_only = f(dual<dual<double>, 1, outer_tag>::variable(x));
      for (int k = 1; k <= 3; ++k) {
        CHECK(series.coefficient(k) == 0);
      }
      CHECK(nested.epsilon() == 0);
      CHECK(nested.epsilon().epsilon() == 0);
      CHECK(nested.value().epsilon() == 0);
      CHECK(outer_only.value().epsilon() == 0);
      // Products are not guarded, so slopes that multiply infinities are left out.
      if (std::isfinite(x)) {
        CHECK(outer_only.epsilon().epsilon() == 0);
      }
    }
  });
}

} // namespace
} // namespace test_dual_functions
