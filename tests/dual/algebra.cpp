// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/dual/math.hpp>

// N10, N11 at compile time. Whatever is asserted here holds for constants, so it is exact.

namespace test_dual_algebra {
namespace {

using duet::dual, duet::taylor;

struct outer_tag;

template <class D>
constexpr bool is(const D& x, double value, double epsilon) {
  return x.value() == value && x.epsilon() == epsilon;
}

template <class T>
constexpr bool ring_holds() {
  using D = dual<T>;
  constexpr D a(T(3), T(2));
  constexpr D b(T(4), T(-1));
  static_assert(is(a + b, 7, 1));
  static_assert(is(a - b, -1, 3));
  static_assert(is(a * b, 12, 3 * -1 + 2 * 4));
  static_assert(is(a / b, 0.75, (2 * 4 - 3 * -1) / 16.0));
  static_assert(is(+a, 3, 2) && is(-a, -3, -2));
  static_assert(is((a + b) * a, 21, 7 * 2 + 3 * 1));
  static_assert(is(a * (b + D(1)), 15, 2 * 5 + 3 * -1));
  static_assert(is(a * D::variable(T(0)) * D::variable(T(0)), 0, 0)); // ε² = 0
  return true;
}
static_assert(ring_holds<float>());
static_assert(ring_holds<double>());
static_assert(ring_holds<long double>());

template <class D, class U>
constexpr bool constants_hold() {
  constexpr D a(3, 2);
  constexpr U c(2);
  static_assert(is(a + c, 5, 2) && is(c + a, 5, 2));
  static_assert(is(a - c, 1, 2) && is(c - a, -1, -2));
  static_assert(is(a * c, 6, 4) && is(c * a, 6, 4));
  static_assert(is(a / c, 1.5, 1));
  static_assert(is(U(18) / a, 6, -4));
  static_assert(std::is_same_v<decltype(a * c), D> && std::is_same_v<decltype(c / a), D>);
  return true;
}
static_assert(constants_hold<dual<double>, int>());
static_assert(constants_hold<dual<double>, short>());
static_assert(constants_hold<dual<double>, char>());
static_assert(constants_hold<dual<double>, unsigned>());
static_assert(constants_hold<dual<double>, long long>());
static_assert(constants_hold<dual<double>, float>());
static_assert(constants_hold<dual<double>, double>());
static_assert(constants_hold<dual<double>, long double>());
static_assert(constants_hold<dual<float>, int>());
static_assert(constants_hold<dual<float>, double>());
static_assert(constants_hold<dual<long double>, int>());
static_assert(constants_hold<dual<long double>, float>());

constexpr bool compound_assignment_holds() {
  dual<double> x(3, 1);
  x += 1;
  x *= x;
  x -= dual<double>(1, 2);
  x /= 3;
  if (!is(x, 5, 2)) {
    return false;
  }
  ++x;
  const auto before = x++;
  --x;
  const auto after = x--;
  return is(before, 6, 2) && is(after, 6, 2) && is(x, 5, 2);
}
static_assert(compound_assignment_holds());

template <int N>
constexpr bool packed_holds() {
  using D = dual<double, N>;
  auto x = D::variable(3, 0);
  auto y = D::variable(5, N - 1);
  const D z = x * y / 2 - y / (x + 2) + 1;
  // z = xy/2 − y/(x+2) + 1 at (3, 5)
  const double dx = 2.5 + 5.0 / 25;
  const double dy = 1.5 - 1.0 / 5;
  bool result = z.value() == 7.5;
  for (int i = 1; i < N - 1; ++i) {
    result = result && z.partial(i) == 0;
  }
  const auto near = [](double a, double b) { return a - b < 1e-15 && b - a < 1e-15; };
  return result && (N == 1 ? near(z.partial(0), dx + dy)
                           : near(z.partial(0), dx) && near(z.partial(N - 1), dy));
}
static_assert(packed_holds<1>() && packed_holds<2>() && packed_holds<3>() && packed_holds<4>());
static_assert(packed_holds<5>() && packed_holds<7>() && packed_holds<8>() && packed_holds<12>());
static_assert(packed_holds<17>() && packed_holds<33>());

// ε₁ε₂ of nested duals is the mixed second derivative.
constexpr bool nesting_holds() {
  using inner = dual<double>;
  using D = dual<inner, 1, outer_tag>;
  const D x(inner(3, 1), inner(1, 0)); // x + ε_inner + ε_outer
  const D y = x * x * x;
  const D q = 1 / x;
  return y.value().value() == 27 && y.value().epsilon() == 27 && y.epsilon().value() == 27 &&
         y.epsilon().epsilon() == 18 && q.epsilon().epsilon() - 2.0 / 27 < 1e-17;
}
static_assert(nesting_holds());

constexpr bool taylor_holds() {
  const auto x = taylor<double, 3>::variable(2);
  const auto cube = x * x * x;
  const auto inverse = 1 / x;
  const auto same = cube * inverse - x * x + 4 - 1 * x / 1 + x - 4.0F;
  bool result = cube.value() == 8 && cube.coefficient(1) == 12 && cube.coefficient(2) == 6 &&
                cube.coefficient(3) == 1 && cube.derivative(2) == 12 && cube.derivative(3) == 6;
  result = result && inverse.coefficient(1) == -0.25 && inverse.coefficient(2) == 0.125 &&
           inverse.coefficient(3) == -0.0625;
  return result && same.all_of([](double c) { return c == 0; });
}
static_assert(taylor_holds());

static_assert(std::is_trivially_copyable_v<dual<double>>);
static_assert(std::is_trivially_copyable_v<taylor<double, 4>>);
static_assert(sizeof(dual<double>) == 2 * sizeof(double));
static_assert(dual<double>().value() == 0 && dual<double>().epsilon() == 0);
static_assert(dual<double, 7>().partial(6) == 0);
static_assert(duet::scalar_traits<dual<taylor<double, 3>, 2, outer_tag>>::order == 4);

// Run time uses packets, which constant evaluation does not.
template <class T, int N>
void check_packed() {
  using D = dual<T, N>;
  D x(T(3));
  D y(T(-2));
  for (int i = 0; i < N; ++i) {
    x.set_partial(i, T(i + 1));
    y.set_partial(i, T(2 * i - 5));
  }
  D copy = x;
  copy = y;
  copy = x;
  const D sum = copy + y;
  const D difference = x - y;
  const D product = x * y;
  const D quotient = x / y;
  const D scaled = 3 * x;
  const D inverse = 6 / y;
  for (int i = 0; i < N; ++i) {
    const T p = T(i + 1);
    const T q = T(2 * i - 5);
    CHECK(D::variable(1, i).partial(i) == 1);
    CHECK(D::variable(1, i).partial((i + 1) % N) == (N == 1 ? 1 : 0));
    CHECK(sum.partial(i) == p + q);
    CHECK(difference.partial(i) == p - q);
    CHECK(product.partial(i) == -2 * p + 3 * q);
    CHECK(quotient.partial(i) == (p * -2 - 3 * q) / 4);
    CHECK(scaled.partial(i) == 3 * p);
    CHECK(inverse.partial(i) == -6 * q / 4);
    CHECK((-x).partial(i) == -p);
  }
}

TEST_CASE("dual: packed partials at run time give the same results as constant evaluation") {
  check_packed<double, 1>();
  check_packed<double, 2>();
  check_packed<double, 3>();
  check_packed<double, 4>();
  check_packed<double, 5>();
  check_packed<double, 7>();
  check_packed<double, 12>();
  check_packed<double, 33>();
  check_packed<float, 3>();
  check_packed<float, 8>();
  check_packed<float, 17>();
  check_packed<long double, 3>();
}

} // namespace
} // namespace test_dual_algebra
