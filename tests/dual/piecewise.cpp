// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/identical.hpp"
#include "support/test.hpp"

#include <duet/dual/math.hpp>

namespace test_dual_piecewise {
namespace {

using duet::dual, duet::taylor, duet_test::identical;

struct outer_tag;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

const std::vector<double> inputs{0.0,       -0.0,
                                 0.3,       -0.3,
                                 0.5,       -0.5,
                                 1.5,       -1.5,
                                 2.5,       -2.5,
                                 3,         -3,
                                 1e15,      -1e15,
                                 1e300,     -1e300,
                                 1e-300,    5e-324,
                                 -5e-324,   1e-310,
                                 7.75,      infinity,
                                 -infinity, not_a_number,
                                 0x1p52,    4503599627370497.5};

/// slope 0, 1 or −1 at every x where f has one.
template <class F, class Slope>
void check_values(F f, Slope slope) {
  for (const double x : inputs) {
    CAPTURE(x);
    const auto y = f(dual<double>::variable(x));
    CHECK(identical(y.value(), f(x)));
    if (x == x) {
      CHECK(y.epsilon() == slope(x));
    }
    const auto series = f(taylor<double, 2>::variable(x));
    CHECK(identical(series.value(), f(x)));
    if (x == x) {
      CHECK(series.coefficient(1) == slope(x));
    }
    CHECK(series.coefficient(2) == 0);
    CHECK(identical(f(dual<double, 5>::variable(x, 2)).value(), f(x)));
    CHECK(identical(f(dual<dual<double>, 1, outer_tag>(x)).value().value(), f(x)));
  }
}

const auto flat = [](double) { return 0.0; };

using std::abs, std::ceil, std::copysign, std::fabs, std::fdim, std::floor, std::fmax, std::fmin,
    std::frexp, std::ldexp, std::logb, std::modf, std::nearbyint, std::nextafter, std::nexttoward,
    std::rint, std::round, std::scalbln, std::scalbn, std::trunc;

TEST_CASE("abs and copysign: the derivative follows the sign") {
  const auto sign = [](double x) { return std::signbit(x) ? -1.0 : 1.0; };
  check_values([](const auto& x) { return abs(x); }, sign);
  check_values([](const auto& x) { return fabs(x); }, sign);
  check_values([](const auto& x) { return copysign(x, -2.0); }, [&](double x) { return -sign(x); });
  check_values([](const auto& x) { return copysign(2.0, x); }, flat);
  CHECK(copysign(dual<double>(3, 1), dual<double>(-0.0, 5)).epsilon() == -1);
  CHECK(identical(copysign(dual<double>::variable(not_a_number), -1).value(), not_a_number));
}

TEST_CASE("rounding functions: derivatives are zero") {
  check_values([](const auto& x) { return floor(x); }, flat);
  check_values([](const auto& x) { return ceil(x); }, flat);
  check_values([](const auto& x) { return trunc(x); }, flat);
  check_values([](const auto& x) { return round(x); }, flat);
  check_values([](const auto& x) { return rint(x); }, flat);
  check_values([](const auto& x) { return nearbyint(x); }, flat);
  check_values([](const auto& x) { return logb(x); }, flat);
  for (const double x : {2.5, -2.5, 3.0, 0.4, -7.9}) {
    const auto y = dual<double>::variable(x);
    CHECK(lround(y) == std::lround(x));
    CHECK(llround(y) == std::llround(x));
    CHECK(lrint(y) == std::lrint(x));
    CHECK(llrint(y) == std::llrint(x));
    CHECK(ilogb(y) == std::ilogb(x));
  }
}

TEST_CASE("fmax, fmin and fdim: derivatives of the selected argument") {
  for (const double b : inputs) {
    CAPTURE(b);
    const auto slope = [&](bool of_x) { return of_x ? 1.0 : 0.0; };
    check_values([&](const auto& x) { return fmax(x, b); },
                 [&](double x) { return slope(!(x < b)); });
    check_values([&](const auto& x) { return fmin(x, b); },
                 [&](double x) { return slope(!(b < x)); });
    check_values([&](const auto& x) { return fdim(x, b); },
                 [&](double x) { return slope(!(x <= b)); });
  }
  CHECK(fmax(dual<double>(1, 10), dual<double>(2, 20)).epsilon() == 20);
  CHECK(fmin(1, dual<double>(2, 20)).epsilon() == 0);
  CHECK(fmax(dual<double>(not_a_number, 10), dual<double>(2, 20)).epsilon() == 20);
  CHECK(fdim(5, dual<double>(2, 20)).epsilon() == -20);
  CHECK(std::isnan(fdim(dual<double>(not_a_number, 1), 2).value()));
}

TEST_CASE("modf: the fraction keeps the derivatives") {
  for (const double x : inputs) {
    CAPTURE(x);
    double integer_part = 0;
    const double fraction = modf(x, &integer_part);
    dual<double> integer;
    const auto y = modf(dual<double>(x, 3), &integer);
    CHECK(identical(y.value(), fraction));
    CHECK(y.epsilon() == 3);
    CHECK(identical(integer.value(), integer_part));
    CHECK(integer.epsilon() == 0);
  }
}

TEST_CASE("frexp and ldexp: the significand keeps the derivatives") {
  for (const int e : {0, 1, -1, 10, -30, -70, 1000, -1000, 3000, -3000}) {
    CAPTURE(e);
    const auto slope = [&](double) { return std::ldexp(1.0, e); };
    check_values([&](const auto& x) { return ldexp(x, e); }, slope);
    check_values([&](const auto& x) { return scalbn(x, e); }, slope);
    check_values([&](const auto& x) { return scalbln(x, long(e)); }, slope);
  }
  CHECK(ldexp(dual<double, 3>(7), 3000).partial(1) == 0);
  for (const double x : {3.0, -0.1, 1e-310, 1e300, 0.0, -0.0}) {
    CAPTURE(x);
    int expected = 0;
    int exponent = -1;
    const double significand = frexp(x, &expected);
    const auto y = frexp(dual<double>::variable(x), &exponent);
    CHECK(identical(y.value(), significand));
    CHECK(exponent == expected);
    CHECK(y.epsilon() == std::ldexp(1.0, -exponent));
  }
  CHECK(std::isinf(ldexp(dual<double>::variable(1e300), 500).value()));
}

TEST_CASE("nextafter: the neighbour keeps the derivatives") {
  const auto x = dual<double>(1, 3);
  CHECK(nextafter(x, dual<double>(2)).value() == 1 + 0x1p-52);
  CHECK(nextafter(x, dual<double>(0)).value() == 1 - 0x1p-53);
  CHECK(nextafter(x, dual<double>(0)).epsilon() == 3);
  CHECK(nexttoward(x, 2.0L).value() == std::nexttoward(1.0, 2.0L));
  CHECK(nexttoward(taylor<double, 2>::variable(1), 2.0L).coefficient(1) == 1);
}

} // namespace
} // namespace test_dual_piecewise
