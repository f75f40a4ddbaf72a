// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/function_cases.hpp"
#include "support/test.hpp"

#include <duet/dual/second_dual.hpp>

#include <cfenv>

// Floating-point exceptions: a quiet NaN raises none, as in <cmath>, and neither do finite
// derivatives. (An infinite one, such as 1/√0, divides by zero.)

namespace test_dual_exceptions {
namespace {

using duet::dual;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Exceptions raised by f(x…). The volatile result keeps compilers from dropping the call.
template <class F, class... T>
int raised(const F& f, const T&... x) {
  std::feclearexcept(FE_ALL_EXCEPT);
  const auto y = f(x...);
  if constexpr (requires { duet::innermost(y); }) {
    volatile double result = double(duet::innermost(y));
    static_cast<void>(result);
  }
  return std::fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
}

/// clang optimises as if flags were never read: it replaces quiet comparisons by signalling ones.
#if defined(__clang__) && defined(__OPTIMIZE__)
constexpr bool has_flags = false;
#else
constexpr bool has_flags = true;
#endif

/// Checks that f raises no exception at x that it does not raise without derivatives.
template <class F>
void check(const std::string& name, const F& f, double at) {
  CAPTURE(name);
  CAPTURE(at);
  const volatile double hidden = at;
  const double x = hidden;
  const int expected = raised(f, x);
  CHECK((raised(f, dual<double>::variable(x)) & ~expected) == 0);
  CHECK((raised(f, dual<double>(x)) & ~expected) == 0);
  CHECK((raised(f, dual<double, 9>::variable(x, 3)) & ~expected) == 0);
  CHECK((raised(f, duet::taylor<double, 3>::variable(x)) & ~expected) == 0);
  CHECK((raised(f, duet::second_order_dual<double, 2>::variable(x, 0)) & ~expected) == 0);
}
template <class F>
void check(const std::string& name, const F& f, double a, double b) {
  CAPTURE(name);
  CAPTURE(a);
  CAPTURE(b);
  const volatile double hidden_a = a, hidden_b = b;
  const double x = hidden_a, y = hidden_b;
  const int expected = raised(f, x, y);
  using D = dual<double, 2>;
  CHECK((raised(f, D::variable(x, 0), D::variable(y, 1)) & ~expected) == 0);
  CHECK((raised(f, D::variable(x, 0), y) & ~expected) == 0);
  CHECK((raised(f, x, D::variable(y, 1)) & ~expected) == 0);
}

#define DUET_FUNCTION(f)                                                                           \
#f, [](const auto&... argument) {                                                                       \
    using std::f;                                                                                  \
    return f(argument...);                                                                                \
  }

template <class Visit>
void for_each_of_two(const Visit& visit) {
  visit(DUET_FUNCTION(fmax));
  visit(DUET_FUNCTION(fmin));
  visit(DUET_FUNCTION(fdim));
  visit(DUET_FUNCTION(atan2));
  visit(DUET_FUNCTION(hypot));
  visit(DUET_FUNCTION(fmod));
  visit(DUET_FUNCTION(remainder));
  visit(DUET_FUNCTION(copysign));
  visit(DUET_FUNCTION(isless));
  visit(DUET_FUNCTION(islessequal));
  visit(DUET_FUNCTION(isgreater));
  visit(DUET_FUNCTION(isgreaterequal));
  visit(DUET_FUNCTION(islessgreater));
  visit(DUET_FUNCTION(isunordered));
}

TEST_CASE("dual: a quiet NaN or ordinary argument raises no floating-point exception" *
          doctest::skip(!has_flags)) {
  duet_test::for_each_function([](const std::string& name, auto f, auto, const auto&, auto) {
    check(name, f, not_a_number);
    check(name, f, name == "acosh" ? 2.5 : 0.3);
  });
  for (const double x : {not_a_number, 0.3, -1.5}) {
    check(DUET_FUNCTION(tgamma), x);
    check(DUET_FUNCTION(lgamma), x);
    check(DUET_FUNCTION(fabs), x);
    check(DUET_FUNCTION(floor), x);
    check(DUET_FUNCTION(round), x);
    check(DUET_FUNCTION(trunc), x);
    check(DUET_FUNCTION(nearbyint), x);
  }
  for (const double x : {not_a_number, 0.3, -2.0}) {
    for_each_of_two([&](const char* name, const auto& f) {
      check(name, f, x, not_a_number);
      check(name, f, not_a_number, x);
      check(name, f, x, 1.25);
    });
    check(DUET_FUNCTION(pow), std::abs(x), not_a_number);
    check(DUET_FUNCTION(pow), not_a_number, x);
    check(DUET_FUNCTION(pow), std::abs(x), 2.5);
  }
}

TEST_CASE("dual: branches by comparison raise no floating-point exception at infinities and zeros" *
          doctest::skip(!has_flags)) {
  for (const double x : {infinity, -infinity, 0.0, -0.0, 2.0}) {
    for (const double y : {infinity, -infinity, 0.0, not_a_number}) {
      check(DUET_FUNCTION(fmax), x, y);
      check(DUET_FUNCTION(fmin), x, y);
      check(DUET_FUNCTION(copysign), x, y);
      check(DUET_FUNCTION(isless), x, y);
      check(DUET_FUNCTION(islessequal), x, y);
      check(DUET_FUNCTION(isgreater), x, y);
      check(DUET_FUNCTION(islessgreater), x, y);
    }
  }
}

} // namespace
} // namespace test_dual_exceptions
