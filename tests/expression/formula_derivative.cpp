// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/expression/graph/evaluate.hpp>
#include <duet/expression/graph/formula_derivative.hpp>
#include <duet/expression/graph/formula_latex.hpp>
#include <duet/expression/graph/formula_text.hpp>
#include <duet/expression/graph/read_formula.hpp>

namespace test_expression_formula_derivative {

using namespace duet::expression;

TEST_CASE("derivative: formulas from text have the derivatives of dual numbers") {
  for (const char* text :
       {"sin(x)/x*exp(-y*x)", "x^y + y^x", "[x^2, y*x, sqrt(x + y)]", "atan2(x, y)*hypot(x, y)",
        "select(x < y, x*y, abs(-x)) + max(x, 2x)", "exp([x, y, 2])", "log(quaternion(x, y, 1, 2))",
        "slerp(exp([0, x, 0]), exp([y, 0, 0]), x)", "fma(x, x, cbrt(x)) - erf(x) + log1p(x*y)",
        "tanh(x)*asinh(x) - acosh(1 + x) + atanh(x)*2^x", "norm([x, y, x*y]) - log2(x)/expm1(x)"}) {
    CAPTURE(std::string(text));
    const formula_graph f = read_formula(text, {.scalars = {"x", "y"}});
    const formula_graph slope = derivative(f, "x");
    REQUIRE(slope.output_size() == f.output_size());
    const double y = 0.7;
    const auto inputs = [&](const auto& x) {
      using T = std::decay_t<decltype(x)>;
      return std::vector<T>{x, T(y)};
    };
    for (const double x : {0.3, 0.9}) {
      const std::vector<double> found = evaluate(slope, inputs(x));
      for (std::size_t k = 0; k < found.size(); ++k) {
        const double expected =
            duet::derivative([&](const auto& t) { return evaluate(f, inputs(t))[k]; }, x)
                .derivative;
        CHECK(found[k] == doctest::Approx(expected).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("derivative: the slope of tanh keeps its digits where tanh saturates") {
  const formula_graph slope = derivative(read_formula("tanh(x)"), "x");
  CHECK(to_text(slope) == "1 / cosh(x)^2");
  for (const double x : {-30., -10., 1., 20., 300.}) {
    CHECK(evaluate<double>(slope, {x})[0] * std::exp(2 * std::abs(x)) ==
          doctest::Approx(4 / std::pow(1 + std::exp(-2 * std::abs(x)), 2)).epsilon(1e-14));
  }
}

TEST_CASE("derivative: terms of sums are collected") {
  const auto text = [](const char* of) { return to_text(derivative(read_formula(of), "x")); };
  CHECK(text("x*(2 - x)") == "2 - 2 * x");
  CHECK(text("(x - 3)*(5 - x)") == "8 - 2 * x");
  CHECK(text("x*(3*x + 1)") == "6 * x + 1");
  CHECK(text("x*(0.3*x) + x*(0.7*x)") == "0.6 * x + 1.4 * x"); // their sum is rounded
  std::string sum = "x";
  for (int k = 0; k < 3000; ++k) {
    sum += " + x*sin(" + std::to_string(k) + "*x)";
  }
  CHECK(evaluate<double>(derivative(read_formula(sum), "x"), {0.0})[0] == 1);
}

TEST_CASE("derivative: gradients, and what has no derivative") {
  const formula_graph f = read_formula("vector w; dot(w, w) + x");
  const formula_graph gradient = derivative(f, "w");
  CHECK(gradient.outputs()[0].rows == 3);
  CHECK(evaluate<double>(gradient, {1, 2, 3, 4}) == std::vector<double>{2, 4, 6});
  CHECK(to_text(derivative(f, "x")) == "vector w; scalar x; 1");
  const auto message = [](const char* text, const char* input) {
    return duet_test::message_of<duet::invalid_input>(
        [&] { (void)derivative(read_formula(text), input); });
  };
  CHECK(message("x^2", "y") == "duet: the formula has no input 'y'");
  CHECK(message("lgamma(x)", "x") ==
        "duet: derivative: the derivative of a gamma function has no formula");
  CHECK(message("vector w; 2w", "w") ==
        "duet: derivative: the output 'y' has several numbers, as the "
        "input 'w' has (expected a scalar)");
}

TEST_CASE("to_latex: formulas from text are written as typed formulas are") {
  const auto latex = [](const char* text) {
    return to_latex(read_formula(text, {.exact_constants = true}));
  };
  CHECK(latex("exp(-u)*sin(omega*u^2)") == "e^{-u} \\sin\\left(\\omega u^{2}\\right)");
  CHECK(latex("(x*cos(x) - sin(x))/x^2") == "\\frac{x \\cos(x) - \\sin(x)}{x^{2}}");
  CHECK(latex("0.1 θ₁ + pi") == "\\frac{\\theta_{1}}{10} + \\pi");
  CHECK(latex("vector w; norm(w)") == "\\sqrt{w_{0}^{2} + w_{1}^{2} + w_{2}^{2}}");
  CHECK(latex("[x, 1/2, -x]") == "\\begin{bmatrix}x\\\\0.5\\\\-x\\end{bmatrix}");
  CHECK(latex("rotation q; conj(q)") == "\\left(q_{0}, -q_{1}, -q_{2}, -q_{3}\\right)");
  CHECK(latex("select(x <= 1 && !(y < x), x^(1/3), log2(abs(x)))") ==
        "\\begin{cases}x^{1/3} & \\left(x \\le 1\\right) \\land \\lnot \\left(y < x\\right)\\\\"
        "\\log_{2}\\left(\\left|x\\right|\\right) & \\text{else}\\end{cases}");
  const std::string doubled = "a = x*y; b = sin(a)*cos(a); c = sin(b)*cos(b); d = sin(c)*cos(c); "
                              "e = sin(d)*cos(d); f = sin(e)*cos(e); g = sin(f)*cos(f); "
                              "h = sin(g)*cos(g); i = sin(h)*cos(h); j = sin(i)*cos(i); j";
  CHECK(duet_test::message_of<duet::invalid_input>([&] { (void)latex(doubled.c_str()); }) ==
        "duet: to_latex: the formula has more than 2000 operations");
}

} // namespace test_expression_formula_derivative
