// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Writes formulas as code, and programs in the same languages that compare each function with what
// duet computes; check.cmake compiles and runs them.

#include <duet/dual_quaternion/screw.hpp>
#include <duet/expression/code/c.hpp>
#include <duet/expression/code/cpp.hpp>
#include <duet/expression/code/matlab.hpp>
#include <duet/expression/code/python.hpp>
#include <duet/expression/condition.hpp>
#include <duet/expression/functions_of_many.hpp>
#include <duet/expression/gradient.hpp>
#include <duet/expression/graph/read_formula.hpp>
#include <duet/expression/graph/reverse.hpp>
#include <duet/expression/jacobian.hpp>
#include <duet/expression/matrix.hpp>
#include <duet/expression/motion.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/screw.hpp>
#include <duet/quaternion/curves.hpp>
#include <duet/quaternion/exponential.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
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
  bool is_for_float = true; ///< false at inputs that float cannot represent
};

constexpr symbol<"u"> u;
constexpr symbol<"lambda"> lambda;
constexpr symbol<"end"> end;
constexpr symbol<"I"> I;
constexpr symbol<"y0"> y0;
constexpr symbol<"θ"> theta;
constexpr symbol<"named"> named;
constexpr symbol<"_x"> underscore;
constexpr symbol<"duet_round"> helper;
constexpr symbol<"many"> many;
constexpr symbol<"result"> result_symbol;
constexpr symbol<"np"> np;
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
  add("reserved",
      gradient(sin(underscore * helper) + np * many + result_symbol, wrt(many, result_symbol)));
  add("unused", trace([](auto x, auto) { return x * x; }, u, w));
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
  const double infinity = std::numeric_limits<double>::infinity();
  add("infinite",
      trace([&](auto x) { return max(min(x, decltype(x)(infinity)), decltype(x)(-infinity)); }, u));
  add("large_constants",
      trace([](auto x) { return max(min(x, decltype(x)(1e300)), decltype(x)(-1e300)); }, u));
  add("elementary", trace(
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
  add("arc_alone",
      trace([](auto x, auto y) { return duet::arc_ratio(x * x, 1 + y * y); }, u, lambda));
  add("logarithm", trace([](auto a) { return duet::log(a); }, A));
  add("sum_of_squares",
      reverse_gradient(trace([](auto a, auto x) { return a.dot(a) * x - sin(x * a[0]); }, w, u),
                       {"w", "u"}));
  // Where functions are not defined, and where languages round differently.
  const auto add_at = [&](const char* name, const formula_graph& f,
                          const std::vector<std::vector<double>>& inputs) {
    result.push_back({name, f, inputs, false});
  };
  std::vector<std::vector<double>> numbers;
  for (const double x : {-2.5, -2.0, -1.5, -1.0, -0.5, -0.3, -0.0, 0.0, 0.3, 0.5, 1.0, 1.5, 2.5,
                         3.0, 1e300, infinity, -infinity}) {
    numbers.push_back({x});
  }
  add_at("domains",
         trace(
             [](auto x) {
               const auto number = [](auto y) {
                 return duet::select(
                     isnan(y), [&] { return decltype(y)(7); }, [&] { return y; });
               };
               return std::array{number(sqrt(x)),     number(log(x)),   number(log2(x)),
                                 number(log10(x)),    number(log1p(x)), number(asin(x)),
                                 number(acos(x)),     number(acosh(x)), number(atanh(x)),
                                 number(pow(x, 0.5)), number(cbrt(x)),  number(erf(x)),
                                 number(erfc(x))};
             },
             u),
         numbers);
  add_at("rounded",
         trace(
             [](auto x) {
               const auto number = [](auto y) { // tells −0 from 0
                 return y + copysign(decltype(y)(100), y);
               };
               return std::array{number(round(x)),     number(floor(x)),
                                 number(ceil(x)),      number(trunc(x)),
                                 number(fmod(x, 0.5)), number(remainder(x, 1.0)),
                                 number(sqrt(x)),      number(-x)};
             },
             u),
         numbers);
  add_at("gammas",
         trace(
             [](auto x) {
               return std::array{tgamma(x), lgamma(x)};
             },
             u),
         {{-2.5},
          {-1.5},
          {-0.3},
          {0.1},
          {1.0},
          {2.0},
          {5.5},
          {20.0},
          {-1.0},
          {-0.0},
          {0.0},
          {-1e-310}});
  add_at("divided",
         trace(
             [](auto x, auto y) {
               return std::array{fmod(x, y), remainder(x, y), pow(x, y), atan2(x, y), hypot(x, y)};
             },
             u, lambda),
         {{5, 3},
          {-5, 3},
          {5.5, -1},
          {3, 2},
          {-3, 2},
          {5, 2},
          {0.9, 0.3},
          {1e300, 0.7},
          {1e-310, 3e-320},
          {1.5e308, 1.2e308},
          {1, infinity},
          {infinity, 1},
          {1, 0},
          {0, 0},
          {-8, 1.0 / 3},
          {-2, 3},
          {-2, -3},
          {0.1, 1e-3},
          {-1, infinity},
          {7, -infinity},
          {-1, 0x1p40 + 1},
          {-1.5, 3e9},
          {-1, -8589934593},
          {-2, -1e17},
          {-infinity, 0.5}});
  add_at("fused", trace([](auto x, auto y) { return fma(x, y, y); }, u, lambda),
         {{2, 3}, {1e200, 1e200}, {1e200, -1e200}, {-1e308, 10}, {infinity, 1}, {1e-200, 1e-200}});
  return result;
}

/// Inputs of two angles: small and large ones, and next to multiples of pi/2 and pi/4.
std::vector<std::vector<double>> pairs_of_angles() {
  std::vector<std::vector<double>> result = {{-0.0, 0.0}, {8e5, -8e5}};
  for (const double scale : {0.0, 1e-300, 1e-8, 0.3, 0.78, 1.6, 3.2, 40.0, 1e4, 7.9e5, 1e6}) {
    for (int k = 0; k < 40; ++k) {
      result.push_back({scale * std::sin(1.0 + k), scale * std::cos(2.3 * k)});
    }
  }
  const double half_pi = std::acos(0.0);
  for (const int k : {-7, -4, -3, -2, -1, 1, 2, 3, 4, 7, 1001, 500000}) {
    result.push_back({k * half_pi, k * half_pi / 2});
    result.push_back({std::nextafter(k * half_pi, 1e9), -k * half_pi});
  }
  return result;
}

std::string number_text(double x) {
  if (std::isnan(x)) {
    return "NAN";
  }
  return std::isinf(x) ? (x < 0 ? "-INFINITY" : "INFINITY") : detail::number_literal(x);
}

/// Numbers with brackets around them.
std::string list_of(const std::vector<double>& x, const char* open = "{", const char* close = "}") {
  std::string text = open;
  for (std::size_t i = 0; i < x.size(); ++i) {
    text += (i > 0 ? ", " : "") + number_text(x[i]);
  }
  return text + close;
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

/// Writes a text that must be the same each time.
template <class Text>
void write_file(const std::filesystem::path& path, const Text& text) {
  const std::string first = text();
  if (text() != first) {
    std::cerr << path << " is not the same twice\n";
    std::exit(1);
  }
  std::ofstream(path) << first;
}

void write_c(const std::filesystem::path& folder, bool is_single) {
  const std::string suffix = is_single ? "_float" : "";
  std::ofstream main(folder / ("check" + suffix + ".c"));
  main << "#include <math.h>\n#include <stdio.h>\n#include <string.h>\n\n"
          "static int differences = 0;\n"
          "static double largest = 0;\n"
          "static void compare(const char* name, int i, double a, double b)\n{\n"
          "  const double error = fabs(a - b) / (1 + fabs(b));\n"
          "  if ((a != a && b != b) || a == b) { return; }\n"
          "#ifdef __NEWLIB__ /* tgamma has +infinity at all poles there */\n"
          "  if (isinf(a) && a > 0 && !isfinite(b) && i == 0 && !strcmp(name, \"gammas\")) { "
          "return; }\n#endif\n"
          "  if (error > largest) { largest = error; }\n"
       << "  if (!(error <= " << (is_single ? "2e-4" : "4e-15") << ")) {\n"
       << "    printf(\"%s[%d]: %.17g instead of %.17g\\n\", name, i, a, b);\n"
          "    ++differences;\n  }\n}\n\n";
  std::string calls;
  for (const code_case& c : cases()) {
    if (is_single && !c.is_for_float) {
      continue;
    }
    write_file(folder / (c.name + suffix + ".c"),
               [&] { return to_c(c.formula, c.name, {.is_single_precision = is_single}); });
    main << c_check(c, is_single) << "\n";
    calls += "  check_" + c.name + "();\n";
  }
  main << "int main(void)\n{\n"
       << calls
       << "  printf(\"largest relative error %.3g\\n\", largest);\n  return differences != 0;\n}\n";
}

/// Sines by duet's own algorithm: the bits of the typed formula. Beyond 8e5 they are the C
/// library's.
void write_sines(const std::filesystem::path& folder) {
  const auto f = gradient(sin(u) * cos(lambda) + cos(u + lambda), wrt(u, lambda));
  write_file(folder / "sines.c", [&] { return to_c(f, "sines", {.has_own_sines = true}); });
  std::ofstream main(folder / "check_sines.c");
  main << "#include <math.h>\n#include <stdio.h>\n"
          "void sines(double, double, double*, double*);\n"
          "static const double rows[][5] = {\n";
  for (const std::vector<double>& x : pairs_of_angles()) {
    const auto y = f(u = x[0], lambda = x[1]);
    main << "  " << list_of({x[0], x[1], y.value, y.gradient[0], y.gradient[1]}) << ",\n";
  }
  main << "};\nint main(void)\n{\n  int differences = 0, i, k;\n"
          "  const int count = (int)(sizeof(rows) / sizeof(rows[0]));\n"
          "  for (i = 0; i < count; ++i) {\n    double y[3], tolerance = "
#ifdef __FMA__ // duet fuses products with sums then, in its own polynomials, too
          "4.5e-16"
#else
          "0" // the same bits, except for signs of zeros
#endif
          ";\n#ifdef __NEWLIB__ /* another C library than duet's */\n"
          "    const double u = rows[i][0], v = rows[i][1];\n"
          "    if (fmax(fabs(u), fmax(fabs(v), fabs(u + v))) >= 8e5) { tolerance = 4.5e-16; }\n"
          "#endif\n"
          "    sines(rows[i][0], rows[i][1], &y[0], &y[1]);\n"
          "    for (k = 0; k < 3; ++k) {\n"
          "      if (!(fabs(y[k] - rows[i][2 + k]) <= tolerance)) {\n"
          "        printf(\"sines(%.17g, %.17g)[%d]: %.17g instead of %.17g\\n\", rows[i][0],\n"
          "               rows[i][1], k, y[k], rows[i][2 + k]);\n        ++differences;\n"
          "      }\n    }\n  }\n"
          "  printf(\"%d of %d results differ\\n\", differences, 3 * count);\n"
          "  return differences != 0;\n}\n";
}

void write_cpp(const std::filesystem::path& folder) {
  std::ofstream main(folder / "check.cpp");
  std::string calls;
  for (const bool is_single : {false, true}) {
    for (const code_case& c : cases()) {
      if (is_single && !c.is_for_float) {
        continue;
      }
      const std::string name = c.name + (is_single ? "_float" : "");
      write_file(folder / (name + ".hpp"), [&] {
        return to_cpp(c.formula, name,
                      {.is_single_precision = is_single, .has_own_sines = !is_single});
      });
      main << "#include \"" << name << ".hpp\"\n";
      const std::string type = is_single ? "float" : "double";
      std::string arguments, results;
      int begin = 0;
      for (const named_value& x : c.formula.inputs()) {
        const std::string at = "x + " + std::to_string(begin);
        arguments += arguments.empty() ? "" : ", ";
        arguments += x.kind == shape::scalar ? "*(" + at + ")"
                                             : "Eigen::Map<const Eigen::Matrix<" + type + ", " +
                                                   std::to_string(x.rows) + ", " +
                                                   std::to_string(x.columns) + ">>(" + at + ")";
        begin += x.rows * x.columns;
      }
      std::string comparisons;
      for (std::size_t k = 0; k < c.formula.outputs().size(); ++k) {
        const std::string result = "y" + std::to_string(k);
        results += (k > 0 ? ", " : "") + result;
        comparisons += " compare(\"" + name + "\", " + result + ", out);";
      }
      results = c.formula.outputs().size() == 1 ? results : "[" + results + "]";
      for (const std::vector<double>& x : c.inputs) {
        calls += "  {\n    const double in[] = " + list_of(x) +
                 ", outputs[] = " + list_of(evaluate(c.formula, x)) + ", *out = outputs;\n    " +
                 type + " x[" + std::to_string(x.size()) +
                 "];\n    std::copy(std::begin(in), std::end(in), x);\n" + "    const auto " +
                 results + " = " + name + "(" + arguments + ");\n   " + comparisons + "\n  }\n";
      }
    }
  }
  main << R"(#include <algorithm>
#include <cstdio>
#include <iterator>

namespace {

int differences = 0;
double largest[2] = {0, 0};

void compare_number(const char* name, double a, double b, bool is_single) {
  if ((a != a && b != b) || a == b) {
    return;
  }
  const double error = std::fabs(a - b) / (1 + std::fabs(b));
  largest[is_single] = std::max(largest[is_single], error);
  if (!(error <= (is_single ? 2e-4 : 4e-15))) {
    std::printf("%s: %.17g instead of %.17g\n", name, a, b);
    ++differences;
  }
}
template <class Y>
void compare(const char* name, const Y& y, const double*& out) {
  if constexpr (std::is_floating_point_v<Y>) {
    compare_number(name, y, *out++, sizeof(Y) == 4);
  } else {
    for (Eigen::Index j = 0; j < y.cols(); ++j) {
      for (Eigen::Index i = 0; i < y.rows(); ++i) {
        compare_number(name, y(i, j), *out++, sizeof(typename Y::Scalar) == 4);
      }
    }
  }
}

} // namespace

int main() {
)" << calls
       << "  std::printf(\"largest relative error %.3g, of float %.3g\\n\", largest[0], "
          "largest[1]);\n"
          "  return differences != 0;\n}\n";
}

/// The dimensions of values. \param as_text  of one
template <class AsText>
std::string list_of_dimensions(const std::vector<named_value>& values, const AsText& as_text) {
  std::string text;
  for (const named_value& x : values) {
    text += (text.empty() ? "" : ", ") + as_text(x);
  }
  return text;
}

void write_python(const std::filesystem::path& folder) {
  std::ofstream main(folder / "check.py");
  main << R"(import sys
from math import inf as INFINITY, nan as NAN

import numpy as np

largest = 0.0
differences = 0


def split(dims, numbers):
    """The flat numbers, with those of many inputs behind, as arrays of the dimensions."""
    result, begin = [], 0
    for d in dims:
        size = int(np.prod(d))
        result.append(numbers[begin:begin + size].reshape(d + numbers.shape[1:]))
        begin += size
    return result


def compare(name, y, expected, dims):
    global largest, differences
    for a, b in zip(y if len(dims) > 1 else (y,), split(dims, expected)):
        assert np.shape(a) == b.shape, f"{name}: shape {np.shape(a)} instead of {b.shape}"
        with np.errstate(all="ignore"):
            error = np.abs(a - b) / (1 + np.abs(b))
        error = np.where((a == b) | (np.isnan(a) & np.isnan(b)), 0.0, error)
        if not np.all(error <= 4e-15):
            print(f"{name}: {a} instead of {b}")
            differences += 1
        largest = max(largest, float(np.max(error, initial=0.0)))


def check(name, input_dims, output_dims, *rows):
    function = getattr(__import__(name), name)
    assert function.__doc__
    inputs = np.array([x for x, y in rows]).T
    outputs = np.array([y for x, y in rows]).T
    for k in range(len(rows)):
        compare(name, function(*split(input_dims, inputs[:, k])), outputs[:, k], output_dims)
    compare(name, function(*split(input_dims, inputs)), outputs, output_dims)


)";
  const auto dimensions = [](const named_value& x) { return detail::python_dimensions(x); };
  for (const code_case& c : cases()) {
    write_file(folder / (c.name + ".py"), [&] { return to_python(c.formula, c.name); });
    main << "check(\"" << c.name << "\", [" << list_of_dimensions(c.formula.inputs(), dimensions)
         << "], [" << list_of_dimensions(c.formula.outputs(), dimensions) << "]";
    for (const std::vector<double>& x : c.inputs) {
      main << ",\n      (" << list_of(in_code_order(c.formula.inputs(), x), "[", "]") << ", "
           << list_of(in_code_order(c.formula.outputs(), evaluate(c.formula, x)), "[", "]") << ")";
    }
    main << ")\n";
  }
  main << R"(
import damped

try:
    damped.damped(0.5, np.zeros((2, 3)))
    sys.exit("no error of a vector of 2")
except ValueError as error:
    print(error)
print(f"largest relative error {largest:.3g}")
sys.exit(differences != 0)
)";
}

void write_matlab(const std::filesystem::path& folder) {
  std::ofstream main(folder / "check.m");
  main << R"(1;
NAN = NaN;
INFINITY = Inf;

function largest = compare_case(name, input_sizes, output_sizes, inputs, outputs, largest)
  for row = 1:rows(inputs)
    x = split(input_sizes, inputs(row, :));
    y = cell(1, numel(output_sizes));
    [y{:}] = feval(name, x{:});
    expected = split(output_sizes, outputs(row, :));
    for k = 1:numel(y)
      assert(size(y{k}), size(expected{k}));
      assert(isreal(y{k}));
      error_of = abs(y{k} - expected{k}) ./ (1 + abs(expected{k}));
      error_of(y{k} == expected{k} | (isnan(y{k}) & isnan(expected{k}))) = 0;
      if any(~(error_of(:) <= 4e-15))
        printf('%s: %s instead of %s, at %s\n', name, mat2str(y{k}, 17), ...
               mat2str(expected{k}, 17), mat2str(inputs(row, :), 17));
        largest(2) = largest(2) + 1;
      end
      largest(1) = max([largest(1); error_of(:)]);
    end
  end
end
function x = split(sizes, numbers)
  x = {};
  for k = 1:numel(sizes)
    count = prod(sizes{k});
    x{k} = reshape(numbers(1:count), sizes{k});
    numbers = numbers(count + 1:end);
  end
end

largest = [0, 0];
)";
  const auto dimensions = [](const named_value& x) {
    return "[" + std::to_string(x.rows) + ", " + std::to_string(x.columns) + "]";
  };
  for (const code_case& c : cases()) {
    write_file(folder / (c.name + ".m"), [&] { return to_matlab(c.formula, c.name); });
    main << "largest = compare_case('" << c.name << "', {"
         << list_of_dimensions(c.formula.inputs(), dimensions) << "}, {"
         << list_of_dimensions(c.formula.outputs(), dimensions) << "}, [";
    for (const std::vector<double>& x : c.inputs) {
      main << list_of(x, "", ";\n");
    }
    main << "], [";
    for (const std::vector<double>& x : c.inputs) {
      main << list_of(evaluate(c.formula, x), "", ";\n");
    }
    main << "], largest);\n";
  }
  main << "printf('largest relative error %.3g\\n', largest(1));\nexit(largest(2) > 0);\n";
}

/// Ends the program unless the code is refused.
template <class Emit>
void require_refused(const char* what, const Emit& emit) {
  try {
    (void)emit();
  } catch (const duet::invalid_input&) {
    return;
  }
  std::cerr << what << " is not refused\n";
  std::exit(1);
}

} // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "usage: emitted_code <folder>\n";
    return 1;
  }
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  for (const char* const name : {"", "lambda", "2x", "_x", "a b", "θ"}) {
    require_refused(name, [&] { return to_c(u + 1, name); });
    require_refused(name, [&] { return to_cpp(u + 1, name); });
    require_refused(name, [&] { return to_python(u + 1, name); });
    require_refused(name, [&] { return to_matlab(u + 1, name); });
  }
  require_refused("sines in float", [] {
    return to_c(u + 1, "f", {.is_single_precision = true, .has_own_sines = true});
  });
  const std::string greek = to_c(read_formula("θ₁ + Γ + ζ_0"), "f");
  if (greek.find("double theta1, double Gamma, double zeta_0") == std::string::npos) {
    std::cerr << "Greek letters and indices are not spelt out: " << greek;
    return 1;
  }
  write_c(folder, false);
  write_c(folder, true);
  write_sines(folder);
  write_cpp(folder);
  write_python(folder);
  write_matlab(folder);
}
