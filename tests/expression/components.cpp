// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/expression/graph/components.hpp>
#include <duet/expression/graph/evaluate.hpp>
#include <duet/expression/graph/formula_latex.hpp>
#include <duet/expression/graph/read_formula.hpp>

namespace test_expression_components {
namespace {

using namespace duet::expression;

constexpr symbol<"theta1"> t1;
constexpr symbol<"theta2"> t2;
constexpr symbol<"theta3"> t3;
constexpr symbol<"a"> a;
constexpr symbol<"b"> b;
constexpr quaternion_symbol<"q"> q;

constexpr auto planar = screw(axis::z, t1) * translation_along(axis::x, a) * screw(axis::z, t2) *
                        translation_along(axis::x, b);
const auto spatial = screw(axis::z, t1) * translation_along(axis::x, 0.5) * screw(axis::y, t2) *
                     translation_along(axis::x, 0.3) * screw(axis::y, t3) *
                     translation_along(axis::x, 0.2);

/// The largest difference between a formula and its components at random inputs, unit quaternions
/// among them.
template <class F>
double largest_difference(const F& formula) {
  const formula_graph& f = graph_of(formula);
  const formula_graph expanded = components(formula);
  duet_test::random_source random(5);
  double largest = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<double> inputs;
    for (const named_value& x : f.inputs()) {
      double square = 0;
      const std::size_t begin = inputs.size();
      for (std::size_t k = 0; k < x.nodes.size(); ++k) {
        inputs.push_back(round == 0 ? 1 : random.uniform(-4, 4));
        square += inputs.back() * inputs.back();
      }
      for (std::size_t k = begin; x.kind == shape::quaternion && k < inputs.size(); ++k) {
        inputs[k] /= std::sqrt(square);
      }
    }
    const std::vector<double> expected = evaluate(f, inputs), values = evaluate(expanded, inputs);
    REQUIRE(values.size() == expected.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double error = std::abs(values[k] - expected[k]) / (1 + std::abs(expected[k]));
      largest = std::isnan(expected[k]) && std::isnan(values[k]) ? largest
                : error <= largest                               ? largest
                                                                 : error;
    }
  }
  return largest;
}

TEST_CASE("components have the values of their formula") {
  const auto check = [](const auto& f) {
    const double difference = largest_difference(f);
    CAPTURE(difference);
    CHECK(difference < 1e-12);
  };
  check(planar);
  check(spatial);
  check(jacobian(spatial, wrt(t1, t2, t3), duet::frame::spatial));
  check(jacobian(spatial, wrt(t3, t1), duet::frame::hybrid));
  check(motion(screw(axis::z, t1 * t1) * translation_along(axis::y, t1), t1, duet::frame::body));
  check(rotation_matrix(q * rotation(screw(axis::y, t1 / 3)) * q));
  check(sin(t1) * cos(t1) - pow(sin(t1), c<5>) * pow(cos(t1), c<4>));
  check(cos(t1) * cos(t1) - sin(t1) * sin(t1));
  check(cos(t1 - t2) * sin(t2) - sin(t1 / 3) * cos(t2 * 0.7 - t1 / 2) * sin(0.2 - t3));
  check(cos(a * t1) * cos(a * t1) + sin(-b * t1 * t2) / (a * b) - sin(cos(t1)));
  check(sin(t1 / (a + b)) + cos(t1 / a) * sqrt(abs(a * (b + 1))) / (1 + a * a));
  check(select(cos(t1) < sin(t2) * a, exp(a * (b + 1)), tanh(t1 + t2)) * (a + b) / (a * a));
  check(1e-7 * a * t1 - 0.1 * (b - 3e5) * (t1 - 0.3) + pow(a, c<-3>) * b);
  check(hypot(a, b + a * t1) * pow(a * a + 1, b));
  check(sin(t1) * cos(1e-12 * t1) + sin(-1e12 * a) * cos(a) + cos(3e9 * t2) * sin(t2));
  check(screw(axis::z, 5 * t1) * screw(axis::z, -t1) * screw(axis::x, t1 * 1.5707963267948966));
}

TEST_CASE("components as they stand in papers") {
  CHECK(to_latex(components(translation(planar))) ==
        "\\begin{bmatrix}a \\cos\\left(\\theta_{1}\\right) + b \\cos\\left(\\theta_{1} + "
        "\\theta_{2}\\right)\\\\a \\sin\\left(\\theta_{1}\\right) + b \\sin\\left(\\theta_{1} + "
        "\\theta_{2}\\right)\\\\0\\end{bmatrix}");
  CHECK(to_latex(components(component<0>(translation(spatial)))) ==
        "\\cos\\left(\\theta_{1}\\right) \\left(0.5 + 0.3 \\cos\\left(\\theta_{2}\\right) + 0.2 "
        "\\cos\\left(\\theta_{2} + \\theta_{3}\\right)\\right)");
  CHECK(to_latex(components(rotation_matrix(rotation(screw(axis::z, t1))))) ==
        "\\begin{bmatrix}\\cos\\left(\\theta_{1}\\right) & -\\sin\\left(\\theta_{1}\\right) & "
        "0\\\\\\sin\\left(\\theta_{1}\\right) & \\cos\\left(\\theta_{1}\\right) & 0\\\\0 & 0 & "
        "1\\end{bmatrix}");
  CHECK(to_latex(components(cos(a) * cos(a) + sin(a) * sin(a))) == "1");
  CHECK(to_latex(components(sin(a) * sin(a))) == "1 - \\cos^{2}(a)");
  CHECK(to_latex(components(sin(a) * cos(b) - cos(a) * sin(b))) == "\\sin(a - b)");
  CHECK(to_latex(components((a + b) * (a - b))) == "a^{2} - b^{2}");
  CHECK(to_latex(components(0.1 * a * 0.2)) == "0.02 a");
  CHECK(to_latex(components(0.123456789012345 * a * 0.987654321098765)) == "0.12193263113702107 a");
  CHECK(to_latex(components(-a * b / 3 - b * b)) == "-b \\left(\\frac{a}{3} + b\\right)");
}

TEST_CASE("matrices of formulas as data are written row by row") {
  constexpr matrix_symbol<"M", 2, 3> m;
  const formula_graph f = trace([](const auto& x) { return x; }, m);
  const std::string text = to_latex(f);
  CAPTURE(text);
  CHECK(text.find("M_{0,0} & M_{0,1} & M_{0,2}\\\\M_{1,0}") != std::string::npos);
}

TEST_CASE("components: numbers beyond double precision are infinite") {
  const formula_graph power = components(read_formula("(x + 1e300)^4 + 1/(x - x)"));
  CHECK(std::isinf(evaluate(power, std::vector<double>{1})[0]));
  const formula_graph folded = components(read_formula("min(exp(1e300^4), x) + log(x - x)"));
  CHECK(evaluate(folded, std::vector<double>{1})[0] == -std::numeric_limits<double>::infinity());
}

TEST_CASE("components: formulas too large to be expanded are refused") {
  const auto sum = t1 + t2 + t3 + a + b + 1;
  const auto power = pow(sum, c<16>);
  CHECK(duet_test::message_of<duet::invalid_input>([&] {
          (void)components(power);
        }).starts_with("duet: components: a product has more than 40000"));
}

} // namespace
} // namespace test_expression_components
