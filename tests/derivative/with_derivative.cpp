// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/core/batch/batch.hpp>
#include <duet/core/batch/math.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/with_derivative.hpp>
#include <duet/dual/math.hpp>
#include <duet/expression/arithmetic.hpp>
#include <duet/expression/gradient.hpp>
#include <duet/expression/graph/formula_derivative.hpp>
#include <duet/expression/graph/reverse.hpp>
#include <duet/expression/graph/trace.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/text.hpp>

namespace test_derivative_with_derivative {
namespace {

using duet::derivative, duet::derivatives, duet::with_derivative;

/// eˣ as another library would give it.
double exponential(double x) { return std::exp(x); }

const auto generic_exp = [](const auto& x) {
  using std::exp;
  return exp(x);
};
const auto wrapped = with_derivative(exponential, generic_exp);

TEST_CASE("with_derivative: derivatives of every order and kind come from the given one") {
  const double e = std::exp(0.5);
  CHECK(wrapped(0.5) == e);
  CHECK(wrapped(1) == std::exp(1.0));
  CHECK(wrapped(0.5F) == doctest::Approx(e));
  CHECK(derivative(wrapped, 0.5).derivative == e);
  const auto three = derivatives<3>([](const auto& x) { return wrapped(2 * x); }, 0.25);
  for (int k = 0; k <= 3; ++k) {
    CHECK(three[std::size_t(k)] == doctest::Approx(std::pow(2, k) * e));
  }
  const auto nested = [](const auto& x) {
    return derivative([](const auto& y) { return wrapped(y * y); }, x).derivative; // 2x exp x²
  };
  CHECK(derivative(nested, 0.5).derivative == doctest::Approx((2 + 4 * 0.25) * std::exp(0.25)));
  const auto of_vector = [](const auto& x) { return wrapped(x[0] * x[1]); };
  const auto h = duet::hessian(of_vector, Eigen::Vector2d(0.5, 2));
  CHECK(h.gradient.isApprox(std::exp(1.0) * Eigen::Vector2d(2, 0.5)));
  CHECK(h.hessian(0, 1) == doctest::Approx(std::exp(1.0) * 2));
}

TEST_CASE("with_derivative: the given derivative is used, not that of the function") {
  const auto f = with_derivative([](const auto& x) { return x * x; }, [](double) { return 7.0; });
  CHECK(derivative(f, 3.0).value == 9);
  CHECK(derivative(f, 3.0).derivative == 7);
  CHECK(f(duet::dual<double, 2>(3.0)).partial(1) == 0);
}

TEST_CASE("with_derivative: rules of double alone, one for each order") {
  const auto second =
      with_derivative([](double x) { return -std::sin(x); }, [](double x) { return -std::cos(x); });
  const auto first = with_derivative([](double x) { return std::cos(x); }, second);
  const auto sine = with_derivative([](double x) { return std::sin(x); }, first);
  const auto y = derivatives<3>(sine, 0.3);
  CHECK(y[2] == doctest::Approx(-std::sin(0.3)));
  CHECK(y[3] == doctest::Approx(-std::cos(0.3)));
}

TEST_CASE("with_derivative: batches, lane by lane or at once") {
  using batch = duet::batch<double>;
  const auto x = batch::from_lanes([](int i) { return 0.1 * i; });
  const auto y = derivative(wrapped, x);
  for (int i = 0; i < batch::lanes; ++i) {
    CHECK(y.value[i] == std::exp(0.1 * i));
    CHECK(y.derivative[i] == std::exp(0.1 * i));
  }
}

TEST_CASE("with_derivative: several arguments, and constants beside variables") {
  const auto power = with_derivative([](double x, double p) { return std::pow(x, p); },
                                     [](const auto& x, const auto& p) {
                                       using std::pow;
                                       return p * pow(x, p - 1);
                                     },
                                     [](const auto& x, const auto& p) {
                                       using std::log, std::pow;
                                       return log(x) * pow(x, p);
                                     });
  const auto [y, dy] =
      duet::gradient([&](const auto& x) { return power(x[0], x[1]); }, Eigen::Vector2d(2, 3));
  CHECK(y == 8);
  CHECK(dy.isApprox(Eigen::Vector2d(12, 8 * std::log(2))));
  CHECK(derivatives<2>([&](const auto& x) { return power(x, 3); }, 2.0)[2] == doctest::Approx(12));
  const auto product = [](const auto& a, const auto& b, const auto& c) { return a * b * c; };
  const auto volume = with_derivative(
      product, [](const auto&, const auto& b, const auto& c) { return b * c; },
      [](const auto& a, const auto&, const auto& c) { return a * c; },
      [](const auto& a, const auto& b, const auto&) { return a * b; });
  const auto h = duet::hessian([&](const auto& x) { return volume(x[0], x[1], x[2]); },
                               Eigen::Vector3d(1, 2, 3));
  CHECK(h.gradient == Eigen::Vector3d(6, 3, 2));
  CHECK(h.hessian(0, 2) == 2);
}

TEST_CASE("with_derivative: traces record the function, and the derivative where it is asked for") {
  constexpr duet::expression::symbol<"u"> u;
  const auto f =
      with_derivative([](const auto& x) { return x * x; }, [](const auto& x) { return 3 * x; });
  CHECK(duet::expression::trace(f, u)(u = 2.0) == 4);
  const auto slope =
      duet::expression::trace([&](const auto& x) { return derivative(f, x).derivative; }, u);
  CHECK(slope(u = 2.0) == 6);
  CHECK(duet::derivative([&](const auto& x) { return slope(u = x); }, 2.0).derivative == 3);
  CHECK(evaluate(duet::expression::reverse_gradient(slope, {"u"}), std::vector{2.0}) ==
        std::vector{6.0, 3.0});
  // The trace itself has the derivative of x², so it is not differentiated.
  const auto traced = duet::expression::trace([&](const auto& x) { return 1 + f(x); }, u);
  const std::string refusal = "duet: the formula has a function of with_derivative, whose given "
                              "derivative is not recorded (trace the derivative, or use a typed "
                              "formula)";
  CHECK(traced(u = 2.0) == 5);
  CHECK(duet_test::message_of([&] {
          (void)duet::derivative([&](const auto& x) { return traced(u = x); }, 2.0);
        }) == refusal);
  CHECK(duet_test::message_of([&] { (void)duet::expression::reverse_gradient(traced, {"u"}); }) ==
        refusal);
  CHECK(duet_test::message_of([&] { (void)duet::expression::derivative(traced, "u"); }) == refusal);
}

TEST_CASE("with_derivative: typed formulas have the given derivative, of every order") {
  using namespace duet::expression;
  constexpr symbol<"u"> u;
  constexpr symbol<"v"> v;
  // 7 instead of 1, so that the derivative can come from nowhere else.
  constexpr auto g = with_derivative([](double x) { return exponential(x); },
                                     [](const auto& x) { return 7 * generic_exp(x); });
  constexpr auto f = g(u * v) * u;
  CHECK(to_text(f) == "f(u * v) * u");
  CHECK(to_text(derivative(f, u)) == "f'(u * v) * v * u + f(u * v)");
  CHECK(to_latex(derivative(derivative(f, u), u)) == "v^{2} u f''(u v) + 2 v f'(u v)");
  const auto generic = [g](const auto& x) { return g(x[0] * x[1]) * x[0]; };
  duet_test::random_source random(2);
  for (int i = 0; i < 100; ++i) {
    const double a = i == 0 ? 0 : random.normal(), b = i < 2 ? 0 : random.normal();
    const auto typed = hessian(f, wrt(u, v))(u = a, v = b);
    const auto dual = duet::hessian(generic, Eigen::Vector2d(a, b));
    const double size = 1 + dual.hessian.norm();
    CHECK(typed.value == dual.value);
    CHECK((typed.gradient - dual.gradient).norm() <= 1e-14 * size);
    CHECK((typed.hessian - dual.hessian).norm() <= 1e-14 * size);
    CHECK(std::abs(derivative(f, u)(u = a, v = b) - dual.gradient[0]) <= 1e-14 * size);
    CHECK(std::abs(gradient(f, wrt(v))(u = a, v = b).gradient[0] - dual.gradient[1]) <=
          1e-14 * size);
    // Over dual numbers, the next derivative.
    const auto along = [&](const auto& x) { return derivative(f, u)(u = x, v = b); };
    CHECK(std::abs(duet::derivative(along, a).derivative - dual.hessian(0, 0)) <= 1e-14 * size);
  }
}

/// A function object with a name, whose rule for higher orders is itself.
struct root_function {
  static constexpr const char* name = "root";
  double operator()(double x) const { return std::sqrt(x); }
};
struct root_slope {
  auto operator()(const auto& x) const {
    return 0.5 / with_derivative(root_function(), root_slope())(x);
  }
};

TEST_CASE("with_derivative: typed formulas of function objects and of several arguments") {
  using namespace duet::expression;
  constexpr symbol<"u"> u;
  constexpr symbol<"v"> v;
  constexpr auto root = with_derivative(root_function(), root_slope());
  const auto third = derivative(derivative(derivative(root(u), u), u), u);
  CHECK(to_text(derivative(root(u), u)) == "root'(u)");
  CHECK(to_latex(third) == "\\operatorname{root}'''(u)");
  CHECK(third(u = 4.0) == doctest::Approx(3.0 / 256));
  CHECK(to_text(derivative(third, u)) == "root^(4)(u)");
  // A rule that is with_derivative itself, of double alone.
  constexpr auto slope = with_derivative([](double x) { return 2 * x; }, [](double) { return 2.; });
  constexpr auto square = with_derivative([](double x) { return x * x; }, slope);
  CHECK(derivative(derivative(square(u), u), u)(u = 3.0) == 2);
  constexpr auto product =
      with_derivative([](double x, double y) { return x * y; }, [](auto, auto y) { return y; },
                      [](auto x, auto) { return x; });
  const auto h = product(u, v * v);
  CHECK(to_text(derivative(derivative(h, v), u)) == "2 * f^(1,1)(u, v^2) * v");
  CHECK(to_latex(derivative(h, v)) == "2 v f^{(0,1)}\\left(u, v^{2}\\right)");
  CHECK(derivative(h, v)(u = 3.0, v = 5.0) == 30);
  CHECK(hessian(h, wrt(u, v))(u = 3.0, v = 5.0).hessian ==
        (Eigen::Matrix2d() << 0, 10, 10, 6).finished());
  CHECK(product(u, c<2>)(u = 3.0) == 6);
}

} // namespace
} // namespace test_derivative_with_derivative
