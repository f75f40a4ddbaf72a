// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/dual/complex.hpp>

#include <complex>
#include <concepts>

// Dual and Taylor numbers over the complex numbers: analytic functions and their derivatives.

namespace test_dual_complex {
namespace {

using duet::dual, duet::promote_t, duet::taylor, duet_test::random_source;

using C = std::complex<double>;
using D = dual<C>;
using series = taylor<C, 4>;
struct outer_tag;
using nested = dual<D, 1, outer_tag>;

template <class A, class B>
concept CanOrder = requires(A a, B b) {
  a < b;
}
|| requires(A a, B b) { a >= b; };
template <class A>
concept HasReals = requires(A a) {
  abs(a);
}
|| requires(A a) { floor(a); }
|| requires(A a) { erf(a); }
|| requires(A a) { isnan(a); }
|| requires(A a) { atan2(a, a); }
|| requires(A a) { fmax(a, 1); };

static_assert(duet::Field<C> && duet::Field<double> && !duet::Field<D> && !duet::Field<int>);
static_assert(duet::Scalar<C> && !duet::Real<C> && !duet::Scalar<std::complex<dual<double>>>);
static_assert(std::same_as<duet::real_type_t<nested>, C>);
static_assert(!CanOrder<D, D> && !CanOrder<D, C> && !CanOrder<int, D> && !CanOrder<nested, D>);
static_assert(CanOrder<dual<double>, double>);
static_assert(!HasReals<D> && !HasReals<series> && HasReals<dual<double>>);
static_assert(!std::constructible_from<double, D> && !std::is_convertible_v<D, C>);
static_assert(!std::numeric_limits<D>::is_specialized);

// Constants, and numbers that meet in one nesting.
static_assert(std::same_as<promote_t<D, int>, D> && std::same_as<promote_t<C, D>, D>);
static_assert(std::same_as<promote_t<dual<double>, C>, D>);
static_assert(std::same_as<decltype(dual<double>() * C()), D>);
static_assert(std::same_as<decltype(C() - dual<double>()), D>);
static_assert(std::same_as<decltype(dual<double>() / D()), D>);
static_assert(std::same_as<promote_t<dual<std::complex<float>>, C>, D>);
static_assert(
    std::same_as<promote_t<dual<std::complex<float>>, double>, dual<std::complex<float>>>);
static_assert(!duet::Promotable<dual<double>, std::complex<float>>); // would lose digits
static_assert(std::is_convertible_v<dual<double>, D> && !std::is_convertible_v<D, dual<double>>);
static_assert(std::is_convertible_v<double, D> && std::is_convertible_v<C, D>);
static_assert(std::is_convertible_v<C, nested> && std::is_convertible_v<D, nested>);
static_assert(duet::Promotable<C, double> && !duet::Promotable<C, const char*>);

constexpr C i(0, 1);
constexpr double epsilon = std::numeric_limits<double>::epsilon();

bool same(const D& x, const C& value, const C& slope) {
  return x.value() == value && x.epsilon() == slope;
}

C random_number(random_source& random) { return {random.uniform(-2, 2), random.uniform(-2, 2)}; }

/// The values are those of `<complex>`, bit by bit; f′ is the closed form in every kind of number.
template <class F, class DF, class DDF>
void check_analytic(F f, DF df, DDF ddf) {
  random_source random(1);
  for (int k = 0; k < 200; ++k) {
    const C z = random_number(random);
    const C value = f(z);
    const C slope = df(z);
    const C curvature = ddf(z);
    const auto within = [&](const C& x, const C& exact) {
      const double scale = std::abs(value) + std::abs(slope) + std::abs(curvature);
      return std::abs(x - exact) <= 32 * epsilon * scale;
    };
    const D y = f(D::variable(z));
    CHECK(y.value() == value);
    CHECK(within(y.epsilon(), slope));
    const nested n = f(nested::variable(D::variable(z)));
    CHECK(n.value().value() == value);
    CHECK(n.epsilon().value() == n.value().epsilon());
    CHECK(within(n.epsilon().epsilon(), curvature));
    const auto s = f(series::variable(z));
    CHECK(within(s.value(), value));
    CHECK(within(s.derivative(1), slope));
    CHECK(within(s.derivative(2), curvature));
    // Both parts of the chain rule are complex.
    const D chained = f(D(z, C(2, -3)));
    CHECK(within(chained.epsilon() / C(2, -3), slope));
  }
}

TEST_CASE("dual of complex: the algebra is exact") {
  const D a(C(1, 2), C(3, -1));
  const D b(C(0, 2), C(1, 1));
  CHECK(same(a + b, C(1, 4), C(4, 0)));
  CHECK(same(a - b, C(1, 0), C(2, -2)));
  CHECK(same(-a, C(-1, -2), C(-3, 1)));
  CHECK(same(a * b, C(-4, 2), C(1, 9)));           // (1+2i)(1+i) + (3−i)2i
  CHECK(same(1 / b, C(0, -0.5), C(0.25, 0.25)));   // −(1+i)/(2i)²
  CHECK(same(a / b, C(1, -0.5), C(-0.75, -0.75))); // (3−i − (1−i/2)(1+i))/2i
  CHECK(same(a * i, C(-2, 1), C(1, 3)));
  CHECK(same(i * a, C(-2, 1), C(1, 3)));
  CHECK(same(a * 2 + 1 - 0.5F, C(2.5, 4), C(6, -2)));
  CHECK(same(3 - a / 2, C(2.5, -1), C(-1.5, 0.5)));
  D c = a;
  c += 1;
  c *= i;
  c -= a;
  c /= 2;
  CHECK(same(c, C(-1.5, 0), C(-1, 2)));
  CHECK(same(D::variable(i), i, 1));
  const auto packed = dual<C, 3>::variable(C(1, 2), 1);
  CHECK((packed * packed).partial(1) == C(2, 4));
  CHECK((packed * packed).partial(2) == C(0));
  const auto inverse = C(1) / series::variable(C(0, 2));
  CHECK(inverse.coefficient(1) == C(0.25));
  CHECK(inverse.coefficient(2) == C(0, 0.125));
  CHECK(inverse.derivative(3) == C(-6 / 16.0));
}

TEST_CASE("dual of complex: equality compares values, constants are real or complex") {
  const D a(C(2, 0), C(3, 1));
  CHECK(a == 2);
  CHECK(2.0 == a);
  CHECK(a == C(2));
  CHECK(a == D(C(2)));
  CHECK(a != i);
  CHECK(a != 2.5F);
  CHECK(nested(a) == 2U);
  CHECK(nested(a) == a);
  CHECK(series::variable(i) == i);
  CHECK(a == dual<double>(2));
}

TEST_CASE(
    "dual of complex: a real constant is not widened, so values equal those of complex numbers") {
  const double inf = std::numeric_limits<double>::infinity();
  const C z(0.1, -0.0);
  const D x = D::variable(z);
  CHECK(std::signbit((x + 1).value().imag()) == std::signbit((z + 1.0).imag()));
  CHECK(std::signbit((x - 1).value().imag()) == std::signbit((z - 1.0).imag()));
  CHECK(std::signbit((x * 2).value().imag()) == std::signbit((z * 2.0).imag()));
  CHECK(sqrt(x - 1).value() == sqrt(z - 1.0)); // below the cut
  CHECK(sqrt(x - 1).value().imag() < 0);
  CHECK((D(C(0.7, 0.1)) / 3).value() == C(0.7, 0.1) / 3.0);
  CHECK((D(C(inf, 1)) * 2).value() == C(inf, 2));
}

TEST_CASE("dual of complex: real duals meet complex numbers") {
  const auto t = dual<double>::variable(0.5);
  const D z = exp(i * t); // on the unit circle, its velocity ie^{it}
  CHECK(z.value() == std::exp(C(0, 0.5)));
  CHECK(std::abs(z.epsilon() - i * z.value()) <= epsilon);
}

TEST_CASE("dual of complex: output and input streams") {
  std::ostringstream out;
  out << D(C(1, 2), C(0.5, -1)) << " " << taylor<C, 1>::variable(i);
  CHECK(out.str() == "(1,2)[(0.5,-1)] ((0,1) + (1,0) e)");
  std::istringstream in("(3,4) 5");
  D a;
  series b;
  in >> a >> b;
  CHECK(same(a, C(3, 4), 0));
  CHECK(b.value() == C(5));
}

TEST_CASE("dual of complex: derivatives of exp, log and sqrt") {
  check_analytic([](const auto& z) { return exp(z); }, [](C z) { return exp(z); },
                 [](C z) { return exp(z); });
  check_analytic([](const auto& z) { return log(z); }, [](C z) { return 1.0 / z; },
                 [](C z) { return -1.0 / (z * z); });
  check_analytic([](const auto& z) { return sqrt(z); }, [](C z) { return 0.5 / sqrt(z); },
                 [](C z) { return -0.25 / (z * sqrt(z)); });
}

TEST_CASE("dual of complex: derivatives of circular and hyperbolic functions") {
  check_analytic([](const auto& z) { return sin(z); }, [](C z) { return cos(z); },
                 [](C z) { return -sin(z); });
  check_analytic([](const auto& z) { return cos(z); }, [](C z) { return -sin(z); },
                 [](C z) { return -cos(z); });
  check_analytic([](const auto& z) { return sinh(z); }, [](C z) { return cosh(z); },
                 [](C z) { return sinh(z); });
  check_analytic([](const auto& z) { return cosh(z); }, [](C z) { return sinh(z); },
                 [](C z) { return cosh(z); });
  check_analytic([](const auto& z) { return tan(z); }, [](C z) { return 1.0 + tan(z) * tan(z); },
                 [](C z) { return 2.0 * tan(z) * (1.0 + tan(z) * tan(z)); });
  check_analytic([](const auto& z) { return tanh(z); }, [](C z) { return 1.0 - tanh(z) * tanh(z); },
                 [](C z) { return -2.0 * tanh(z) * (1.0 - tanh(z) * tanh(z)); });
}

TEST_CASE("dual of complex: derivatives of powers") {
  check_analytic([](const auto& z) { return pow(z, 3.0); }, [](C z) { return 3.0 * z * z; },
                 [](C z) { return 6.0 * z; });
  check_analytic([](const auto& z) { return pow(z, 0.5); }, [](C z) { return 0.5 / sqrt(z); },
                 [](C z) { return -0.25 / (z * sqrt(z)); });
  const C p(0.5, -1.5);
  check_analytic([p](const auto& z) { return pow(z, p); }, [p](C z) { return p * pow(z, p - 1.0); },
                 [p](C z) { return p * (p - 1.0) * pow(z, p - 2.0); });
  check_analytic([p](const auto& z) { return pow(p, z); }, [p](C z) { return log(p) * pow(p, z); },
                 [p](C z) { return log(p) * log(p) * pow(p, z); });
  const C logarithm = std::log(C(-2));
  check_analytic([](const auto& z) { return pow(-2.0, z); },
                 [=](C z) { return logarithm * pow(-2.0, z); },
                 [=](C z) { return logarithm * logarithm * pow(-2.0, z); });
  check_analytic([](const auto& z) { return pow(z, z); },
                 [](C z) { return pow(z, z) * (log(z) + 1.0); },
                 [](C z) { return pow(z, z) * ((log(z) + 1.0) * (log(z) + 1.0) + 1.0 / z); });
}

TEST_CASE("dual of complex: derivatives of inverse circular and hyperbolic functions") {
  check_analytic([](const auto& z) { return log10(z); }, [](C z) { return 1 / std::log(10) / z; },
                 [](C z) { return -1 / std::log(10) / (z * z); });
  // The roots in two factors are on the branches of the functions.
  const auto root = [](C z) { return sqrt(1.0 - z) * sqrt(1.0 + z); };
  check_analytic([](const auto& z) { return asin(z); }, [=](C z) { return 1.0 / root(z); },
                 [=](C z) { return z / (root(z) * root(z) * root(z)); });
  check_analytic([](const auto& z) { return acos(z); }, [=](C z) { return -1.0 / root(z); },
                 [=](C z) { return -z / (root(z) * root(z) * root(z)); });
  check_analytic([](const auto& z) { return atan(z); }, [](C z) { return 1.0 / (1.0 + z * z); },
                 [](C z) { return -2.0 * z / ((1.0 + z * z) * (1.0 + z * z)); });
  const auto root_of_iz = [=](C z) { return root(C(-z.imag(), z.real())); };
  check_analytic([](const auto& z) { return asinh(z); }, [=](C z) { return 1.0 / root_of_iz(z); },
                 [=](C z) { return -z / (root_of_iz(z) * root_of_iz(z) * root_of_iz(z)); });
  const auto shifted = [](C z) { return sqrt(z - 1.0) * sqrt(z + 1.0); };
  check_analytic([](const auto& z) { return acosh(z); }, [=](C z) { return 1.0 / shifted(z); },
                 [=](C z) { return -z / (shifted(z) * shifted(z) * shifted(z)); });
  check_analytic([](const auto& z) { return atanh(z); }, [](C z) { return 1.0 / (1.0 - z * z); },
                 [](C z) { return 2.0 * z / ((1.0 - z * z) * (1.0 - z * z)); });
  // Near 0 derivatives of the factors would cancel; far away the square overflows.
  const C small(1e-12, 2e-12);
  CHECK(std::abs(asin(series::variable(small)).derivative(2) - small) <= 1e-26);
  CHECK(std::abs(acosh(series::variable(small)).derivative(2) + i * small) <= 1e-26);
  CHECK(std::abs(atan(series::variable(small)).derivative(2) + 2.0 * small) <= 1e-26);
  const C large(3e200, -4e200);
  CHECK(std::abs(asinh(D::variable(large)).epsilon() * large - 1.0) <= 8 * epsilon);
  CHECK(std::abs(acosh(D::variable(large)).epsilon() * large - 1.0) <= 8 * epsilon);
  CHECK(atanh(D::variable(large)).epsilon() == C(0));
}

TEST_CASE("dual of complex: powers at 0 and integer powers of large numbers") {
  const auto at_zero = [](const auto& p) { return pow(series::variable(0), p); };
  const auto are = [](const series& y, const std::array<C, 3>& expected) {
    return y.derivative(1) == expected[0] && y.derivative(2) == expected[1] &&
           y.derivative(3) == expected[2];
  };
  CHECK(are(at_zero(0), {0, 0, 0}));
  CHECK(are(at_zero(1), {1, 0, 0}));
  CHECK(are(at_zero(2.0), {0, 2, 0}));
  CHECK(are(at_zero(C(3)), {0, 0, 6}));
  CHECK(are(at_zero(series(C(2))), {0, 2, 0}));
  CHECK(std::isinf(at_zero(1.5).derivative(2).real()));
  CHECK(at_zero(1.5).derivative(1) == C(0));
  const auto both = pow(dual<D, 1, outer_tag>::variable(D(0)), nested(D::variable(2)));
  CHECK(both.epsilon().value() == C(0));
  const C z(3e100, 4e100);
  CHECK(std::abs(pow(D::variable(z), 3).epsilon() - 3.0 * z * z) <= 4 * epsilon * 3 * 25e200);
}

TEST_CASE("dual of complex: tangents far from the real axis do not cancel") {
  const C z(0.3, 18);
  const D y = tan(D::variable(z));
  const C exact = 4.0 / (std::exp(-i * z) * (1.0 + std::exp(2.0 * i * z)) * std::exp(-i * z) *
                         (1.0 + std::exp(2.0 * i * z)));
  CHECK(std::abs(y.epsilon() - exact) <= 64 * epsilon * std::abs(exact));
  const D h = tanh(D::variable(-i * z));
  CHECK(std::abs(h.epsilon() - exact) <= 64 * epsilon * std::abs(exact));
  const auto saturated = tan(series::variable(C(0.3, 800)));
  CHECK(saturated.derivative(1) == C(0));
  CHECK(saturated.derivative(3) == C(0));
  CHECK(tanh(series::variable(C(-800, 0.3))).derivative(2) == C(0));
}

TEST_CASE("dual of complex: constants stay constants at singular points") {
  CHECK(same(sqrt(D(0)), 0, 0));
  CHECK(log(D(0)).epsilon() == C(0));
  CHECK(pow(D::variable(0), 0).epsilon() == C(0));
  CHECK(same(pow(C(0), D::variable(C(2, 1))), 0, 0));
  CHECK((1 / D(0)).epsilon() == C(0));
  CHECK((dual<C, 2>::variable(1, 0) / dual<C, 2>(0)).partial(1) == C(0));
}

TEST_CASE("dual of complex: drivers differentiate analytic functions") {
  const C z(0.3, -1.2);
  const auto [y, dy] = duet::derivative([](const auto& x) { return x * sin(x); }, z);
  CHECK(y == z * sin(z));
  CHECK(std::abs(dy - (sin(z) + z * cos(z))) <= 8 * epsilon);
  const auto ys = duet::derivatives<3>([](const auto& x) { return exp(x * 2); }, z);
  CHECK(std::abs(ys[3] - 8.0 * exp(2.0 * z)) <= 64 * epsilon * std::abs(ys[3]));
}

TEST_CASE_TEMPLATE("dual of complex: functions work in every built-in precision", T, float, double,
                   long double) {
  using number = std::complex<T>;
  const auto x = dual<number>::variable(number(T(0.5), T(1.5)));
  const auto y = exp(x) * x / 2 + pow(x, 2);
  const number z = x.value();
  const number exact = exp(z) * (z + T(1)) / T(2) + T(2) * z;
  CHECK(std::abs(y.epsilon() - exact) <= 8 * std::numeric_limits<T>::epsilon() * std::abs(exact));
}

} // namespace
} // namespace test_dual_complex
