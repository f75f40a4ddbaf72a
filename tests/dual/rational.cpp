// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/dual/math.hpp>
#include <duet/interop/boost_rational.hpp>

#include <concepts>

// Dual and Taylor numbers over the rational numbers: N10, N11 without any rounding.

namespace test_dual_rational {
namespace {

using duet::dual, duet::promote_t, duet::taylor;

using Q = boost::rational<long long>;
using D = dual<Q>;
struct outer_tag;
using nested = dual<D, 1, outer_tag>;

template <class A, class B>
concept CanAdd = requires(A a, B b) {
  a + b;
};
template <class A, class B>
concept CanCompare = requires(A a, B b) {
  a == b;
};

static_assert(duet::Field<Q> && duet::Scalar<Q> && !duet::Real<Q>);
static_assert(std::same_as<promote_t<D, int>, D> && std::same_as<promote_t<Q, nested>, nested>);
static_assert(std::is_convertible_v<int, D> && std::is_convertible_v<Q, D>);
static_assert(std::is_convertible_v<Q, nested> && std::is_convertible_v<unsigned char, D>);

// A floating-point number is not a rational constant, so that none is truncated.
static_assert(!std::constructible_from<D, double> && !CanAdd<D, double> && !CanCompare<D, float>);
static_assert(!CanAdd<dual<double>, Q> && !CanAdd<D, dual<double>>);
static_assert(!std::constructible_from<double, D>);

bool same(const D& x, const Q& value, const Q& slope) {
  return x.value() == value && x.epsilon() == slope;
}

TEST_CASE("dual of rationals: the algebra is exact") {
  const D a(Q(2, 3), Q(5, 7));
  const D b(Q(-3, 4), Q(1, 2));
  CHECK(same(a + b, Q(-1, 12), Q(17, 14)));
  CHECK(same(a - b, Q(17, 12), Q(3, 14)));
  CHECK(same(a * b, Q(-1, 2), Q(1, 3) - Q(15, 28)));
  CHECK(same(a / b, Q(-8, 9), (Q(5, 7) + Q(8, 9) / 2) / Q(-3, 4)));
  CHECK(same(a + 1, Q(5, 3), Q(5, 7)));
  CHECK(same(1 - a, Q(1, 3), Q(-5, 7)));
  CHECK(same(3 * a / 2, Q(1), Q(15, 14)));
  CHECK(same(a * Q(1, 2) - Q(1, 3), Q(0), Q(5, 14)));
  D c = a;
  c += 1;
  c *= a;
  c -= Q(1, 9);
  c /= 3;
  CHECK(same(c, Q(1, 3), (Q(5, 7) * (Q(2, 3) * 2 + 1)) / 3));
  ++c;
  CHECK(c.value() == Q(4, 3));
}

TEST_CASE("dual of rationals: N11 1/(a + εb) = (1/a)(1 − ε b/a) and the axioms of a ring") {
  for (long long p = -4; p <= 4; ++p) {
    for (long long q = 1; q <= 4; ++q) {
      const Q a(p == 0 ? 7 : p, q);
      const Q b(q - 2, 3);
      const D x(a, b);
      CHECK(same(1 / x, 1 / a, -b / (a * a)));
      CHECK(same(1 / x, (1 / a) * 1, (1 / a) * -(b / a)));
      CHECK(same(x * (1 / x), 1, 0));
      const D y(Q(q, 5), Q(p));
      const D z(Q(1, 3), Q(-2, 9));
      CHECK(same(x * (y + z) - (x * y + x * z), 0, 0));
      CHECK(same((x * y) * z - x * (y * z), 0, 0));
      CHECK(same(x / y * y, x.value(), x.epsilon()));
    }
  }
  CHECK(same(D(0, 1) * D(0, 1), 0, 0)); // ε² = 0
}

TEST_CASE("dual of rationals: division by zero throws") {
  CHECK_THROWS_AS(static_cast<void>(1 / D(0, 1)),
                  boost::bad_rational); // a zero divisor of the dual numbers
  CHECK_THROWS_AS(static_cast<void>(D(1) / D(Q(0), Q(5, 3))), boost::bad_rational);
  CHECK_THROWS_AS(static_cast<void>(D(1) / 0), boost::bad_rational);
  CHECK_THROWS_AS(static_cast<void>(1 / taylor<Q, 3>::variable(0)), boost::bad_rational);
  CHECK_THROWS_AS(static_cast<void>(1 / dual<Q, 3>::variable(0, 1)), boost::bad_rational);
}

TEST_CASE("dual of rationals: comparison uses values, in the order of the rationals") {
  const D a(Q(1, 2), Q(3));
  CHECK(a == Q(1, 2));
  CHECK(Q(1, 2) == a);
  CHECK(D(2, 5) == 2);
  CHECK(2U == D(2));
  CHECK(a != 1);
  CHECK(a < 1);
  CHECK(0 < a);
  CHECK(a <= Q(1, 2));
  CHECK(a > Q(1, 3));
  CHECK(nested(a) >= a);
}

TEST_CASE("dual of rationals: output streams") {
  std::ostringstream out;
  out << D(Q(1, 2), Q(-3, 4));
  CHECK(out.str() == "1/2[-3/4]");
  std::istringstream in("5/6");
  D a;
  in >> a;
  CHECK(same(a, Q(5, 6), 0));
}

TEST_CASE("dual of rationals: derivatives of rational functions of every order are exact") {
  // f = x³/(x + 1) = x² − x + 1 − 1/(x + 1)
  const auto f = [](const auto& x) { return x * x * x / (x + 1); };
  const Q x(2, 3);
  const Q r = 1 / (x + 1);
  const auto y = f(taylor<Q, 4>::variable(x));
  CHECK(y.value() == x * x * x * r);
  CHECK(y.derivative(1) == 2 * x - 1 + r * r);
  CHECK(y.derivative(2) == 2 - 2 * r * r * r);
  CHECK(y.derivative(3) == 6 * r * r * r * r);
  CHECK(y.derivative(4) == -24 * r * r * r * r * r);
  const auto n = f(nested::variable(D::variable(x)));
  CHECK(n.epsilon().value() == y.derivative(1));
  CHECK(n.epsilon().epsilon() == y.derivative(2));
  const auto [value, slope] = duet::derivative(f, x);
  CHECK(value == y.value());
  CHECK(slope == y.derivative(1));
  const auto u = dual<Q, 2>::variable(x, 0);
  const auto v = dual<Q, 2>::variable(Q(5), 1);
  CHECK((u / v).partial(0) == Q(1, 5));
  CHECK((u / v).partial(1) == -x / 25);
}

} // namespace
} // namespace test_dual_rational
