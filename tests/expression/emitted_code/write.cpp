// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Writes formulas as code, and programs in the same languages that compare each function with what
// duet computes; check.cmake compiles and runs them.

#include <duet/dual_quaternion/screw.hpp>
#include <duet/expression/code/c.hpp>
#include <duet/expression/condition.hpp>
#include <duet/expression/functions_of_many.hpp>
#include <duet/expression/gradient.hpp>
#include <duet/expression/graph/reverse.hpp>
#include <duet/expression/jacobian.hpp>
#include <duet/expression/matrix.hpp>
#include <duet/expression/motion.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/screw.hpp>
#include <duet/quaternion/curves.hpp>
#include <duet/quaternion/exponential.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace duet::expression;
using duet::vector3;

/// A formula, what its function is called, and inputs at which it is called.
struct code_case {
  std::string name;
  formula_graph formula;
  std::vector<std::vector<double>> inputs;
  bool keeps_bits = true; ///< only + − × ÷ √, and functions of the C library
};

constexpr symbol<"u"> u;
constexpr symbol<"lambda"> lambda;
constexpr symbol<"end"> end;
constexpr symbol<"I"> I;
constexpr symbol<"y0"> y0;
constexpr symbol<"θ"> theta;
constexpr symbol<"named"> named;
constexpr vector_symbol<"w"> w;
constexpr quaternion_symbol<"q"> q;
constexpr quaternion_symbol<"p"> p;
constexpr pose_symbol<"A"> A;
constexpr matrix_symbol<"M", 2, 3> M;

std::vector<std::vector<double>> inputs_of(const formula_graph& f) {
  std::vector<std::vector<double>> result;
  for (const double scale : {0.0, 1e-6, 0.4, 1.0, 1.7}) {
    std::vector<double> inputs;
    for (const named_value& x : f.inputs()) {
      for (int i = 0; i < x.rows * x.columns; ++i) {
        inputs.push_back(scale * std::sin(1.0 + 0.7 * double(inputs.size())) + 0.1 * scale);
      }
      if (x.kind == shape::quaternion || x.kind == shape::pose) { // near a rotation
        inputs[inputs.size() - std::size_t(x.rows)] += 1;
      }
    }
    result.push_back(std::move(inputs));
  }
  return result;
}

code_case make_case(const std::string& name, const formula_graph& f) {
  return {name, f, inputs_of(f)};
}

std::vector<code_case> cases() {
  std::vector<code_case> result;
  const auto add = [&](const char* name, const auto& f) {
    result.push_back(make_case(name, graph_of(f)));
  };
  add("damped", gradient(exp(-u) * sin(dot(w, w) * u), wrt(u, w)));
  add("curvature", hessian(log(2 + cos(u * lambda)) / (1 + u * u), wrt(u, lambda)));
  add("named", lambda + 2 * end - I * y0 + theta * sin(named));
  add("turned", jacobian(rotate(exp(u * w) * q, w), wrt(u, q), duet::frame::body));
  add("arm", motion(screw(axis::z, u) * translation_along(axis::x, 0.5) * screw(axis::y, u * u) * A,
                    u, duet::frame::spatial));
  add("matrix", transpose(M) * matrix<2, 2>(u, 1, 0, lambda) * M);
  add("powers", trace(
                    [](auto x, auto y) {
                      using std::pow;
                      return pow(1 + x, 5) + pow(2 + y, -3) + pow(1 + x, 13) + pow(1.5 + x * x, y);
                    },
                    u, lambda));
  add("choices",
      trace(
          [](auto x, auto y) {
            using std::abs;
            return vector3<decltype(x)>(duet::select((x < y || !(x <= 0.3)) && isfinite(x),
                                                     [&] { return x * y; }, [&] { return x - y; }),
                                        max(x, y) - min(x, 1 - y), abs(x - y) + copysign(x, y));
          },
          u, lambda));
  add("functions", trace(
                       [](auto x) {
                         using std::atan2;
                         const auto y = 1 + x * x;
                         return exp2(x) + expm1(x) + log2(y) + log10(y) + log1p(y) + tan(x / 2) +
                                asin(x / 4) + acos(x / 4) + atan(x) + sinh(x) + cosh(x) + tanh(x) +
                                asinh(x) + acosh(1 + y) + atanh(x / 4) + erf(x) + erfc(x) +
                                tgamma(y) + lgamma(y) + cbrt(x) + floor(x) + ceil(x) + trunc(x) +
                                round(x) + atan2(x, y) + hypot(x, y) + fmod(x, 0.3) +
                                remainder(x, 0.3) + fma(x, y, y) + sqrt(y);
                       },
                       u));
  add("arc", trace([](auto x, auto a, auto b) { return duet::slerp(a, b, x); }, u, q, p));
  add("logarithm", trace([](auto a) { return duet::log(a); }, A));
  add("sum_of_squares",
      reverse_gradient(trace([](auto a, auto x) { return a.dot(a) * x - sin(x * a[0]); }, w, u),
                       {"w", "u"}));
  return result;
}

// Arrays of numbers as C has them.
std::string list_of(const std::vector<double>& x) {
  std::string text = "{";
  for (std::size_t i = 0; i < x.size(); ++i) {
    char digits[40];
    std::snprintf(digits, sizeof(digits), "%s%.17g", i > 0 ? ", " : "", x[i]);
    text += std::string(digits) == "nan" ? "NAN" : digits;
  }
  return text + "}";
}

/// The numbers of values in the order of the code.
std::vector<double> in_code_order(const std::vector<named_value>& values,
                                  const std::vector<double>& numbers) {
  std::vector<double> result(numbers.size());
  std::size_t begin = 0;
  for (const named_value& x : values) {
    const int size = x.rows * x.columns;
    for (int k = 0; k < size; ++k) {
      result[begin + std::size_t(detail::index_in_code(x, k, true))] =
          numbers[begin + std::size_t(k)];
    }
    begin += std::size_t(size);
  }
  return result;
}

/// A program in C that calls the function at its inputs, and counts what differs.
std::string c_check(const code_case& c, bool is_single) {
  const std::string type = is_single ? "float" : "double";
  const std::string literal = is_single ? "(float)" : "";
  std::string calls, declaration = "void " + c.name + "(";
  std::vector<std::string> parameters, arguments;
  const auto add = [&](const std::vector<named_value>& values, const char* array, bool is_output) {
    int begin = 0;
    for (const named_value& x : values) {
      const int size = x.rows * x.columns;
      const std::string at = std::string(array) + " + " + std::to_string(begin);
      const bool is_number = x.kind == shape::scalar && !is_output;
      parameters.push_back(is_number ? type : (is_output ? "" : "const ") + type + "*");
      arguments.push_back(is_number ? "*(" + at + ")" : at);
      begin += size;
    }
  };
  add(c.formula.inputs(), "x", false);
  add(c.formula.outputs(), "y", true);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    declaration += (k > 0 ? ", " : "") + parameters[k];
  }
  std::string text = declaration + ");\n";
  text += "static void check_" + c.name + "(void)\n{\n";
  for (const std::vector<double>& inputs : c.inputs) {
    const std::vector<double> expected =
        in_code_order(c.formula.outputs(), evaluate(c.formula, inputs));
    text += "  {\n    const double in[] = " + list_of(in_code_order(c.formula.inputs(), inputs)) +
            ";\n    const double out[] = " + list_of(expected) + ";\n    " + type + " x[" +
            std::to_string(inputs.size()) + "], y[" + std::to_string(expected.size()) +
            "];\n    int i;\n    for (i = 0; i < " + std::to_string(inputs.size()) +
            "; ++i) { x[i] = (" + type + ")in[i]; }\n    " + c.name + "(";
    for (std::size_t k = 0; k < arguments.size(); ++k) {
      text += (k > 0 ? ", " : "") + arguments[k];
    }
    text += ");\n    for (i = 0; i < " + std::to_string(expected.size()) + "; ++i) { compare(\"" +
            c.name + "\", i, (double)y[i], out[i]); }\n  }\n";
  }
  return text + "}\n";
}

void write_c(const std::filesystem::path& folder, bool is_single) {
  const std::string suffix = is_single ? "_float" : "";
  std::ofstream main(folder / ("check" + suffix + ".c"));
  main << "#include <math.h>\n#include <stdio.h>\n\nstatic int differences = 0;\n"
          "static double largest = 0;\n"
          "static void compare(const char* name, int i, double a, double b)\n{\n"
          "  const double error = fabs(a - b) / (1 + fabs(b));\n"
          "  if (a != a && b != b) { return; }\n"
          "  if (error > largest) { largest = error; }\n"
       << "  if (!(error <= " << (is_single ? "2e-4" : "4e-15") << ")) {\n"
       << "    printf(\"%s[%d]: %.17g instead of %.17g\\n\", name, i, a, b);\n"
          "    ++differences;\n  }\n}\n\n";
  std::string calls;
  for (const code_case& c : cases()) {
    std::ofstream file(folder / (c.name + suffix + ".c"));
    file << to_c(c.formula, c.name, {.is_single_precision = is_single});
    main << c_check(c, is_single) << "\n";
    calls += "  check_" + c.name + "();\n";
  }
  main << "int main(void)\n{\n"
       << calls
       << "  printf(\"largest relative error %.3g\\n\", largest);\n  return differences != 0;\n}\n";
}

} // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "usage: emitted_code <folder>\n";
    return 1;
  }
  std::filesystem::create_directories(arguments[1]);
  write_c(arguments[1], false);
  write_c(arguments[1], true);
}
