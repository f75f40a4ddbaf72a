// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

#include <cctype>
#include <string_view>

namespace test_expression_latex {
namespace {

using namespace duet::expression;

/// The value of a formula in LaTeX, read as one reads it on paper: a factor applies to what is
/// beside it, a slash to the one factor behind it. Throws for what cannot be read so, and where a
/// \frac stands in another one, in an exponent or in an argument.
class reader {
public:
  reader(std::string_view text, const std::map<std::string, double>& values)
      : text_(text), values_(values) {}

  double value() {
    const double result = sum();
    if (!text_.empty()) {
      fail();
    }
    return result;
  }

private:
  [[noreturn]] void fail() const { throw std::runtime_error("not read: " + std::string(text_)); }
  bool take(std::string_view part) {
    while (text_.starts_with(' ')) {
      text_.remove_prefix(1);
    }
    if (!text_.starts_with(part)) {
      return false;
    }
    text_.remove_prefix(part.size());
    return true;
  }
  void expect(std::string_view part) {
    if (!take(part)) {
      fail();
    }
  }
  double inner_until(std::string_view end) {
    ++depth_;
    const double result = sum();
    --depth_;
    expect(end);
    return result;
  }
  std::string letters() {
    std::size_t n = 0;
    while (n < text_.size() && std::isalpha(static_cast<unsigned char>(text_[n])) != 0) {
      ++n;
    }
    const std::string result(text_.substr(0, n));
    text_.remove_prefix(n);
    return result;
  }

  double sum() {
    double result = take("-") ? -product() : product();
    for (;;) {
      if (take("+")) {
        result += product();
      } else if (take("-")) {
        result -= product();
      } else {
        return result;
      }
    }
  }

  /// Is there one factor more?
  bool is_at_factor() {
    take("");
    return !text_.empty() && std::string_view("+-/)}|,").find(text_[0]) == std::string::npos &&
           !text_.starts_with("\\right");
  }
  double product() {
    double result = power();
    while (is_at_factor()) {
      const bool is_dot = take("\\cdot");
      take("");
      if (!is_dot && std::isdigit(static_cast<unsigned char>(text_[0])) != 0) {
        fail(); // 2 3
      }
      result *= power();
    }
    if (take("/")) {
      result /= power();
      if (is_at_factor() || take("/")) {
        fail(); // x/y z
      }
    }
    return result;
  }
  double power() {
    const double base = factor();
    const double result = take("^{") ? std::pow(base, inner_until("}")) : base;
    if (take("^")) {
      fail();
    }
    return result;
  }

  double factor() {
    take("");
    if (!text_.empty() && std::isdigit(static_cast<unsigned char>(text_[0])) != 0) {
      const std::string digits(text_.substr(0, text_.find_first_not_of("0123456789.")));
      text_.remove_prefix(digits.size());
      return std::stod(digits);
    }
    if (take("\\frac{")) {
      if (depth_ > 0) {
        fail();
      }
      const double above = inner_until("}");
      expect("{");
      return above / inner_until("}");
    }
    if (take("\\sqrt{")) {
      return std::sqrt(inner_until("}"));
    }
    if (take("\\left(")) {
      const double result = sum();
      expect("\\right)");
      return result;
    }
    if (take("\\left|")) {
      return std::abs(inner_until("\\right|"));
    }
    if (take("\\operatorname{")) {
      const std::string name = letters();
      expect("}");
      return function(name);
    }
    const bool is_command = take("\\");
    const std::string name = is_command ? letters() : std::string(text_.substr(0, 1));
    if (!is_command && !text_.empty()) {
      text_.remove_prefix(1);
    }
    if (name == "pi") {
      return std::numbers::pi;
    }
    if (name == "e") {
      expect("^{");
      return std::exp(inner_until("}"));
    }
    if (const auto found = values_.find(name); found != values_.end()) {
      return found->second;
    }
    return function(name);
  }

  /// f(x) and f^{n}(x)
  double function(const std::string& name) {
    static const std::map<std::string, double (*)(double)> functions = {
        {"sin", [](double x) { return std::sin(x); }},
        {"cos", [](double x) { return std::cos(x); }},
        {"tan", [](double x) { return std::tan(x); }},
        {"arcsin", [](double x) { return std::asin(x); }},
        {"arccos", [](double x) { return std::acos(x); }},
        {"arctan", [](double x) { return std::atan(x); }},
        {"sinh", [](double x) { return std::sinh(x); }},
        {"cosh", [](double x) { return std::cosh(x); }},
        {"tanh", [](double x) { return std::tanh(x); }},
        {"log", [](double x) { return std::log(x); }},
        {"cbrt", [](double x) { return std::cbrt(x); }},
        {"sign", [](double x) { return std::copysign(1, x); }},
        {"erf", [](double x) { return std::erf(x); }},
        {"Gamma", [](double x) { return std::tgamma(x); }}};
    const auto found = functions.find(name);
    if (found == functions.end()) {
      fail();
    }
    const double exponent = take("^{") ? inner_until("}") : 1;
    const bool is_high = take("\\left(");
    if (!is_high) {
      expect("(");
    }
    return std::pow(found->second(inner_until(is_high ? "\\right)" : ")")), exponent);
  }

  std::string_view text_;
  const std::map<std::string, double>& values_;
  int depth_ = 0;
};

constexpr symbol<"x"> x;
constexpr symbol<"y"> y;
constexpr symbol<"a"> a;

/// Does the text of f have the value of f, with 0 < x < y < 1 < a?
template <class F>
void check_value(const F& f) {
  const std::string text = to_latex(f);
  INFO(text);
  for (const double s : {0.1, 0.37, 0.62}) {
    const double at[] = {0.15 + 0.7 * s * s, 0.45 + 0.8 * s, 1.2 + s};
    const double expected = f(x = at[0], y = at[1], a = at[2]);
    const std::map<std::string, double> values = {{"x", at[0]}, {"y", at[1]}, {"a", at[2]}};
    const double read = reader(text, values).value();
    CHECK(std::abs(read - expected) <= 1e-12 * (1 + std::abs(expected)));
  }
}

/// The same of f and its derivatives by x and y.
template <class F>
void check_values(const F& formula) {
  const auto f = formula + c<0> * x * y * a; // which takes values for all three
  const auto slope = derivative(f, x);
  check_value(f);
  check_value(slope);
  check_value(derivative(slope, x));
  check_value(derivative(slope, y));
}

TEST_CASE("the reader reads what it should, and nothing else") {
  const std::map<std::string, double> values = {{"x", 3}, {"y", 5}};
  const auto value = [&](const char* text) { return reader(text, values).value(); };
  CHECK(value("-2 x^{2} y + 1") == -89);
  CHECK(value("x - y/\\left(2 x^{2}\\right)") == 3 - 5.0 / 18);
  CHECK(value("\\frac{x + 1}{2 y}") == 0.4);
  CHECK(value("\\left(x y\\right)^{2} \\cdot 2") == 450);
  CHECK(value("\\sin^{2}(x) + \\cos^{2}(x)") == doctest::Approx(1).epsilon(1e-15));
  CHECK(value("e^{x/y}") == std::exp(0.6));
  for (const char* text :
       {"x/y x", "x/y/x", "x^{2}^{2}", "2 3", "x + - y", "\\frac{\\frac{x}{y}}{x}",
        "e^{\\frac{x}{y}}", "x)", "\\left(x", "z", ""}) {
    INFO(text);
    CHECK_THROWS_AS((void)value(text), std::runtime_error);
  }
}

TEST_CASE("LaTeX has the value of its formula") {
  check_values(x / y / a);
  check_values(x / (y / a));
  check_values((x / y) / (a / x));
  check_values(1 / (1 + 1 / x));
  check_values(x * y / a * x);
  check_values(sin(x) / x);
  check_values(x * x * x * x / (1 + x * x));
  check_values(exp(-x * x / 2));
  check_values(exp(-(x - y) * (x - y) / (2 * a * a)) / (a * sqrt(2 * pi)));
  check_values(pow(sin(x * y), c<3>));
  check_values(pow(x, y / a));
  check_values(pow(x / y, 2));
  check_values(pow(x, -2) * y / pow(x, c<3>));
  check_values(pow(x, 2.5_c) * pow(y, -0.5));
  check_values(sqrt(x * y) / x);
  check_values(sqrt(1 + x * x) * sqrt(y));
  check_values(x / sqrt(x * x + y * y));
  check_values(sqrt(1 + 1 / x) / (x - a));
  check_values(1 / (a - x) / (x - a) * (x + a) / (a + x));
  check_values((x - y) * (y - x) * (x - y) / sqrt(y - x));
  check_values(log(x) / x);
  check_values(asin(x / y));
  check_values(acos(x * y) * a);
  check_values(atan(x / y));
  check_values(tan(x) * tanh(x * y));
  check_values(cosh(x * y) / (x * y));
  check_values(1 / (1 + exp(-x)));
  check_values(exp(x) / (exp(x) + exp(y)) * exp(2 * x));
  check_values(exp(x) * sqrt(exp(x)));
  check_values(cbrt(x) * cbrt(x) / a);
  check_values(erf(x / a) * pi / x);
  check_values(hypot(x, y));
  check_values(abs(x - y) / a - 0.1 * abs(y / x));
  check_values(-2.5 * x - (-0.125) * y + 3 * (x - 2 * (y - a)) / 6);
  check_values(x / (-2.5 * y) - y / pow(-3.0 * x, -3));
  check_values((x / 2 + y / 3) / (x / 4 - a));
  check_values((1 / x + 1 / (x + 1 / y)) / (1 + a * (1 + 1 / x)));
  check_values(x * (1 / y + x * (1 + 1 / a)) / (x * y));
  check_values((x * (y + a) - x * y - x * a + x / a) / (y + 1 / a));
  check_values(pow(2 * x, 40) * pow(x / 3, 30) * 123456789.0 * 987654321.0);
  check_values(x - (y - a) - (x + y - 2.5e-7 * x) / 1e20);
}

TEST_CASE("names with several _ or one in front are LaTeX that compiles") {
  CHECK(to_latex(x * symbol<"_u">()) == "x {}_{u}");
  CHECK(to_latex(symbol<"x_a_b_c">()) == "x_{a_{b_{c}}}"); // x_{a_b_c} is an error
  CHECK(to_latex(symbol<"theta_l_hip2">()) == "\\theta_{l_{hip2}}");
  CHECK(to_latex(symbol<"x__y_">()) == "x_{y}");
  CHECK(to_latex(symbol<"_">()) == "\\_");
}

TEST_CASE("symbols that look alike are refused, both by their names") {
  const symbol<"theta1"> plain;
  const symbol<"theta_1"> apart;
  const auto message = [](const auto& f) {
    return duet_test::message_of<duet::invalid_input>([&] { (void)to_latex(f); });
  };
  CHECK(message(plain * apart) == "duet: to_latex: theta1 and theta_1 both look like "
                                  "\\theta_{1}: one of them needs another name");
  CHECK(message(sin(apart) / exp(2 * plain)).starts_with("duet: to_latex: theta_1 and theta1 "));
  CHECK(to_latex(plain * plain) == "\\theta_{1}^{2}");
  CHECK(to_latex(plain * symbol<"theta_2">()) == "\\theta_{1} \\theta_{2}");
  CHECK(message(x * symbol<"x_">()) == "duet: to_latex: x and x_ both look like x: one "
                                       "of them needs another name");
  CHECK(message(x * norm(vector_symbol<"x">())).empty()); // \vec{x}
  CHECK(message(symbol<"q">() * rotate(quaternion_symbol<"q">(), vector_symbol<"u">()))
            .starts_with("duet: to_latex: q and q both look like q"));
  CHECK(message(pi * symbol<"pi">()) == "duet: to_latex: the number pi and pi both look "
                                        "like \\pi: one of them needs another name");
  CHECK(to_latex(symbol<"pi">()) == "\\pi");
}

} // namespace
} // namespace test_expression_latex
