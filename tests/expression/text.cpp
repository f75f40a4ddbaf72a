// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

namespace test_expression_text {
namespace {

using namespace duet::expression;

constexpr symbol<"x"> x;
constexpr symbol<"y"> y;
constexpr symbol<"theta1"> theta1;
constexpr symbol<"omega_max"> omega_max;
constexpr symbol<"mass"> mass;

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

TEST_CASE("text: signs and exact products of numbers come first, and 0/0 stays") {
  CHECK(to_text(c<-2> * x * (c<3> * y)) == "-6 * x * y");
  CHECK(to_text(0.1_c * x * c<-3>) == "-3 * 0.1 * x");
  CHECK(to_text(x / c<-3>) == "-x / 3");
  CHECK(to_text(c<0> / c<0> + x) == "0 / 0 + x");
  CHECK(to_text(c<0> / y + x) == "x");
}

TEST_CASE("constants to the last digit") {
  constexpr quaternion_symbol<"q"> q;
  constexpr pose_symbol<"A"> a;
  constexpr vector_symbol<"w"> w;
  constexpr dual_vector_symbol<"l"> l;
  const double third = 1 / 3.;
  CHECK(to_text(x * third) == "x * 0.3333333333333333");
  CHECK(to_text(cross(w, Eigen::Vector3d(third, 1e-7, -2))) ==
        "cross(w, (0.3333333333333333, 1e-07, -2))");
  CHECK(to_latex(cross(w, Eigen::Vector3d(third, 1e-7, -2))) ==
        "\\vec{w} \\times (0.3333333333333333, 10^{-7}, -2)");
  CHECK(to_text(q * duet::quaternion<double>(third, 0, -.5, 1e22)) ==
        "q * (0.3333333333333333, 0, -0.5, 1e+22)");
  using duet::screw_tag;
  const auto half = duet::dual<double, 1, screw_tag>(third, .5);
  const auto minus = duet::dual<double, 1, screw_tag>(0, -third);
  const duet::dual_quaternion<double> constant(half, minus, half, minus);
  CHECK(to_text(a * constant) ==
        "A * (0.3333333333333333[0.5], 0[-0.3333333333333333], 0.3333333333333333[0.5], "
        "0[-0.3333333333333333])");
  CHECK(to_latex(a * constant) ==
        "A (0.3333333333333333 + 0.5 \\varepsilon, 0 - 0.3333333333333333 \\varepsilon, "
        "0.3333333333333333 + 0.5 \\varepsilon, 0 - 0.3333333333333333 \\varepsilon)");
  CHECK(to_text(cross(l, duet::dual_vector<double>(half, minus, half))) ==
        "cross(l, (0.3333333333333333[0.5], 0[-0.3333333333333333], 0.3333333333333333[0.5]))");
  CHECK(
      to_text(x * duet_test::real_50(.1L)).starts_with("x * 0.1000000000000000000013552527156068"));
  CHECK(to_latex(dual_part(l)) == "\\operatorname{dual}(l)");
  CHECK(to_latex(real_part(l)) == "\\operatorname{real}(l)");
}

TEST_CASE("derivatives as text") {
  CHECK(to_text(derivative(sin(x * x), x)) == "2 * cos(x^2) * x");
  CHECK(to_text(derivative(x * exp(-x), x)) == "exp(-x) - x * exp(-x)");
  CHECK(to_text(derivative(log(x) / x, x)) == "(1 / x - log(x) / x) / x");
  CHECK(to_text(derivative(pow(x, c<-2>), x)) == "-2 * x^-3");
  CHECK(to_text(derivative(x * y, y)) == "x");
  CHECK(to_text(derivative(x * (2 - x), x)) == "2 - 2 * x");
  CHECK(to_text(derivative((2_c + x) * x, x)) == "2 + 2 * x");
  CHECK(to_text(derivative(sqrt(x * x), x)) == "2 * x / (2 * sqrt(x^2))");
  CHECK(to_text(derivative(tanh(x + y), x)) == "1 / cosh(x + y)^2");
  CHECK(to_text(derivative(pow(x, 2.5_c), x)) == "2.5 * x^1.5");
  CHECK(to_text(derivative(pow(x, 0.6_c), x)) == "0.6 * x^(-0.4)"); // 0.6 + 1 is not exact
  CHECK(to_text(derivative(pow(x, y), x)) == "y * x^(y - 1)");
  CHECK(to_text(derivative(x * acos(y), y)) == "-x / sqrt(1 - y^2)");
  CHECK(to_text(derivative(atan2(y + 1, x), x)) == "-(y + 1) / (x^2 + (y + 1)^2)");
  CHECK(to_text(derivative(derivative(atan(x), x), x)) == "-2 * x / (1 + x^2) / (1 + x^2)");
  CHECK(to_text(derivative(derivative(tan(x), x), x)) == "2 * tan(x) * (1 + tan(x)^2)");
}

TEST_CASE("LaTeX") {
  CHECK(to_latex(theta1 + omega_max * mass) == R"(\theta_{1} + \omega_{max} \mathrm{mass})");
  CHECK(to_latex((x + 1) / sqrt(x * y)) == R"(\frac{x + 1}{\sqrt{x y}})");
  CHECK(to_latex(exp(-x * x) * sin(x)) == R"(e^{-x^{2}} \sin(x))");
  CHECK(to_latex(erf(x) + asin(x * x)) == R"(\operatorname{erf}(x) + \arcsin\left(x^{2}\right))");
  CHECK(to_latex(2.5e-7 * x) == R"(2.5 \cdot 10^{-7} x)");
  CHECK(to_latex(std::numeric_limits<double>::infinity() * x) == R"(\infty x)");
  CHECK(to_latex(-std::numeric_limits<double>::infinity() * x) == R"(-\infty x)");
  CHECK(to_latex(x * 1e20) == R"(10^{20} x)");
  CHECK(to_latex(pow(-2.5e-7 * x, c<2>)) == R"(\left(2.5 \cdot 10^{-7}\right)^{2} x^{2})");
  CHECK(to_latex(abs(x)) == R"(\left|x\right|)");
  CHECK(to_latex(select(x < y / 2, x / y, y)) ==
        R"(\begin{cases}x/y & x < y/2\\y & \text{else}\end{cases})");
}

TEST_CASE("LaTeX: one fraction, and slashes in exponents and arguments") {
  CHECK(to_latex(x / y / mass) == R"(\frac{x}{y \mathrm{mass}})");
  CHECK(to_latex(x / (y / theta1)) == R"(\frac{x \theta_{1}}{y})");
  CHECK(to_latex((x / y) / (theta1 / x)) == R"(\frac{x^{2}}{y \theta_{1}})");
  CHECK(to_latex(1 / (1 + 1 / x)) == R"(\frac{x}{x + 1})");
  CHECK(to_latex((x / 2 + y) / (3 * x)) == R"(\frac{x + 2 y}{6 x})");
  CHECK(to_latex(x * (1 + 1 / y)) == R"(x \left(1 + \frac{1}{y}\right))");
  CHECK(to_latex(2 * (1 / y - x / y)) == R"(\frac{2 \left(1 - x\right)}{y})");
  CHECK(to_latex((1 / (x + y) - 1 / x) / y) == R"(-\frac{1}{x \left(x + y\right)})");
  CHECK(to_latex((x * (x + y) / theta1 - x * x / theta1 - x * y / theta1) / y) == "0");
  CHECK(to_latex(exp(-x * x / 2) / y) == R"(\frac{e^{-x^{2}/2}}{y})");
  CHECK(to_latex(sin(x / (2 * y))) == R"(\sin\left(x/\left(2 y\right)\right))");
  CHECK(to_latex(pow(x, (x + 1) / y)) == R"(x^{\left(x + 1\right)/y})");
  CHECK(to_latex(pow(x / y, theta1)) == R"(\left(x/y\right)^{\theta_{1}})");
  CHECK(to_latex(sqrt(1 + 1 / x) / y) == R"(\frac{\sqrt{1 + 1/x}}{y})");
}

TEST_CASE("LaTeX: powers, numbers and signs") {
  CHECK(to_latex(x * x * y * x) == R"(x^{3} y)");
  CHECK(to_latex(sin(x) * 2 * x * pi * 0.5) == R"(2 \cdot 0.5 \pi x \sin(x))");
  CHECK(to_latex(pow(x / y, c<2>)) == R"(\frac{x^{2}}{y^{2}})");
  CHECK(to_latex(pow(x, c<-2>) * y) == R"(\frac{y}{x^{2}})");
  CHECK(to_latex(pow(x, -1)) == R"(\frac{1}{x})");
  CHECK(to_latex(pow(x * y, 0.5)) == R"(\left(x y\right)^{0.5})");
  CHECK(to_latex(pow(sin(x), c<2>)) == R"(\sin^{2}(x))");
  CHECK(to_latex(pow(log2(x), c<2>) + exp2(x / y)) == R"(\log_{2}^{2}(x) + 2^{x/y})");
  CHECK(to_latex(pow(exp2(x), c<2>) * log10(x)) == R"(\left(2^{x}\right)^{2} \log_{10}(x))");
  CHECK(to_latex(pow(lgamma(x), c<2>)) == R"(\left(\log\Gamma(x)\right)^{2})");
  CHECK(to_latex(pow(exp(x), c<2>) * exp(x)) == R"(e^{3 x})");
  CHECK(to_latex(sqrt(x) * x * sqrt(y)) == R"(x^{3/2} \sqrt{y})");
  CHECK(to_latex(sqrt(x * y) * sqrt(x * y)) == R"(x y)");
  CHECK(to_latex(sqrt(x * x)) == R"(\sqrt{x^{2}})");
  CHECK(to_latex(3 * x / (6 * y)) == R"(\frac{x}{2 y})");
  CHECK(to_latex(pow(2 * x, c<16>) * pow(3 * y, c<16>)) == R"(65536 \cdot 43046721 x^{16} y^{16})");
  CHECK(to_latex(1 / (x * 0.0)) == R"(\frac{1}{0})");
  CHECK(to_latex((x - y) * (y - x)) == R"(-\left(x - y\right)^{2})");
  CHECK(to_latex((x + y) / (y + x)) == "1");
  CHECK(to_latex(x + (-1) * y) == R"(x - y)");
  CHECK(to_latex(x - -2.5) == R"(x + 2.5)");
  CHECK(to_latex(x + y - (x - y)) == R"(2 y)");
  CHECK(to_latex(x - 2 * (y - 1)) == R"(x - 2 \left(y - 1\right))");
  CHECK(to_latex(-x / y) == R"(-\frac{x}{y})");
}

TEST_CASE("LaTeX of derivatives") {
  const auto second = [](const auto& f) { return derivative(derivative(f, x), x); };
  CHECK(to_latex(derivative(sin(x) / x, x)) == R"(\frac{x \cos(x) - \sin(x)}{x^{2}})");
  CHECK(to_latex(derivative(exp(-x * x / 2), x)) == R"(-x e^{-x^{2}/2})");
  CHECK(to_latex(second(sqrt(1 + x * x))) == R"(\frac{1}{\left(1 + x^{2}\right)^{3/2}})");
  CHECK(to_latex(second(1 / (1 + x * x))) ==
        R"(-\frac{2 \left(1 - 3 x^{2}\right)}{\left(1 + x^{2}\right)^{3}})");
  CHECK(to_latex(derivative(x * x * x * x / (1 + x * x), x)) ==
        R"(\frac{2 x^{3} \left(2 + x^{2}\right)}{\left(1 + x^{2}\right)^{2}})");
  CHECK(to_latex(derivative(1 / (1 + exp(-x)), x)) ==
        R"(\frac{e^{-x}}{\left(1 + e^{-x}\right)^{2}})");
  CHECK(to_latex(derivative(hypot(x, y), x)) == R"(\frac{x}{\sqrt{x^{2} + y^{2}}})");
  CHECK(to_latex(derivative(atan(x / y), y)) == R"(-\frac{x}{y^{2} + x^{2}})");
}

TEST_CASE("LaTeX of what does not commute") {
  constexpr quaternion_symbol<"q"> q;
  constexpr vector_symbol<"n"> n;
  constexpr vector_symbol<"v"> v;
  constexpr matrix_symbol<"A", 3, 3> A;
  CHECK(to_latex(x / y * n) == R"(\frac{x}{y} \vec{n})");
  CHECK(to_latex(n / 2) == R"(\frac{\vec{n}}{2})");
  CHECK(to_latex((x * n + v / y) / 2) ==
        R"(\frac{1}{2} \left(x \vec{n} + \frac{\vec{v}}{y}\right))");
  CHECK(to_latex(q * x * exp(x / 2 * n) * q * x) == R"(x^{2} q e^{x \vec{n}/2} q)");
  CHECK(to_latex(A * cross(n, 2 * v)) == R"(2 A \left(\vec{n} \times \vec{v}\right))");
  CHECK(to_latex(A * rotate(q, n)) == R"(A \left(q \vec{n} q^{*}\right))");
  CHECK(to_latex(transpose(n) * A * n / 2) == R"(\frac{\vec{n}^{\top} A \vec{n}}{2})");
  CHECK(to_text(translation_along(axis::x, x)) == "translation_along(e1, x)");
  constexpr auto row = transpose(real_part(axis::y)); // zeros that are known
  CHECK(to_text(row) == "[0, 1, 0]");
  CHECK(to_text(n * row) == "[0, n[0], 0; 0, n[1], 0; 0, n[2], 0]");
  CHECK(to_latex(translation_along(axis::x, x)) ==
        R"(\operatorname{Trans}\left(\vec{e}_{1}, x\right))");
  CHECK(to_latex(x * dot(n, v) * norm(v)) ==
        R"(x \left(\vec{n} \cdot \vec{v}\right) \left|\vec{v}\right|)");
  CHECK(
      to_latex(derivative(norm(v + x * n), x)) ==
      R"(\frac{\left(\vec{v} + x \vec{n}\right) \cdot \vec{n}}{\left|\vec{v} + x \vec{n}\right|})");
  CHECK(to_latex(derivative(rotation_about(n, x * x), x)) == R"(x \vec{n} e^{x^{2} \vec{n}/2})");
  CHECK(to_latex(solve(A, 2 * A * v)) == R"(2 A^{-1} A \vec{v})");
}

} // namespace
} // namespace test_expression_text
