// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/skip.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/expression/graph/derivation.hpp>
#include <duet/expression/graph/document.hpp>
#include <duet/expression/graph/formula_derivative.hpp>
#include <duet/expression/graph/formula_latex.hpp>
#include <duet/expression/graph/read_formula.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace test_expression_document {
namespace {

using namespace duet::expression;

constexpr symbol<"x"> x;
constexpr symbol<"a"> a;
constexpr symbol<"theta"> theta;
constexpr vector_symbol<"n"> n;
constexpr vector_symbol<"t"> t;
constexpr quaternion_symbol<"q"> q;
constexpr pose_symbol<"A"> A;

const auto arm = screw(axis::z, theta) * translation_along(axis::x, a);

TEST_CASE("gradients, Hessians, Jacobians and motions in LaTeX") {
  const auto f = sin(x) * exp(-x / a);
  CHECK(to_latex(gradient(f, wrt(x, a))) ==
        "\\begin{bmatrix}\\cos(x) e^{-x/a} - \\frac{\\sin(x) e^{-x/a}}{a}\\\\\\frac{x \\sin(x) "
        "e^{-x/a}}{a^{2}}\\end{bmatrix}");
  CHECK(to_latex(hessian(x * x * a, wrt(x, a))) ==
        "\\begin{bmatrix}2 a & 2 x\\\\2 x & 0\\end{bmatrix}");
  CHECK(to_latex(gradient(dot(n, n), wrt(n))) ==
        "\\begin{bmatrix}2 n_{0}\\\\2 n_{1}\\\\2 n_{2}\\end{bmatrix}");
  CHECK(to_latex(jacobian(arm, wrt(theta), duet::frame::hybrid)) ==
        "\\begin{bmatrix}-a \\sin(\\theta)\\\\a \\cos(\\theta)\\\\0\\\\0\\\\0\\\\1\\end{bmatrix}");
  CHECK(to_latex(jacobian(arm, wrt(theta, a), duet::frame::body)) ==
        "\\begin{bmatrix}0 & 1\\\\a & 0\\\\0 & 0\\\\0 & 0\\\\0 & 0\\\\1 & 0\\end{bmatrix}");
  CHECK(to_latex(motion(rotation(screw(axis::z, x * x)), x, duet::frame::body)) ==
        "\\begin{bmatrix}0\\\\0\\\\2 x\\end{bmatrix}, \\quad "
        "\\begin{bmatrix}0\\\\0\\\\2\\end{bmatrix}");
  const symbol<"theta_1"> apart; // looks like theta1, though in another entry
  const symbol<"theta1"> plain;
  CHECK(duet_test::message_of<duet::invalid_input>([&] {
          (void)to_latex(gradient(plain * plain + apart * apart, wrt(plain, apart)));
        }).starts_with("duet: to_latex: theta1 and theta_1 both look like"));
}

TEST_CASE("formulas that are data in LaTeX: variables that look alike, functions with _") {
  const auto message = [](const char* text) {
    return duet_test::message_of<duet::invalid_input>(
        [&] { (void)to_latex(read_formula(text, {.exact_constants = true})); });
  };
  CHECK(message("theta1*theta_1") == "duet: to_latex: theta1 and theta_1 both look like "
                                     "\\theta_{1}: one of them needs another name");
  CHECK(message("vector v; v[0] - v_0").starts_with("duet: to_latex: v[0] and v_0 both look like"));
  CHECK(message("vector v; v[0] - v_1").empty());
  CHECK(message("pi_ + pi") == "duet: to_latex: pi_ and the number pi both look like \\pi: one of "
                               "them needs another name");
  CHECK(message("x + pi*x/x + 3*pi/3").empty()); // the number, three times
  CHECK(to_latex(read_formula("arc_ratio(x, y)")) == "\\operatorname{arc\\_ratio}(x, y)");
}

TEST_CASE("derivations step by step") {
  CHECK(derivation(sin(x) / x, x) ==
        "\\begin{align*}\n"
        " \\frac{\\mathrm{d}}{\\mathrm{d}x}\\left[\\frac{\\sin(x)}{x}\\right] &= \\frac{x "
        "\\frac{\\mathrm{d}}{\\mathrm{d}x}\\left[\\sin(x)\\right] - \\sin(x)}{x^{2}} \\\\\n"
        " &= \\frac{x \\cos(x) - \\sin(x)}{x^{2}}\n"
        "\\end{align*}\n");
  CHECK(derivation(x * a, x) == "\\begin{align*}\n"
                                " \\frac{\\partial}{\\partial x}\\left[x a\\right] &= a\n"
                                "\\end{align*}\n");
  CHECK(derivation(x, x) == "\\begin{align*}\n 1\n\\end{align*}\n");
  for (const char* text :
       {"exp(-x^2)*cos(2*x)", "sqrt(1 + exp(-2*x^2))^3", "log(1 + x*sin(x)^2)", "atan2(x, 1 + x^2)",
        "x^x", "(x + 1)/(x^2 + exp(x))", "3", "1 - x", "a*sin(x) + a^2*cos(x*a)/x"}) {
    CAPTURE(text);
    const formula_graph f = read_formula("scalar x, a; " + std::string(text));
    const std::string steps = derivation(f, "x");
    const std::string last = to_latex(derivative(f, "x"));
    CAPTURE(steps);
    CHECK(steps.ends_with(last + "\n\\end{align*}\n"));
  }
  CHECK(duet_test::message_of<duet::invalid_input>([] {
          (void)derivation(read_formula("vector w; w[0]"), "w");
        }) == "duet: derivation takes a formula with one scalar output, and a scalar input");
}

TEST_CASE("the notation of the lecture notes") {
  CHECK(to_latex(rotation_about(n, theta), notation::notes) ==
        "\\cos(\\theta/2) + \\sin(\\theta/2) \\vec{n}");
  CHECK(to_latex(pose(q, t), notation::notes) == "q + \\frac{\\varepsilon}{2} \\vec{t} q");
  CHECK(to_latex(translation_along(n, x), notation::notes) ==
        "1 + \\frac{\\varepsilon}{2} x \\vec{n}");
  CHECK(to_latex(translation(A), notation::notes) ==
        "2 \\operatorname{dual}\\left(A\\right) \\operatorname{real}\\left(A\\right)^{*}");
  CHECK(to_latex(skew(t), notation::notes) == "\\widehat{\\vec{t}}");
  CHECK(to_latex(rotation(A), notation::notes) == "\\operatorname{real}(A)");
  CHECK(to_latex(rotation(A)) == "\\operatorname{rotation}(A)");
  CHECK(to_latex(sin(x) / x, notation::notes) == to_latex(sin(x) / x));
}

TEST_CASE("a document compiles") {
  const std::string text = document(
      "An arm", translation(arm), components(translation(arm)), "and its Jacobians",
      jacobian(arm, wrt(theta, a), duet::frame::spatial),
      jacobian(arm * A, wrt(theta, A), duet::frame::hybrid), derivation(sin(x) * exp(-x / a), x),
      hessian(sin(x) * exp(-x / a), wrt(x, a)), exp(x / c<2> * n), rotation_matrix(q),
      "\\[" + to_latex(pose(q, t) * translation_along(n, x), notation::notes) + "\\]",
      trace([](const auto& u) { return u * u; }, x),
      motion(arm * translation_along(axis::y, theta), theta, duet::frame::hybrid));
  CHECK(text.starts_with("\\documentclass{article}\n"));
  CHECK(text.ends_with("\\end{document}\n"));
  if (std::system("pdflatex --version > /dev/null 2> /dev/null") != 0) {
    REQUIRE(std::getenv("DUET_TEST_STRICT") == nullptr);
    duet_test::skip("there is no pdflatex (Debian: sh scripts/setup texlive-latex-base)");
    return;
  }
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "duet_test_expression_document";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "formulas.tex") << text;
  const std::string command = "cd " + folder.string() +
                              " && pdflatex -interaction=nonstopmode -halt-on-error formulas.tex "
                              "> output.txt";
  const int status = std::system(command.c_str());
  std::stringstream output;
  output << std::ifstream(folder / "output.txt").rdbuf();
  CAPTURE(output.str());
  CHECK(status == 0);
  CHECK(output.str().find("Overfull") == std::string::npos);
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace test_expression_document
