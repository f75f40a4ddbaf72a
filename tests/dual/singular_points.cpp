// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/math.hpp>

#include <Eigen/Core>

#include <initializer_list>

// The tables of docs/reference/singular_points.md, line by line.
// Every line is checked in several numbers: values bit by bit against plain numbers, the derivative
// by each argument where the others are arithmetic constants, constants and variables.

namespace test_dual_singular_points {
namespace {

using duet::dual, duet::taylor;

using std::abs, std::acos, std::acosh, std::asin, std::atan, std::atan2, std::atanh, std::cbrt,
    std::erf, std::exp, std::fdim, std::floor, std::fmax, std::fmin, std::fmod, std::hypot,
    std::lgamma, std::log, std::log1p, std::max, std::pow, std::sin, std::sqrt, std::tan, std::tanh,
    std::tgamma;

struct outer_tag;

using inner = dual<double>;
using nested = dual<inner, 1, outer_tag>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
using std::numbers::pi;
const double ln2 = std::log(2.0);

/// The same value and sign, or both NaN.
template <class T>
bool identical(T a, T b) {
  return a != a ? b != b : a == b && std::signbit(a) == std::signbit(b);
}

template <class T>
bool agrees(T x, double expected) {
  if (expected != expected) {
    return x != x;
  }
  if (expected == 0 || std::isinf(expected)) {
    return x == T(expected);
  }
  return std::abs(x - T(expected)) <= 4 * std::numeric_limits<T>::epsilon() * T(abs(expected));
}

/// True if all infinitesimal parts of y are the expected ones.
template <class D>
[[gnu::noinline]] bool parts_agree(const D& y, double expected) {
  const auto part_agrees = [&](const auto& part) {
    if constexpr (duet::Infinitesimal<std::remove_cvref_t<decltype(part)>>) {
      return agrees(part.value(), expected) && parts_agree(part, expected);
    } else {
      return agrees(part, expected);
    }
  };
  bool result = true;
  if constexpr (duet::Infinitesimal<typename D::value_type>) {
    result = parts_agree(y.value(), expected);
  }
  if constexpr (requires { y.partials(); }) {
    for (int i = 0; i < y.size(); ++i) {
      result = result && part_agrees(y.partial(i));
    }
  } else {
    using below = typename D::value_type;
    constexpr int highest = duet::scalar_traits<D>::order - duet::scalar_traits<below>::order;
    for (int k = 1; k <= highest; ++k) {
      result = result && part_agrees(y.coefficient(k));
    }
  }
  return result;
}

// The checks are separate functions: within `check_line` they would be compiled for every
// function.

template <class T>
[[gnu::noinline]] void check_identical(const char* what, T a, T b) {
  CAPTURE(what);
  CAPTURE(a);
  CAPTURE(b);
  CHECK(identical(a, b));
}

template <class T>
[[gnu::noinline]] void check_agrees(const char* what, T x, double expected) {
  CAPTURE(what);
  CAPTURE(x);
  CAPTURE(expected);
  CHECK(agrees(x, expected));
}

template <class D>
[[gnu::noinline]] void check_parts(const char* what, const D& y, double expected) {
  CAPTURE(what);
  CAPTURE(expected);
  CHECK(parts_agree(y, expected));
}

/// f(argument(0), …, argument(M − 1)), the indices as types.
template <std::size_t M, class F, class Argument>
auto call(F f, Argument argument) {
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return f(argument(std::integral_constant<std::size_t, I>())...);
  }
  (std::make_index_sequence<M>());
}

template <std::size_t M>
using numbers = std::array<double, M>;

template <class D, std::size_t M, class F>
[[gnu::noinline]] void check_constants(F f, const numbers<M>& x, double constant) {
  using real = duet::real_type_t<D>;
  const auto value = real(call<M>(f, [&](auto i) { return real(x[i]); }));
  const D y = call<M>(f, [&](auto i) { return D(real(x[i])); });
  check_identical("duet::innermost(y)", duet::innermost(y), value);
  check_parts("y", y, constant);
}

/// The derivative with respect to argument I.
template <std::size_t I, std::size_t M, class F>
[[gnu::noinline]] void check_variable(F f, const numbers<M>& x, double slope, double constant) {
  // Argument I is `moving`, the others are constants of type U.
  const auto at = [&]<class D, class U>(std::type_identity<U>, const D& moving) {
    return call<M>(f, [&]<class J>(J) {
      if constexpr (J::value == I) {
        return moving;
      } else {
        return U(x[J::value]);
      }
    });
  };
  const auto same = [&]<class D>(const D& moving) { return at(std::type_identity<D>(), moving); };
  const double value = call<M>(f, [&](auto i) { return x[i]; });

  const auto y = same(inner::variable(x[I]));
  check_identical("y.value()", y.value(), value);
  check_agrees("y.epsilon()", y.epsilon(), slope);
  check_agrees("at(std::type_identity<double>(), inner::variable(x[I])).epsilon()",
               at(std::type_identity<double>(), inner::variable(x[I])).epsilon(), slope);

  const auto all = call<M>(f, [&](auto i) { return dual<double, 3>::variable(x[i], int(i())); });
  check_identical("all.value()", all.value(), value);
  check_agrees("all.partial(I)", all.partial(I), slope);
  check_agrees("all.partial(2)", all.partial(2), constant);

  const auto series = same(taylor<double, 2>::variable(x[I]));
  check_identical("series.value()", series.value(), value);
  check_agrees("series.coefficient(1)", series.coefficient(1), slope);

  const auto outer = same(nested::variable(inner(x[I])));
  check_identical("outer.value().value()", outer.value().value(), value);
  check_agrees("outer.epsilon().value()", outer.epsilon().value(), slope);
  check_parts("outer.value()", outer.value(), constant);
  const auto within = same(nested(inner::variable(x[I])));
  check_agrees("within.value().epsilon()", within.value().epsilon(), slope);
  check_agrees("within.epsilon().value()", within.epsilon().value(), constant);
  check_parts("within.epsilon()", within.epsilon(), constant);
  const auto both = same(nested::variable(inner::variable(x[I])));
  check_agrees("both.value().epsilon()", both.value().epsilon(), slope);
  check_agrees("both.epsilon().value()", both.epsilon().value(), slope);

  const auto single = same(dual<float>::variable(float(x[I])));
  check_agrees("single.epsilon()", single.epsilon(), slope);
}

/// One line of a table: value at x, derivatives with respect to every argument and of constants.
template <std::size_t M>
struct line {
  numbers<M> x;
  double value;
  numbers<M> slopes;
  double constant = 0;
};

template <std::size_t M, class F>
[[gnu::noinline]] void check_line(const std::string& name, F f, const line<M>& expected) {
  const numbers<M>& x = expected.x;
  const double constant = expected.constant;
  CAPTURE(name);
  CAPTURE(x[0]);
  CAPTURE(x[M - 1]);
  check_agrees("value", call<M>(f, [&](auto i) { return x[i]; }), expected.value);
  check_constants<inner, M>(f, x, constant);
  check_constants<dual<double, 3>, M>(f, x, constant);
  check_constants<taylor<double, 2>, M>(f, x, constant);
  check_constants<nested, M>(f, x, constant);
  check_constants<taylor<inner, 2, outer_tag>, M>(f, x, constant);
  check_constants<dual<float>, M>(f, x, constant);
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (check_variable<I, M>(f, x, expected.slopes[I], constant), ...);
  }
  (std::make_index_sequence<M>());
}

/// All lines of one function: each function is compiled once.
template <std::size_t M, class F>
void rows(const std::string& name, F f, std::initializer_list<line<M>> lines) {
  for (const line<M>& expected : lines) {
    check_line(name, f, expected);
  }
}

#define DUET_ROWS_1(f, ...) rows<1>(#f, [](const auto& x) { return f; }, {__VA_ARGS__})
#define DUET_ROWS_2(f, ...)                                                                        \
  rows<2>(#f, [](const auto& x, const auto& y) { return f; }, {__VA_ARGS__})

TEST_CASE("singular points: functions of one variable") {
  const double nan = not_a_number;
  DUET_ROWS_1(sqrt(x), {{0}, 0, {infinity}}, {{-0.0}, 0, {-infinity}}, {{-1}, nan, {nan}});
  DUET_ROWS_1(cbrt(x), {{0}, 0, {infinity}});
  DUET_ROWS_1(1 / x, {{0}, infinity, {-infinity}}, {{-0.0}, -infinity, {-infinity}});
  DUET_ROWS_1(x / 0, {{1}, infinity, {infinity}}, {{0}, nan, {infinity}});
  DUET_ROWS_1(x / x, {{0}, nan, {nan}});
  DUET_ROWS_1(log(x), {{0}, -infinity, {infinity}}, {{-1}, nan, {-1}}, {{infinity}, infinity, {0}});
  DUET_ROWS_1(log1p(x), {{-1}, -infinity, {infinity}});
  DUET_ROWS_1(exp(x), {{800}, infinity, {infinity}}, {{-800}, 0, {0}});
  DUET_ROWS_1(sin(x), {{infinity}, nan, {nan}});
  DUET_ROWS_1(tan(x), {{infinity}, nan, {nan}});
  DUET_ROWS_1(asin(x), {{1}, pi / 2, {infinity}}, {{-1}, -pi / 2, {infinity}});
  DUET_ROWS_1(acos(x), {{1}, 0, {-infinity}}, {{2}, nan, {nan}});
  DUET_ROWS_1(atan(x), {{infinity}, pi / 2, {0}});
  DUET_ROWS_1(tanh(x), {{800}, 1, {0}});
  DUET_ROWS_1(acosh(x), {{1}, 0, {infinity}});
  DUET_ROWS_1(atanh(x), {{1}, infinity, {infinity}}, {{-1}, -infinity, {infinity}},
              {{2}, nan, {-1.0 / 3}});
  DUET_ROWS_1(erf(x), {{800}, 1, {0}});
  DUET_ROWS_1(tgamma(x), {{0}, infinity, {-infinity}});
  DUET_ROWS_1(lgamma(x), {{0}, infinity, {-infinity}});
  DUET_ROWS_1(abs(x), {{0}, 0, {1}}, {{-0.0}, 0, {-1}});
  DUET_ROWS_1(floor(x), {{1}, 1, {0}});
}

TEST_CASE("singular points: functions of two variables") {
  const double nan = not_a_number;
  DUET_ROWS_2(hypot(x, y), {{0, 0}, 0, {nan, nan}}, {{0, 2}, 2, {0, 1}});
  DUET_ROWS_2(atan2(x, y), {{0, 0}, 0, {nan, nan}}, {{0, -1}, pi, {-1, 0}},
              {{-0.0, -1}, -pi, {-1, 0}});
  DUET_ROWS_2(fmax(x, y), {{1, 1}, 1, {1, 0}});
  DUET_ROWS_2(fmin(x, y), {{1, 1}, 1, {1, 0}});
  DUET_ROWS_2(fdim(x, y), {{1, 1}, 0, {0, 0}});
  DUET_ROWS_2(fmod(x, y), {{1, 0}, nan, {1, nan}});
}

TEST_CASE("singular points: the nine cases of pow") {
  const double nan = not_a_number;
  DUET_ROWS_2(pow(x, y), {{2, 3}, 8, {12, 8 * ln2}}, {{2, 0}, 1, {0, ln2}}, {{0, 2}, 0, {0, 0}},
              {{0, 1}, 0, {1, 0}}, {{0, 0.5}, 0, {infinity, 0}}, {{0, 0}, 1, {0, -infinity}},
              {{0, -1}, infinity, {-infinity, -infinity}}, {{-2, 2}, 4, {-4, nan}},
              {{-2, 0}, 1, {0, nan}}, {{-2, -1}, -0.5, {-0.25, nan}}, {{-2, 0.5}, nan, {nan, nan}},
              {{infinity, 0}, 1, {0, infinity}}, {{infinity, 2}, infinity, {infinity, infinity}},
              {{infinity, -2}, 0, {0, 0}});
}

TEST_CASE("singular points: compositions") {
  const double nan = not_a_number;
  DUET_ROWS_1(sqrt(x * x), {{0}, 0, {0}});
  DUET_ROWS_2(sqrt(x * x + y * y), {{0, 0}, 0, {0, 0}});
  rows<2>("norm of (x, y)",
          [](const auto& x, const auto& y) {
            using T = std::common_type_t<decltype(x), decltype(y)>;
            return Eigen::Matrix<T, 2, 1>(T(x), T(y)).norm();
          },
          {{{0, 0}, 0, {0, 0}}});
  DUET_ROWS_1(x * log(x), {{0}, nan, {nan}, nan});
  DUET_ROWS_1(x * infinity, {{1}, infinity, {infinity}, nan});
}

TEST_CASE("singular points: std::max and std::min take the first of equal numbers") {
  const auto x = dual<double, 2>::variable(1, 0);
  const auto y = dual<double, 2>::variable(1, 1);
  CHECK(max(x, y).partial(0) == 1);
  CHECK(max(x, y).partial(1) == 0);
  CHECK(std::min(y, x).partial(1) == 1);
  CHECK(max(x, x).partial(0) == 1);
}

} // namespace
} // namespace test_dual_singular_points
