// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual/function_cases.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/second_dual.hpp>
#include <duet/dual/stumpff.hpp>

#include <Eigen/LU>

#include <complex>

// Numbers with second derivatives, against duals over duals.

namespace test_dual_second_dual {
namespace {

using duet::dual, duet::second_order_dual;

struct outer_tag;

template <int N, class T = double>
using nested = dual<dual<T, N>, N, duet::derivative_tag<outer_tag>>;

template <int N, class T>
nested<N, T> nested_variable(T x, int i) {
  return nested<N, T>::variable(dual<T, N>::variable(x, i), i);
}

/// Equal up to rounding, or not finite in both.
bool close(double a, double b, double scale) {
  if (!std::isfinite(a) || !std::isfinite(b)) {
    return std::isfinite(a) == std::isfinite(b);
  }
  return std::abs(a - b) <= 1e-14 * scale + 1e-300;
}

template <int N, class T>
void check_same(const second_order_dual<T, N>& y, const nested<N, T>& expected) {
  CHECK(y.value() == expected.value().value());
  double scale = std::abs(double(y.value()));
  for (int i = 0; i < N; ++i) {
    scale = std::max(scale, std::abs(double(expected.partial(i).value())));
    for (int j = 0; j < N; ++j) {
      scale = std::max(scale, std::abs(double(expected.partial(i).partial(j))));
    }
  }
  for (int i = 0; i < N; ++i) {
    CHECK(close(double(y.partial(i)), double(expected.partial(i).value()), scale));
    for (int j = 0; j < N; ++j) {
      CAPTURE(i);
      CAPTURE(j);
      CHECK(close(double(y.second_partial(i, j)), double(expected.partial(i).partial(j)), scale));
    }
  }
}

/// Every kind of operation, in a chain.
template <class D, std::size_t N>
D everything(const std::array<D, N>& x) {
  D sum = 0.5;
  for (std::size_t i = 0; i < N; ++i) {
    const D& a = x[i];
    const D& b = x[(i + 1) % N];
    sum += sin(a) * exp(-b) / (2 + a * a) - 3 * sqrt(1 + b * b) + 1 / (b + 3) - cos(a * b);
    sum -= hypot(a, b, 1) + pow(abs(a) + 1, b) + atan2(a, b) + fma(a, b, sum) / 7 + pow(a, 3);
    sum *= a - b;
  }
  return -sum;
}

template <class T, int N>
void check_everything() {
  std::array<second_order_dual<T, N>, std::size_t(N)> x;
  std::array<nested<N, T>, std::size_t(N)> y;
  for (int i = 0; i < N; ++i) {
    const T value = T(0.3) * T(i % 5) - T(0.7);
    x[std::size_t(i)] = second_order_dual<T, N>::variable(value, i);
    y[std::size_t(i)] = nested_variable<N>(value, i);
  }
  check_same<N, T>(everything(x), everything(y));
}

TEST_CASE("second_order_dual: every function of one argument") {
  duet_test::for_each_function(
      [](const std::string& name, auto f, auto, const duet_test::domain& d, auto) {
        CAPTURE(name);
        for (const double x : d.inputs) {
          if (std::abs(x) > 1e100 || (x != 0 && std::abs(x) < 1e-100)) {
            continue; // the nested slopes overflow in intermediate results
          }
          CAPTURE(x);
          check_same<1, double>(f(second_order_dual<double, 1>::variable(x)),
                                f(nested_variable<1>(x, 0)));
        }
      });
}

TEST_CASE("second_order_dual: sums, products, quotients and functions of several arguments") {
  check_everything<double, 1>();
  check_everything<double, 2>();
  check_everything<double, 9>();
  check_everything<long double, 4>();
}

TEST_CASE("second_order_dual: quotients whose divisor's cube overflows or vanishes") {
  for (const double unit : {1e-140, 1e-105, 1e105, 1e140}) {
    using number = second_order_dual<double, 2>;
    const double x = 3 * unit, y = -2 * unit;
    const number q = number::variable(x, 0) / number::variable(y, 1);
    CAPTURE(unit);
    CHECK(q.value() == x / y);
    CHECK(q.partial(0) * y == doctest::Approx(1));
    CHECK(q.partial(1) * y == doctest::Approx(1.5));
    CHECK(q.second_partial(0, 0) == 0);
    CHECK(q.second_partial(1, 0) * y * y == doctest::Approx(-1));
    CHECK(q.second_partial(1, 1) * y * y == doctest::Approx(-3));
  }
}

TEST_CASE("second_order_dual: quotients of polynomials at large and small numbers") {
  using number = second_order_dual<double, 1>;
  for (const double x : {1e-70, 1e-55, 1e55, 1e70}) {
    CAPTURE(x);
    const number u = number::variable(x, 0), inverse = 1 / (u * u), same = (u - x + 1) / (u * u);
    CHECK(inverse.partial(0) * x * x * x == doctest::Approx(-2));
    CHECK(inverse.second_partial(0, 0) * x * x * x * x == doctest::Approx(6));
    CHECK(same.second_partial(0, 0) * x * x * x * x == doctest::Approx(6 - 4 * x));
  }
  for (const double x : {1e90, 1e150}) {
    CAPTURE(x);
    const number u = number::variable(x, 0), y = u / (1 + u * u);
    CHECK(y.partial(0) * x * x == doctest::Approx(-1));
    CHECK(y.second_partial(0, 0) * x * x * x == doctest::Approx(x < 1e100 ? 2 : 0));
  }
  const number huge = number::variable(1e200, 0);
  CHECK((huge / (1 + huge * huge)).second_partial(0, 0) == 0);
}

TEST_CASE("second_order_dual: functions whose second derivative overflows or vanishes") {
  for (const double unit : {1e-150, 1e-103, 1e103, 1e150}) {
    using number = second_order_dual<double, 2>;
    const double a = 3 * unit, b = 4 * unit;
    const number x = number::variable(a, 0), y = number::variable(b, 1);
    const number r = sqrt(x * x + y * y);
    CAPTURE(unit);
    CHECK(r.partial(0) == doctest::Approx(.6));
    CHECK(r.second_partial(0, 0) * unit == doctest::Approx(16. / 125));
    CHECK(r.second_partial(1, 0) * unit == doctest::Approx(-12. / 125));
    CHECK(r.second_partial(1, 1) * unit == doctest::Approx(9. / 125));
  }
}

TEST_CASE("second_order_dual: structural zeros survive") {
  using D = second_order_dual<double, 2>;
  const D constant = 0;
  const D x = D::variable(0, 0);
  for (const D& y : {sqrt(constant), sqrt(constant * x), constant / D(0) * 0.0, pow(x, 0)}) {
    CHECK(y.partial(0) == 0);
    CHECK(y.second_partial(0, 0) == 0);
  }
  const D root = sqrt(x);
  CHECK(std::isinf(root.partial(0)));
  CHECK(root.partial(1) == 0);
  CHECK(root.second_partial(1, 1) == 0);
  CHECK(root.second_partial(1, 0) == 0);
}

TEST_CASE("second_order_dual: the square of a norm at 0 has no finite second derivative") {
  using D = second_order_dual<double, 2>;
  const D x = D::variable(0, 0), y = D::variable(0, 1);
  const D square = x * x + y * y;
  CHECK(square.second_partial(0, 0) == 2);
  CHECK(square.second_partial(1, 1) == 2);
  CHECK(square.second_partial(0, 1) == 0);
  // √(x² + y²) has no second-order expansion at 0: the result is ∞, not a wrong 0.
  const D norm = sqrt(square);
  CHECK(norm.partial(0) == 0);
  CHECK(norm.second_partial(0, 0) == std::numeric_limits<double>::infinity());
  CHECK(std::isnan((norm * norm).second_partial(0, 0)));
  CHECK(std::isnan(pow(norm, 2).second_partial(1, 1)));
  CHECK((norm * norm).partial(0) == 0);
  // Near 0 it is right to round-off.
  const D near = sqrt((x + 1e-90) * (x + 1e-90) + y * y);
  CHECK((near * near).second_partial(0, 0) == doctest::Approx(2).epsilon(1e-14));
  CHECK((near * near).second_partial(1, 1) == doctest::Approx(2).epsilon(1e-14));
}

TEST_CASE("second_order_dual: nests inside and outside other levels") {
  // d/dt of the Hessian of t x² y.
  const auto trace = [](auto t) {
    const auto f = [t](const auto& x) { return t * x[0] * x[0] * x[1]; };
    const auto H = duet::hessian(f, Eigen::Vector2d(2, 3)).hessian;
    return H(0, 0) + H(0, 1);
  };
  CHECK(duet::derivative(trace, 5.0).value == 5 * (2 * 3 + 2 * 2));
  CHECK(duet::derivative(trace, 5.0).derivative == 2 * 3 + 2 * 2);
  // The Hessian of a derivative.
  const auto slope = [](const auto& x) {
    const auto inner = [&](auto t) { return sin(t * x[0]) * x[1]; };
    return duet::derivative(inner, 0.7).derivative; // x₀ x₁ cos(0.7 x₀)
  };
  const double a = 1.1;
  const double b = -0.4;
  const auto H = duet::hessian(slope, Eigen::Vector2d(a, b)).hessian;
  const double c = std::cos(0.7 * a);
  const double s = std::sin(0.7 * a);
  CHECK(H(0, 0) == doctest::Approx(b * (-1.4 * s - 0.49 * a * c)).epsilon(1e-14));
  CHECK(H(0, 1) == doctest::Approx(c - 0.7 * a * s).epsilon(1e-14));
  CHECK(H(1, 1) == 0);
}

TEST_CASE("second_order_dual: works in Eigen, Stumpff functions and streams") {
  using D = second_order_dual<double, 4>;
  Eigen::Matrix<D, 2, 2> m;
  m << D::variable(4, 0), D::variable(1, 1), D::variable(2, 2), D::variable(3, 3);
  const D determinant = m.determinant();
  CHECK(determinant == 10);
  CHECK(determinant.second_partial(0, 3) == 1);
  CHECK(determinant.second_partial(1, 2) == -1);
  CHECK(determinant.second_partial(0, 0) == 0);
  // c₂(s) = (1 − cos √s)/s: c₂″(0) = 2/6!
  const D s = D::variable(0, 0);
  CHECK(duet::stumpff<2>(s).second_partial(0, 0) == doctest::Approx(2.0 / 720).epsilon(1e-15));
  std::ostringstream text;
  text << second_order_dual<double, 2>::variable(3, 1) *
              second_order_dual<double, 2>::variable(3, 1);
  CHECK(text.str() == "9[0, 6; 0; 0, 2]");
}

} // namespace
} // namespace test_dual_second_dual
