// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>
#include <duet/expression/graph/evaluate.hpp>
#include <duet/expression/graph/formula_text.hpp>
#include <duet/expression/graph/read_formula.hpp>
#include <duet/expression/graph/trace.hpp>
#include <duet/interop/multiprecision.hpp>

#include <Eigen/Core>

namespace test_expression_read_formula {
namespace {

using namespace duet::expression;
using duet::quaternion;
using duet::vector3;

/// The values of the outputs, with the inputs in the order of the formula.
std::vector<double> values(const std::string& text, const std::vector<double>& inputs = {}) {
  return evaluate(read_formula(text), inputs);
}
double value(const std::string& text, const std::vector<double>& inputs = {}) {
  return values(text, inputs).at(0);
}
std::string message(const std::string& text) {
  return duet_test::message_of<duet::invalid_input>([&] { (void)read_formula(text); });
}
std::string repeated(const std::string& text, int count) {
  std::string result;
  for (int i = 0; i < count; ++i) {
    result += text;
  }
  return result;
}

TEST_CASE("read_formula: operators have the precedence of mathematics") {
  struct row {
    const char* text;
    double value;
  };
  const double x = 3, y = 0.5;
  for (const row& each :
       std::initializer_list<row>{{"1 + 2 * 3", 7},
                                  {"(1 + 2) * 3", 9},
                                  {"2 - 3 - 4", -5},
                                  {"2 / 4 / 8", 0.0625},
                                  {"2 / 4 * 8", 4},
                                  {"-2^2", -4},
                                  {"(-2)^2", 4},
                                  {"2^3^2", 512},
                                  {"2**3**2", 512},
                                  {"2^-1", 0.5},
                                  {"2^-2^2", 0.0625},
                                  {"4^0.5", 2},
                                  {"--2", 2},
                                  {"2 - -3", 5},
                                  {"+2 * -3", -6},
                                  {"-2^-2", -0.25},
                                  {"1.5e2 + .5 + 2.", 152.5},
                                  {"2e", 2 * std::exp(1.0)}, // of a name, which is an input
                                  {"2E-1", 0.2},
                                  {"0x10", 0},
                                  {"select(1 < 2, 3, 4)", 3},
                                  {"select(1 < 2 && 2 < 1 || 3 == 3, 3, 4)", 3},
                                  {"select(!(1 >= 1) || 1 != 1, 3, 4)", 4},
                                  {"select(!isnan(1) && isfinite(1), 3, 4)", 3},
                                  {"max(1, min(5, 3))", 3},
                                  {"abs(-2) + fabs(2)", 4},
                                  {"hypot(3, 4) + hypot(2, 3, 6)", 12},
                                  {"atan2(0, -1)", 3.141592653589793},
                                  {"pi", 3.141592653589793},
                                  {"ln(exp(2))", 2},
                                  {"fma(2, 3, 4) + pow(2, 3) + fmod(7, 4)", 21},
                                  {"floor(2.5) + ceil(2.5) + round(2.4) + trunc(2.9)", 9},
                                  {"1 / inf", 0},
                                  {"a = 3; b = a^2; b - a", 6},
                                  {"a = 3; a;", 3}}) {
    CAPTURE(each.text);
    const formula_graph f = read_formula(each.text);
    const std::vector<double> inputs(std::size_t(f.input_size()), std::exp(1.0));
    CHECK(evaluate(f, inputs)[0] == doctest::Approx(each.value).epsilon(1e-15));
  }
  for (const row& each : std::initializer_list<row>{{"2x + y", 6.5},
                                                    {"2x^2 + y", 18.5},
                                                    {"-2x^2 * y", -9},
                                                    {"2(x + 1) / y", 16},
                                                    {"3 sqrt(2 x + y + 2.5)", 9},
                                                    {"x - 2 y", 2},
                                                    {"2exp(x - 3) + y", 2.5},
                                                    {"x / y * 2", 12},
                                                    {"x^y^2 - 3^0.25", 0},
                                                    {"x <y", 0}}) {
    CAPTURE(each.text);
    if (std::string(each.text) == "x <y") {
      CHECK(value("select(x <y, 1, 0)", {x, y}) == each.value);
    } else {
      CHECK(value(each.text, {x, y}) == doctest::Approx(each.value).epsilon(1e-15));
    }
  }
}

TEST_CASE("read_formula: the functions are those of <cmath>") {
  using function = double (*)(double);
  struct row {
    const char* name;
    function f;
  };
  for (const row& each : std::initializer_list<row>{
           {"sqrt", std::sqrt},   {"cbrt", std::cbrt},     {"exp", std::exp},
           {"exp2", std::exp2},   {"expm1", std::expm1},   {"log", std::log},
           {"log2", std::log2},   {"log10", std::log10},   {"log1p", std::log1p},
           {"sin", std::sin},     {"cos", std::cos},       {"tan", std::tan},
           {"asin", std::asin},   {"acos", std::acos},     {"atan", std::atan},
           {"sinh", std::sinh},   {"cosh", std::cosh},     {"tanh", std::tanh},
           {"asinh", std::asinh}, {"atanh", std::atanh},   {"erf", std::erf},
           {"erfc", std::erfc},   {"tgamma", std::tgamma}, {"lgamma", std::lgamma}}) {
    CAPTURE(each.name);
    CHECK(value(std::string(each.name) + "(u)", {0.3}) ==
          doctest::Approx(each.f(0.3)).epsilon(1e-14));
  }
}

TEST_CASE("read_formula: numbers are rounded correctly, and exact if requested") {
  CHECK(value("0.1") == 0.1);
  CHECK(value("9007199254740993") == 9007199254740992.0); // a tie
  CHECK(value("2.2250738585072011e-308") == 2.2250738585072011e-308);
  CHECK(value("123456789012345678901234567890") == 123456789012345678901234567890.0);

  const read_options exact{.exact_constants = true};
  using duet::real_50;
  const auto of_50 = [&](const char* text) {
    return evaluate<real_50>(read_formula(text, exact), {})[0];
  };
  CHECK(of_50("0.1") == real_50(1) / 10);
  CHECK(of_50("12.5e-3") == real_50(1) / 80);
  CHECK(abs(sin(of_50("pi"))) < 1e-49);
  CHECK(abs(of_50("sqrt(2)^2 - 2")) < 1e-49);
  CHECK(abs(of_50("norm([1, 1, 0]) - sqrt(2)")) < 1e-49);
  CHECK(abs(of_50("rotate(exp([0, 0, 1/2]), [1, 0, 0])") - cos(real_50(1))) < 1e-49);
  // in double nothing changes
  for (const char* text : {"0.1", "2.5", "3e-5", "123.456", "1e22", "1e-22", "0.30", "pi", "1e-300",
                           "0.1234567890123456789"}) {
    CAPTURE(text);
    CHECK(evaluate<double>(read_formula(text, exact), {})[0] == value(text));
  }
}

TEST_CASE("read_formula: vectors and rotations have the values of duet's functions") {
  const vector3<double> v(0.3, -0.2, 0.7), w(-1.1, 0.4, 0.2);
  const quaternion<double> q = duet::exp(v), p = duet::exp(w);
  const std::vector<double> vectors{v[0], v[1], v[2], w[0], w[1], w[2]};
  const std::vector<double> rotations{q.w(), q.x(), q.y(), q.z(), p.w(), p.x(), p.y(), p.z()};
  const auto check = [](const std::vector<double>& found, const auto& expected) {
    std::size_t i = 0;
    detail::for_each_number(expected, [&](double x) {
      REQUIRE(i < found.size());
      CHECK(std::abs(found[i++] - x) < 1e-15);
    });
    CHECK(i == found.size());
  };
  const auto of_vectors = [&](const std::string& text) {
    return values("vector v, w; " + text, vectors);
  };
  check(of_vectors("2v - w/2 + v*3 + [0, v[2], 1]"),
        vector3<double>(5 * v - w / 2 + vector3<double>(0, v[2], 1)));
  check(of_vectors("cross(v, w)"), vector3<double>(v.cross(w)));
  check(of_vectors("dot(v, w)"), v.dot(w));
  check(of_vectors("norm(v)"), v.norm());
  check(of_vectors("normalized(-v)"), vector3<double>(-v.normalized()));
  check(of_vectors("exp(v)"), q);
  check(of_vectors("exp(v)[3]"), q.z());
  check(of_vectors("select(v[0] < 0, v, w)"), w);
  const auto of_rotations = [&](const std::string& text) {
    return values("rotation q, p; " + text, rotations);
  };
  check(of_rotations("q*p"), q * p);
  check(of_rotations("conj(q)*2 - p/4"), 2 * conj(q) - p / 4);
  check(of_rotations("inverse(3q)"), duet::inverse(3 * q));
  check(of_rotations("rotate(q, vec(p))"), vector3<double>(duet::rotate(q, p.vec())));
  check(of_rotations("slerp(q, p, 0.25)"), duet::slerp(q, p, 0.25));
  check(of_rotations("log(q)"), duet::log(q));
  check(of_rotations("vec(log(q))"), v);
  check(of_rotations("exp(log(-p))"), -p);
  check(of_rotations("norm(3q)"), 3.0);
  check(of_rotations("normalized(3q)"), q);
  check(of_rotations("quaternion(q[0], p[1], 0, 1)"), quaternion<double>(q.w(), p.x(), 0, 1));
  // of constants alone
  check(values("log(quaternion(1, 0, 0, 0))"), quaternion<double>(0, 0, 0, 0));
  check(values("slerp(quaternion(1, 0, 0, 0), quaternion(-1, 0, 0, 0), 1/2)"),
        quaternion<double>(1, 0, 0, 0));
  check(values("exp([0, 0, 0])"), quaternion<double>(1, 0, 0, 0));
}

TEST_CASE("read_formula: inputs and outputs have their names, order and kinds") {
  const formula_graph f = read_formula("vector w; scalar t; value = θ₁ + t*w[0] + a, slope = 2w");
  REQUIRE(f.inputs().size() == 4);
  CHECK(f.inputs()[0].name == "w");
  CHECK(f.inputs()[0].rows == 3);
  CHECK(f.inputs()[1].name == "t");
  CHECK(f.inputs()[2].name == "θ₁");
  CHECK(f.inputs()[3].name == "a");
  REQUIRE(f.outputs().size() == 2);
  CHECK(f.outputs()[0].name == "value");
  CHECK(f.outputs()[1].name == "slope");
  CHECK(f.outputs()[1].kind == shape::matrix);
  const formula_graph g =
      read_formula("x, q*q", {.scalars = {"z"}, .vectors = {"w"}, .rotations = {"q"}});
  REQUIRE(g.inputs().size() == 4);
  CHECK(g.inputs()[0].name == "z");
  CHECK(g.inputs()[2].kind == shape::quaternion);
  CHECK(g.outputs()[0].name == "y1");
  CHECK(g.outputs()[1].kind == shape::quaternion);
  CHECK(read_formula("scalar = 2; vector + scalar").input("vector").rows == 1);
}

TEST_CASE("read_formula: every error names its column and what was expected") {
  struct row {
    std::string text;
    const char* problem; ///< without the name of the function
  };
  const std::vector<row> rows{
      {"", "column 1: expected a number, name, function or '(', got the end"},
      {"x +", "column 4: expected a number, name, function or '(', got the end"},
      {"sin(x)+)", "column 8: expected a number, name, function or '(', got ')'"},
      {"(x", "column 3: expected an operator or ')', got the end"},
      {"sin(x", "column 6: expected ',' or ')', got the end"},
      {"[x, 1", "column 6: expected ',' or ']', got the end"},
      {"x y", "column 3: expected an operator or the end of the formula, got 'y'"},
      {"2 3", "column 3: expected an operator or the end of the formula, got '3'"},
      {"1/2x", "column 4: expected an operator or the end of the formula, got 'x'"},
      {"x^2y", "column 4: expected an operator or the end of the formula, got 'y'"},
      {"x < y < z", "column 7: expected an operator or the end of the formula, got '<'"},
      {"θ₁ + ×", "column 6: expected a number, name, function or '(', got '×'"},
      {"x + \x1b[0m", "column 5: expected a number, name, function or '(', got '\\x1b'"},
      {"x + \xff", "column 5: expected a number, name, function or '(', got '\\xff'"},
      {"x\n+\n$", "column 5: expected a number, name, function or '(', got '$'"},
      {repeated("a", 50) + " b",
       "column 52: expected an operator or the end of the formula, got 'b'"},
      {"x " + repeated("a", 50), "column 3: expected an operator or the end of the formula, got "
                                 "'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa...'"},
      {"w[x]", "column 3: expected an index from 0 to 3, got 'x'"},
      {"vector w; w[1", "column 14: expected ']', got the end"},
      {"vector w; w[3]", "column 13: the index 3 is beyond the 3 numbers of a vector"},
      {"x[0]", "column 3: [0] takes a vector or rotation, got a scalar"},
      {"vector w, 3", "column 11: expected a name, got '3'"},
      {"vector w", "column 9: expected ',' or ';', got the end"},
      {"x; y", "column 2: expected an operator or the end of the formula, got ';'"},
      {"vector x, x; x", "column 11: 'x' has a meaning already"},
      {"x = y; y = 2; x", "column 8: 'y' has a meaning already"},
      {"pi = 3; pi", "column 1: 'pi' is a constant"},
      {"sin = 3; 1",
       "column 1: 'sin' is a function (expected a name of another kind, or '(' behind it)"},
      {"sin x",
       "column 1: 'sin' is a function (expected a name of another kind, or '(' behind it)"},
      {"a = 1, a = 2", "column 8: there are two outputs 'a'"},
      {"2 foo(x)", "column 3: there is no function 'foo'"},
      {"x(y)", "column 1: there is no function 'x'"},
      {"sin(x, y)", "column 1: sin takes a scalar, got two scalars"},
      {"atan2(x)", "column 1: atan2 takes two scalars, got a scalar"},
      {"hypot(x)", "column 1: hypot takes two scalars, or three scalars, got a scalar"},
      {"1 + sin([x, y, z])", "column 5: sin takes a scalar, got a vector"},
      {"[x, y]", "column 1: [...] takes three scalars, got two scalars"},
      {"1 + [x, y, z]", "column 3: + takes two scalars, or two vectors, or two rotations, got a "
                        "scalar and a vector"},
      {"-(x < 1)",
       "column 1: the sign - takes a scalar, or a vector, or a rotation, got a condition"},
      {"!x", "column 1: ! takes a condition, got a scalar"},
      {"select(x, 1, 2)",
       "column 1: select takes a condition and two values of one kind, got three scalars"},
      {"rotation q; rotate([1, 2, 3], q)",
       "column 13: rotate takes a rotation and a vector, got a vector and a rotation"},
      {"x < 1", "column 1: the formula is a condition (expected a scalar, vector or rotation)"},
      {"1e400", "column 1: the number '1e400' is beyond the range of double"},
      {repeated("(", 201) + "x", "column 201: the formula is nested more than 200 deep"},
      {repeated("-", 300) + "x", "column 200: the formula is nested more than 200 deep"},
      {"x" + repeated("^x", 300), "column 401: the formula is nested more than 200 deep"}};
  for (const row& each : rows) {
    CAPTURE(each.text);
    CHECK(message(each.text) == "duet: read_formula: " + std::string(each.problem));
  }
}

TEST_CASE("read_formula: size, depth and number of operations are limited") {
  CHECK(value(repeated("(", 199) + "7" + repeated(")", 199)) == 7);
  const std::string sum = "x" + repeated("+x", 32767); // 64 kB - 1
  CHECK(value(sum, {1.0}) == 32768);
  CHECK(message(sum + "+x") ==
        "duet: read_formula: the text has 65537 bytes (expected at most 65536)");
  // doubled again and again, which takes few operations
  std::string doubled = "a0 = x; ";
  for (int i = 0; i < 60; ++i) {
    const std::string n = std::to_string(i);
    doubled += "a" + std::to_string(i + 1) + " = a" + n + " + a" + n + "; ";
  }
  CHECK(value(doubled + "a60", {1.0}) == std::exp2(60.0));
  // rotations that become many operations each
  std::string long_product = "rotation q; vector w; q";
  for (int i = 0; i < 2500; ++i) {
    long_product += "*exp(w*" + std::to_string(i) + ")";
  }
  CHECK(message(long_product).find("the formula has more than 100000 operations") !=
        std::string::npos);
  CHECK(read_formula(long_product, {.max_nodes = 1'000'000}).outputs()[0].rows == 4);
}

TEST_CASE("to_text: a formula reads back as the same formula") {
  const std::vector<std::string> texts{
      "2x + 1/2 + 0.1 (x+1)**2 - 2 sin(pi*x)/3e-5",
      "-x^2 - -y + (-x)^3 / (-3) - (x - y) - (x + y)",
      "a/b/c - a/(b/c) + (a*b)*c + a*(b*c) + a/(b*c) + a - (b - c)",
      "x^y^2 + (x^y)^2 + (-2)^x + 2^-x + x^-2 + (2^3)^x + (x/y)^0.5",
      "-(0.004 * (-0.014)) + (-0.1) * x * 0.3 - 0.7 * -0.9",
      "2 / -x^2 - (-3 / x) * y + (-3) / 10 - -(2/x/y) + -(3/7)*x",
      "select(x < 1 && !(x == 2) || y >= 2 && isnan(y), -x, max(x, min(y, 3)))",
      "scalar b, a; a - b",
      "scalar unused; a - 1",
      "vector w; exp(w), value = norm(w)",
      "rotation q, p; slerp(q, p, t)",
      "rotation q; log(q)",
      "value = x^2, slope = 2x",
      "t1 + t2*t1",
      "θ*sin(θ) + x₁",
      "inf*x + 123456789012345678 + 1e300",
      "log(quaternion(1, 2, 3, 4))",
      repeated("sin(", 150) + "x" + repeated(")", 150),
      "x0" + repeated(" + x^2*sin(y)", 300),
      "fma(x, 0.1, 3) + hypot(x, y, 0.3) + tgamma(x) + erf(y) - abs(x) - remainder(x, y)"};
  for (const std::string& text : texts) {
    for (const bool exact : {false, true}) {
      CAPTURE(text);
      const formula_graph f = read_formula(text, {.exact_constants = exact});
      const std::string written = to_text(f, exact);
      CAPTURE(written);
      const formula_graph g = read_formula(written, {.exact_constants = exact});
      CHECK(to_text(g, exact) == written);
      CHECK(count_operations(g).total() == count_operations(f).total());
      REQUIRE(g.input_size() == f.input_size());
      REQUIRE(g.outputs().size() == f.outputs().size());
      std::vector<double> inputs;
      for (int i = 0; i < f.input_size(); ++i) {
        inputs.push_back(0.3 + 0.2 * i);
      }
      const std::vector<double> a = evaluate(f, inputs), b = evaluate(g, inputs);
      REQUIRE(a.size() == b.size());
      for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK((a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i]))));
      }
    }
  }
  CHECK(to_text(read_formula("exp(-u)*sin(omega*u^2)")) == "exp(-u) * sin(omega * u^2)");
  CHECK(to_text(read_formula("0.1x + pi", {.exact_constants = true}), true) == "0.1 * x + pi");
  CHECK(to_text(read_formula("scalar b, a; a - b")) == "scalar b, a; a - b");
  CHECK(to_text(read_formula("(6u - v)/(-3)")) == "-(6 * u - v) / 3");
}

TEST_CASE("to_text: a traced function becomes text, and what has no text is an error") {
  constexpr symbol<"u"> u;
  constexpr quaternion_symbol<"q"> q;
  constexpr vector_symbol<"w"> w;
  constexpr pose_symbol<"A"> A;
  const auto f =
      trace([](auto x, auto r, auto v) { return (rotate(r, v) * (x + 0.1)).eval(); }, u, q, w);
  const formula_graph g = read_formula(to_text(f));
  const std::vector<double> inputs{0.3, 0.5, 0.5, -0.5, 0.5, 1, 2, 3};
  CHECK(evaluate<double>(f, inputs) == evaluate(g, inputs));
  const std::string problem = duet_test::message_of<duet::invalid_input>(
      [&] { (void)to_text(trace([](auto x) { return x; }, A)); });
  CHECK(problem ==
        "duet: to_text: the output 'y' has 8 numbers (expected scalars, vectors of three "
        "numbers, and rotations)");
  // the arc of a rotation that is known
  const auto constant = trace(
      [](auto x) {
        using T = decltype(x);
        return x + duet::log(quaternion<T>(T(0), T(0), T(1), T(0))).y();
      },
      u);
  CHECK(constant(u = 1.0) == doctest::Approx(1 + std::acos(0.0)).epsilon(1e-15));
}

} // namespace
} // namespace test_expression_read_formula
