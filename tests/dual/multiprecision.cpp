// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "dual/function_cases.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

// Dual numbers over Boost.Multiprecision, with and without expression templates.

namespace test_dual_multiprecision {
namespace {

using namespace duet_test;

// Values as T alone gives them; first derivatives of all functions against 100 digits.
TEST_CASE_TEMPLATE("dual of many digits: functions", T, real_50, real_50_et) {
  for_each_function([](const std::string& name, auto f, auto df, const domain& d, auto length) {
    worst_error worst(name);
    int count = 0;
    for (const double input : d.inputs) {
      if (++count > 30) {
        break;
      }
      const T x(input);
      const auto y = f(duet::dual<T>::variable(x));
      const T alone = f(x);
      CHECK(y.value() == alone);
      const real_100 wide(input);
      const real_100 exact = df(wide);
      const real_100 second = central_difference(df, wide, 1, length(wide));
      worst.add(ulps(T(y.epsilon()), exact, scale(exact, second, wide)), input);
    }
    CHECK_MESSAGE(worst <= 16, worst);
  });
}

// Algebra, comparison, promotion and the functions of several arguments, with exact results.
TEST_CASE_TEMPLATE("dual of many digits: algebra", T, real_50, real_50_et) {
  using D = duet::dual<T>;
  const D a(T(3), T(2));
  const D b(T(4), T(-1));
  const auto same = [](const D& x, double value, double epsilon) {
    return x.value() == value && x.epsilon() == epsilon;
  };
  CHECK(same(a + b, 7, 1));
  CHECK(same(a * b - 1, 11, 5));
  CHECK(same(a / b, 0.75, 11.0 / 16));
  CHECK(same(2 / b + a * 0.5, 2, 1 + 0.125));
  CHECK(same(a * T(2) + T(1) / b, 6.25, 4 + 0.0625));
  CHECK(same(-a + 1L - 2.0F, -4, -2));
  CHECK(a < b);
  CHECK(a != T(4));
  CHECK(3 == a);
  CHECK(same(fmax(a, b), 4, -1));
  CHECK(same(abs(-a), 3, 2));
  CHECK(same(pow(a, 2), 9, 12));
  CHECK(same(pow(D(-2, 1), 2.0), 4, -4));
  CHECK(same(pow(D(0, 1), 0), 1, 0));
  CHECK(abs(T(hypot(a, b).epsilon() - T(2) / 5)) < 1e-45);
  CHECK(hypot(a, b).value() == 5);
  CHECK(same(fma(a, b, a), 15, 7));
  CHECK(same(fmod(D(7, 1), a), 1, 1 - 2 * 2));
  CHECK(same(floor(D(2.5, 1)), 2, 0));
  CHECK(same(ldexp(a, 3), 24, 16));
  CHECK(same(lerp(a, b, D(0.5, 1)), 3.5, 1.5));
  CHECK(same(midpoint(a, b), 3.5, 0.5));
  CHECK(isfinite(a));
  CHECK_FALSE(signbit(a));
  CHECK(atan2(D(T(0), T(1)), D(T(2))).epsilon() == 0.5);
  const duet::dual<T, 3> packed = duet::dual<T, 3>::variable(T(3), 1);
  CHECK((packed * packed).partial(1) == 6);
  CHECK((packed * packed).partial(2) == 0);
  const auto series = 1 / duet::taylor<T, 3>::variable(T(2));
  CHECK(series.derivative(3) == -6.0 / 16);
  CHECK(static_cast<double>(a) == 3);
  CHECK(std::numeric_limits<D>::digits10 == std::numeric_limits<T>::digits10);
  CHECK(std::numeric_limits<D>::epsilon() == std::numeric_limits<T>::epsilon());
}

} // namespace
} // namespace test_dual_multiprecision
