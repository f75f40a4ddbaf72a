// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

#include <duet/core/batch/batch.hpp>
#include <duet/core/batch/math.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/math.hpp>

namespace test_core_batch {
namespace {

using duet::batch, duet::select;

static_assert(duet::Scalar<batch<double>> && duet::Real<batch<float, 4>>);
static_assert(duet::Batched<batch<double>> && !duet::Batched<double>);
static_assert(std::is_same_v<duet::lane_type_t<batch<float>>, float>);
static_assert(!std::is_convertible_v<duet::lane_mask<double, 4>, bool>);

template <class B>
B counted(double first, double step = 1) {
  // Volatile, so that the compiler does not evaluate and round functions of it itself.
  volatile double unknown = first;
  const double begin = unknown;
  return B::from_lanes([=](int i) { return typename B::value_type(begin + step * i); });
}

/// f over batches is f over numbers, bit for bit.
template <class B, class F>
void check_lanes(const F& f, const B& x, const B& y) {
  const auto result = f(x, y);
  for (int i = 0; i < B::lanes; ++i) {
    CHECK(duet::lane(result, i) == f(x[i], y[i]));
  }
}

TEST_CASE_TEMPLATE("batch: arithmetic and comparisons equal those of the lanes", B, batch<double>,
                   batch<double, 1>, batch<double, 8>, batch<float, 4>, batch<float, 16>,
                   batch<long double, 2>) {
  const B x = counted<B>(-1.3, 0.7), y = counted<B>(0.9, 0.25);
  check_lanes([](auto a, auto b) { return a + b; }, x, y);
  check_lanes([](auto a, auto b) { return a - b; }, x, y);
  check_lanes([](auto a, auto b) { return a * b; }, x, y);
  check_lanes([](auto a, auto b) { return a / b; }, x, y);
  check_lanes([](auto a, auto) { return -a; }, x, y);
  check_lanes([](auto a, auto) { return a * 2; }, x, y);
  check_lanes([](auto a, auto b) { return a += b, a -= 2, a *= b, a /= 3, a; }, x, y);
  for (int i = 0; i < B::lanes; ++i) {
    CHECK((x < y)[i] == (x[i] < y[i]));
    CHECK((x >= y)[i] == (x[i] >= y[i]));
    CHECK((x == 0)[i] == (x[i] == 0));
    CHECK((x != y && !(1 < x))[i] == (x[i] != y[i] && !(1 < x[i])));
    CHECK((x <= y || x > 3)[i] == (x[i] <= y[i] || x[i] > 3));
  }
  CHECK(all(x == x));
  CHECK(!any(x != x));
  CHECK(any(x == x[B::lanes - 1]));
  CHECK(all(x == x[0]) == (B::lanes == 1));
  std::array<typename B::value_type, B::lanes> numbers;
  x.store(numbers.data());
  CHECK(all(B::load(numbers.data()) == x));
}

TEST_CASE_TEMPLATE("batch: select takes each lane from its side", B, batch<double>,
                   batch<double, 8>, batch<float, 4>, batch<long double, 2>) {
  const B x = counted<B>(-1);
  const auto f = [](const auto& a) {
    return select(
        a < 0.5, [&] { return a + 1; }, [&] { return -a; });
  };
  for (int i = 0; i < B::lanes; ++i) {
    CHECK(f(x)[i] == f(x[i]));
  }
  int calls = 0;
  const auto count = [&] { return B(++calls); };
  const auto never = [&]() -> B {
    FAIL("evaluated");
    return 0;
  };
  CHECK(all(select(x == x, count, never) == 1));
  CHECK(all(select(x != x, never, count) == 2));
}

TEST_CASE_TEMPLATE("batch: functions equal those of the lanes", B, batch<double>, batch<float, 16>,
                   batch<long double, 2>) {
  const B x = counted<B>(0.2, 0.7 / B::lanes), y = counted<B>(-0.7, 0.3);
#define DUET_CHECK_FUNCTION(f)                                                                     \
  check_lanes(                                                                                     \
      [](auto a, auto) {                                                                           \
        using std::f;                                                                              \
        return f(a);                                                                               \
      },                                                                                           \
      x, y)
  DUET_CHECK_FUNCTION(sqrt);
  DUET_CHECK_FUNCTION(cbrt);
  DUET_CHECK_FUNCTION(exp);
  DUET_CHECK_FUNCTION(exp2);
  DUET_CHECK_FUNCTION(expm1);
  DUET_CHECK_FUNCTION(log);
  DUET_CHECK_FUNCTION(log2);
  DUET_CHECK_FUNCTION(log10);
  DUET_CHECK_FUNCTION(log1p);
  DUET_CHECK_FUNCTION(tan);
  DUET_CHECK_FUNCTION(asin);
  DUET_CHECK_FUNCTION(acos);
  DUET_CHECK_FUNCTION(atan);
  DUET_CHECK_FUNCTION(sinh);
  DUET_CHECK_FUNCTION(cosh);
  DUET_CHECK_FUNCTION(tanh);
  DUET_CHECK_FUNCTION(asinh);
  DUET_CHECK_FUNCTION(atanh);
  DUET_CHECK_FUNCTION(erf);
  DUET_CHECK_FUNCTION(erfc);
  DUET_CHECK_FUNCTION(tgamma);
  DUET_CHECK_FUNCTION(lgamma);
  DUET_CHECK_FUNCTION(abs);
  DUET_CHECK_FUNCTION(fabs);
  DUET_CHECK_FUNCTION(floor);
  DUET_CHECK_FUNCTION(ceil);
  DUET_CHECK_FUNCTION(trunc);
  DUET_CHECK_FUNCTION(round);
  DUET_CHECK_FUNCTION(rint);
  DUET_CHECK_FUNCTION(nearbyint);
  DUET_CHECK_FUNCTION(logb);
#undef DUET_CHECK_FUNCTION
  using std::abs, std::acosh, std::atan2, std::copysign, std::fdim, std::fma, std::fmax, std::fmin,
      std::fmod, std::hypot, std::ldexp, std::lerp, std::midpoint, std::nextafter, std::pow,
      std::remainder;
  check_lanes([](auto, auto b) { return abs(b); }, x, y);
  check_lanes([](auto a, auto b) { return atan2(a, b); }, x, y);
  check_lanes([](auto a, auto b) { return copysign(a, b); }, x, y);
  check_lanes([](auto a, auto b) { return fmax(a, b); }, x, y);
  check_lanes([](auto a, auto b) { return fmod(a, b); }, x, y);
  check_lanes([](auto a, auto b) { return hypot(a, b); }, x, y);
  check_lanes([](auto a, auto b) { return pow(a, b); }, x, y);
  check_lanes([](auto a, auto) { return acosh(a + 1); }, x, y);
  check_lanes([](auto a, auto b) { return fmin(a, b); }, x, y);
  check_lanes([](auto a, auto b) { return fdim(a, b); }, x, y);
  check_lanes([](auto a, auto b) { return remainder(b, a); }, x, y);
  check_lanes([](auto a, auto b) { return nextafter(a, b); }, x, y);
  check_lanes([](auto a, auto b) { return fma(a, b, a); }, x, y);
  check_lanes([](auto a, auto b) { return lerp(a, b, a); }, x, y);
  check_lanes([](auto a, auto b) { return midpoint(a, b); }, x, y);
  check_lanes([](auto a, auto) { return ldexp(a, 3); }, x, y);
  check_lanes([](auto a, auto b) { return hypot(a, b, a); }, x, y);
  for (int i = 0; i < B::lanes; ++i) {
    CHECK(signbit(y)[i] == std::signbit(y[i]));
    CHECK(isnan(y / 0 * 0)[i]);
    CHECK(isfinite(x / (x - x[0]))[i] == (i > 0));
    CHECK(isinf(x / (x - x[0]))[i] == (i == 0));
    CHECK(isnormal(x - x[0])[i] == (i > 0));
    CHECK(max(x, B(0.5))[i] == std::max(x[i], typename B::value_type(0.5)));
    CHECK(min(x, B(0.5))[i] == std::min(x[i], typename B::value_type(0.5)));
  }
}

TEST_CASE("batch: sine and cosine are accurate to one ulp whatever the other lanes contain") {
  using B = batch<double, 4>;
  using wide = duet_test::real_50;
  duet_test::random_source random(1);
  duet_test::worst_error worst("sin, cos");
  // Volatile, because the compiler's own sine may differ from the C library's.
  volatile double unknown = 1e9;
  const double large = unknown;
  const auto check = [&](double x) {
    const B sine = sin(B(x)), cosine = cos(B(x));
    const wide s = sin(wide(x)), c = cos(wide(x));
    worst.add(duet_test::ulps(sine[1], s, wide(abs(s))), x);
    worst.add(duet_test::ulps(cosine[2], c, wide(abs(c))), x);
    // Next to a lane beyond the range of the kernel.
    B mixed(x);
    mixed.set(3, large);
    CHECK(sin(mixed)[1] == sine[1]);
    CHECK(cos(mixed)[2] == cosine[2]);
    CHECK(sin(mixed)[3] == std::sin(large));
  };
  for (int i = 0; i < 300; ++i) {
    const double u = random.uniform(-1, 1);
    check(u);
    check(4 * u);
    check(7.9e5 * u);
    const double quarter_turns = std::round(5e5 * u) * 0x1.921fb54442d18p0;
    check(quarter_turns);
    check(std::nextafter(quarter_turns, 0));
    check(std::ldexp(u, -3 * i));
  }
  CHECK_MESSAGE(worst <= 2.2, worst); // in halves of the last place
  CHECK(std::signbit(sin(B(-0.0))[0]));
  CHECK(std::isnan(sin(B(std::numeric_limits<double>::infinity()))[0]));
}

TEST_CASE("batch: output lists the lanes") {
  std::ostringstream text;
  text << batch<double, 2>::from_lanes([](int i) { return 0.5 + i; });
  CHECK(text.str() == "[0.5, 1.5]");
}

} // namespace
} // namespace test_core_batch
