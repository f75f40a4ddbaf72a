// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/duet.hpp>

namespace test_expression_common_subexpressions {
namespace {

/// A number that counts the sines it is asked for.
struct counted {
  double value = 0;
  counted() = default;
  explicit(false) counted(double x) : value(x) {}
  static inline int sines = 0;
  static inline int cosines = 0;

  friend counted operator-(counted a) { return -a.value; }
  friend counted operator+(counted a, counted b) { return a.value + b.value; }
  friend counted operator-(counted a, counted b) { return a.value - b.value; }
  friend counted operator*(counted a, counted b) { return a.value * b.value; }
  friend counted operator/(counted a, counted b) { return a.value / b.value; }
  friend counted sin(counted x) {
    ++sines;
    return std::sin(x.value);
  }
  friend counted cos(counted x) {
    ++cosines;
    return std::cos(x.value);
  }
};

/// Sines, then cosines, in 10 a + b.
template <class F>
int calls(const F& evaluate) {
  counted::sines = counted::cosines = 0;
  evaluate();
  return 10 * counted::sines + counted::cosines;
}

} // namespace
} // namespace test_expression_common_subexpressions

template <>
class std::numeric_limits<test_expression_common_subexpressions::counted>
    : public std::numeric_limits<double> {};

namespace test_expression_common_subexpressions {

using namespace duet::expression;

TEST_CASE("equal subexpressions are evaluated once, different ones each") {
  constexpr symbol<"x"> x;
  constexpr symbol<"y"> y;
  const counted at = 0.3;

  const auto f = sin(x) * sin(x) + sin(x) / (1 + sin(x));
  CHECK(calls([&] { return f(x = at); }) == 10);
  const auto g = sin(c<2> * x) + y * sin(c<2> * x);
  CHECK(calls([&] { return g(x = at, y = at); }) == 10);
  const auto h = sin(2.0 * x) + sin(3.0 * x);
  CHECK(calls([&] { return h(x = at); }) == 20);
  const auto kept = 2.0 * x;
  CHECK(calls([&] { return (sin(kept) + sin(kept) * y)(x = at, y = at); }) == 10);

  // A derivative shares with its function.
  CHECK(calls([&] { return gradient(sin(x * y), wrt(x, y))(x = at, y = at); }) == 11);
  CHECK(calls([&] { return hessian(sin(x * y), wrt(x, y))(x = at, y = at); }) == 11);
  CHECK(calls([&] { return derivative(derivative(sin(x), x), x)(x = at); }) == 10);
  CHECK(calls([&] { return derivative(cos(y) * x, x)(x = at, y = at); }) == 1);

  // So do an angle and its negative.
  const auto turns = sin(x) * cos(-x) + sin(-x / c<2>) * cos(x / c<2>);
  CHECK(calls([&] { return turns(x = at); }) == 22);
}

TEST_CASE("more sines at once than are written out one behind the other") {
  constexpr symbol<"x"> x;
  constexpr int count = 40;
  const auto f = [x]<int... K>(std::integer_sequence<int, K...>) {
    return (... + (c<K + 1> * sin(c<K + 1> * x)));
  }
  (std::make_integer_sequence<int, count>{});
  double expected = 0;
  for (int k = 1; k <= count; ++k) {
    expected += k * std::sin(k * 0.3);
  }
  CHECK(f(x = 0.3) == doctest::Approx(expected).epsilon(1e-14));
}

} // namespace test_expression_common_subexpressions
