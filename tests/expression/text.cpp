// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/expression/condition.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/functions_of_many.hpp>
#include <duet/expression/special_functions.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/text.hpp>

#include <doctest/doctest.h>

namespace test_expression_text {
namespace {

using namespace duet::expression;

constexpr symbol<"x"> x;
constexpr symbol<"y"> y;
constexpr symbol<"theta1"> theta1;
constexpr symbol<"omega_max"> omega_max;
constexpr symbol<"mass"> mass;

} // namespace

TEST_CASE("text, with no parentheses too few or too many") {
  CHECK(to_text(x + y - (x - y)) == "x + y - (x - y)");
  CHECK(to_text(x * (y + 1) / (2 * y)) == "x * (y + 1) / (2 * y)");
  CHECK(to_text(x / y / x) == "x / y / x");
  CHECK(to_text(x / (y / x)) == "x / (y / x)");
  CHECK(to_text(-x * y) == "-x * y");
  CHECK(to_text(pow(-x, c<2>)) == "(-x)^2");
  CHECK(to_text(-pow(x, c<2>)) == "-x^2");
  CHECK(to_text(pow(x * y, c<3>)) == "(x * y)^3");
  CHECK(to_text(pow(x, y + 1)) == "x^(y + 1)");
  CHECK(to_text(pow(pow(x, y), c<2>)) == "(x^y)^2");
  CHECK(to_text(x - -2.5) == "x - (-2.5)");
  CHECK(to_text(sin(x + y) * 1e-20) == "sin(x + y) * 1e-20");
  CHECK(to_text(atan2(x, y + 1)) == "atan2(x, y + 1)");
  CHECK(to_text(select(x < y, x, -y)) == "select(x < y, x, -y)");
  CHECK(to_text(pi * x) == "pi * x");
}

TEST_CASE("derivatives as text") {
  CHECK(to_text(derivative(sin(x * x), x)) == "2 * cos(x^2) * x");
  CHECK(to_text(derivative(x * exp(-x), x)) == "exp(-x) - x * exp(-x)");
  CHECK(to_text(derivative(log(x) / x, x)) == "(1 / x - log(x) / x) / x");
  CHECK(to_text(derivative(pow(x, c<-2>), x)) == "-2 * x^-3");
  CHECK(to_text(derivative(x * y, y)) == "x");
  CHECK(to_text(derivative(sqrt(x * x), x)) == "2 * x / (2 * sqrt(x^2))");
  CHECK(to_text(derivative(tanh(x + y), x)) == "1 / cosh(x + y)^2");
  CHECK(to_text(derivative(pow(x, 2.5_c), x)) == "2.5 * x^1.5");
  CHECK(to_text(derivative(pow(x, y), x)) == "y * x^(y - 1)");
  CHECK(to_text(derivative(x * acos(y), y)) == "-x / sqrt(1 - y^2)");
  CHECK(to_text(derivative(atan2(y + 1, x), x)) == "-(y + 1) / (x^2 + (y + 1)^2)");
  CHECK(to_text(derivative(derivative(atan(x), x), x)) == "-2 * x / (1 + x^2) / (1 + x^2)");
  CHECK(to_text(derivative(derivative(tan(x), x), x)) == "2 * tan(x) * (1 + tan(x)^2)");
  CHECK(to_latex(derivative(hypot(x, y), x)) == R"(\frac{x}{\operatorname{hypot}(x, y)})");
}

TEST_CASE("LaTeX") {
  CHECK(to_latex(theta1 + omega_max * mass) == R"(\theta_{1} + \omega_{max} \mathrm{mass})");
  CHECK(to_latex((x + 1) / sqrt(x * y)) == R"(\frac{x + 1}{\sqrt{x y}})");
  CHECK(to_latex(pow(x / y, c<2>)) == R"(\left(\frac{x}{y}\right)^{2})");
  CHECK(to_latex(exp(-x * x) * sin(x)) == R"(e^{-x^{2}} \sin(x))");
  CHECK(to_latex(erf(x) + asin(x * x)) == R"(\operatorname{erf}(x) + \arcsin\left(x^{2}\right))");
  CHECK(to_latex(2.5e-7 * x) == R"(2.5 \cdot 10^{-7} x)");
  CHECK(to_latex(x * 1e20) == R"(x \cdot 10^{20})");
  CHECK(to_latex(abs(x)) == R"(\left|x\right|)");
}

} // namespace test_expression_text
