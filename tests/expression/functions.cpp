// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/duet.hpp>

// Every function as a formula beside the same over dual numbers: values and derivatives by the
// same rules, so within 4 ulp of each other, wherever it is.

namespace test_expression_functions {
namespace {

using namespace duet::expression;

constexpr symbol<"x"> x;
constexpr symbol<"y"> y;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Within 4 units of the last place, or both NaN.
bool agree(double a, double b) {
  if (a == b || (a != a && b != b)) {
    return true;
  }
  const double unit = std::max({std::abs(a), std::abs(b)}) * 0x1p-52;
  return std::abs(a - b) <= 4 * std::max(unit, std::numeric_limits<double>::denorm_min());
}

/// ±0, the smallest and the largest, where squares and fourth powers leave the range, ±1 and beside
/// them, poles and half-integers of the gamma functions, infinities, NaN.
std::vector<double> extremes() {
  std::vector<double> result{std::numeric_limits<double>::quiet_NaN()};
  for (const double size :
       {0.0,   5e-324, 1e-310,      1e-300, 1e-200,      1e-155, 1e-80, 1e-9,
        0.3,   0.5,    1 - 0x1p-53, 1.0,    1 + 0x1p-52, 1.5,    2.0,   2.4570247382208006,
        8.5,   20.5,   26.0,        170.3,  700.0,       1e9,    1e80,  1e155,
        1e200, 1e300,  infinity}) {
    result.insert(result.end(), {size, -size});
  }
  return result;
}

struct outer_tag;
using dual = duet::dual<double>;
using twice = duet::dual<dual, 1, outer_tag>;

template <class F>
void check_function(const char* name, const F& function) {
  CAPTURE(name);
  const auto f = function(x);
  const auto first = derivative(f, x);
  const auto second = derivative(first, x);
  for (const double at : extremes()) {
    CAPTURE(at);
    const twice expected = function(twice::variable(dual::variable(at)));
    CHECK(agree(f(x = at), expected.value().value()));
    CHECK_MESSAGE(agree(first(x = at), expected.epsilon().value()),
                  first(x = at) << " " << expected.epsilon().value());
    CHECK_MESSAGE(agree(second(x = at), expected.epsilon().epsilon()),
                  second(x = at) << " " << expected.epsilon().epsilon());
  }
}

/// By each argument where the other is constant, and by both.
template <class F>
void check_function_of_two(const char* name, const F& function,
                           const std::vector<double>& at = extremes()) {
  CAPTURE(name);
  const auto f = function(x, y);
  const auto by_first = derivative(f, x);
  const auto by_second = derivative(f, y);
  const auto twice_first = derivative(by_first, x);
  const auto mixed = derivative(by_first, y);
  const auto twice_second = derivative(by_second, y);
  for (const double a : at) {
    for (const double b : at) {
      CAPTURE(a);
      CAPTURE(b);
      const auto values = [&](const auto& g) { return g(x = a, y = b); };
      const auto by_a = function(twice::variable(dual::variable(a)), b);
      const auto by_b = function(a, twice::variable(dual::variable(b)));
      const auto by_both = function(twice::variable(dual(a)), twice(dual::variable(b)));
      CHECK(agree(values(f), by_a.value().value()));
      CHECK_MESSAGE(agree(values(by_first), by_a.epsilon().value()),
                    values(by_first) << " " << by_a.epsilon().value());
      CHECK_MESSAGE(agree(values(by_second), by_b.epsilon().value()),
                    values(by_second) << " " << by_b.epsilon().value());
      CHECK_MESSAGE(agree(values(twice_first), by_a.epsilon().epsilon()),
                    values(twice_first) << " " << by_a.epsilon().epsilon());
      CHECK_MESSAGE(agree(values(twice_second), by_b.epsilon().epsilon()),
                    values(twice_second) << " " << by_b.epsilon().epsilon());
      CHECK_MESSAGE(agree(values(mixed), by_both.epsilon().epsilon()),
                    values(mixed) << " " << by_both.epsilon().epsilon());
    }
  }
}

#define CHECK_BESIDE_DUALS(function)                                                               \
  check_function(#function, [](const auto& t) {                                                    \
    using std::function;                                                                           \
    return function(t);                                                                            \
  })
#define CHECK_FUNCTION_OF_TWO(function)                                                            \
  check_function_of_two(#function, [](const auto& s, const auto& t) {                              \
    using std::function;                                                                           \
    return function(s, t);                                                                         \
  })

TEST_CASE("functions of one scalar") {
  CHECK_BESIDE_DUALS(sqrt);
  CHECK_BESIDE_DUALS(cbrt);
  CHECK_BESIDE_DUALS(exp);
  CHECK_BESIDE_DUALS(exp2);
  CHECK_BESIDE_DUALS(expm1);
  CHECK_BESIDE_DUALS(log);
  CHECK_BESIDE_DUALS(log2);
  CHECK_BESIDE_DUALS(log10);
  CHECK_BESIDE_DUALS(log1p);
  CHECK_BESIDE_DUALS(sin);
  CHECK_BESIDE_DUALS(cos);
  CHECK_BESIDE_DUALS(tan);
  CHECK_BESIDE_DUALS(asin);
  CHECK_BESIDE_DUALS(acos);
  CHECK_BESIDE_DUALS(atan);
  CHECK_BESIDE_DUALS(sinh);
  CHECK_BESIDE_DUALS(cosh);
  CHECK_BESIDE_DUALS(tanh);
  CHECK_BESIDE_DUALS(asinh);
  CHECK_BESIDE_DUALS(acosh);
  CHECK_BESIDE_DUALS(atanh);
  CHECK_BESIDE_DUALS(erf);
  CHECK_BESIDE_DUALS(erfc);
  CHECK_BESIDE_DUALS(tgamma);
  CHECK_BESIDE_DUALS(lgamma);
  CHECK_BESIDE_DUALS(abs);
}

TEST_CASE("functions of several scalars") {
  CHECK_FUNCTION_OF_TWO(atan2);
  CHECK_FUNCTION_OF_TWO(hypot);
  CHECK_FUNCTION_OF_TWO(pow);
  check_function_of_two("hypot of three", [](const auto& s, const auto& t) {
    using std::hypot;
    return hypot(s, 0.3, t);
  });
}

TEST_CASE("norms of vectors") {
  std::vector<double> at = extremes(); // those with inverses: of std::hypot(∞, 1, 1) some make NaN
  std::erase_if(at, [](double size) {
    return size != 0 && !(std::abs(size) >= 1e-300 && std::abs(size) < infinity);
  });
  for (const double third : {0.0, 0.3, 1e-200, 1e200}) {
    CAPTURE(third);
    check_function_of_two(
        "norm",
        [third](const auto& s, const auto& t) {
          using std::hypot;
          if constexpr (Term<std::remove_cvref_t<decltype(s)>>) {
            return norm(make_vector(s, third, t));
          } else {
            return hypot(s, third, t);
          }
        },
        at);
  }
}

TEST_CASE("constant exponents and bases") {
  const auto check_power = [](double p) {
    CAPTURE(p);
    check_function("power", [p](const auto& t) {
      using std::pow;
      return pow(t, p);
    });
  };
  for (const double p : {0.3, -0.7, 1e-9, 2.5, 3.0, -2.0}) {
    check_power(p);
  }
  check_function("exponential", [](const auto& t) {
    using std::pow;
    return pow(1.7, t);
  });
}

TEST_CASE("whole powers by products have the range of the others") {
  const auto f = pow(x, c<-2>);
  CHECK(agree(f(x = 1e155), 1e-310));
  CHECK(agree(f(x = 1e-155), infinity));
  CHECK(agree(pow(x, c<-3>)(x = 1e103), 1e-309));
}

TEST_CASE("third and mixed derivatives are those of the rules too") {
  const auto third = derivative(derivative(derivative(atan(x), x), x), x);
  CHECK(third(x = 0.7) ==
        doctest::Approx(atan(duet::taylor<double, 3>::variable(0.7)).derivative(3)).epsilon(1e-15));
  const auto mixed = derivative(derivative(derivative(hypot(x, y), x), y), x);
  const auto swapped = derivative(derivative(derivative(hypot(x, y), y), x), x);
  const double a = 0.3, b = 0.4, exact = b * (2 * a * a - b * b) / std::pow(0.5, 5);
  CHECK(mixed(x = a, y = b) == doctest::Approx(exact).epsilon(1e-14));
  CHECK(swapped(x = a, y = b) == doctest::Approx(exact).epsilon(1e-14));
}

int slopes_counted = 0;

struct counted_rule {
  template <class T>
  T value(const T& t) const {
    return t * t * t;
  }
  template <class T>
  T slope(const T& t, const T&) const {
    ++slopes_counted;
    return 3 * t * t;
  }
};
struct counted : duet::expression::detail::function<counted, counted_rule> {
  [[maybe_unused]] static constexpr duet::expression::detail::function_name name = {"counted", ""};
};

TEST_CASE("a second derivative evaluates the rule's slope once") {
  const auto second = derivative(derivative(duet::expression::apply<counted>(x), x), x);
  slopes_counted = 0;
  CHECK(second(x = 2.0) == 12);
  CHECK(slopes_counted == 1);
}

} // namespace
} // namespace test_expression_functions
