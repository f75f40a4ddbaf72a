// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Every formula of the documents by every method, and its error relative to 50 digits. The table is
// printed and written to the file that docs/reference/formulas.md is generated from. The test fails
// if an error of duet exceeds its bound, if a label has no row, or if docs/reference/formulas.md
// has another row.

#include "formulas/table.hpp"
#include "formulas/labels.hpp"
#include "support/identical.hpp"
#include "support/test.hpp"

#include <duet/core/constants.hpp>
#include <duet/core/errors.hpp>

#include <fstream>
#include <iomanip>
#include <iostream>

namespace {

using namespace duet_formulas;

/// Special values of an argument, one after the other, then random ones.
numbers<double> values_of(argument a, std::size_t i, duet_test::random_source& random) {
  const double pi = duet::constant::pi<double>();
  static const std::vector<numbers<double>> special_numbers = {{1},    {-2},     {0.5}, {3},
                                                               {1e-8}, {1e-150}, {-1}};
  static const std::vector<numbers<double>> special_fractions = {{0}, {1}, {0.5}, {1e-8}, {0.25}};
  static const std::vector<numbers<double>> special_vectors = {
      {0, 0, 0}, {1, 0, 0}, {0, 0, -2}, {1e-8, 0, 1e-8}, {0, 1e-160, 0}, {0.3, -0.7, 100}};
  static const std::vector<numbers<double>> special_rotations = {
      {0, 0, 0},       {1e-300, 0, 0},          {0, 1e-160, 0},        {0, 0, 1e-8},
      {1e-4, 1e-4, 0}, {0, 1.999, 0},           {0, 2.001, 0},         {0.3, 0.4, -0.5},
      {pi, 0, 0},      {0, 0.6 * pi, 0.8 * pi}, {0, 0, 2 * pi - 1e-3}, {2 * pi - 1e-6, 0, 0}};
  static const std::vector<numbers<double>> special_quaternions = {
      {1, 0, 0, 0},        {0, 1, 0, 0},     {0.5, 0.5, -0.5, 0.5}, {1, 1e-300, 0, 0},
      {1, 0, 1e-160, 0},   {2, 1e-8, 0, 0},  {0.7, 0, 0, 1e-4},     {1e-70, 0, 2e-70, 1e-70},
      {1e70, -1e70, 0, 0}, {-1, 0, 2e-3, 0}, {-0.3, 0.1, 2, 1}};
  const auto& special = a == argument::number     ? special_numbers
                        : a == argument::fraction ? special_fractions
                        : a == argument::vector   ? special_vectors
                        : a == argument::rotation ? special_rotations
                                                  : special_quaternions;
  if (i < special.size()) {
    return special[i];
  }
  if (a == argument::number) {
    return {random.uniform(-2, 2)};
  }
  if (a == argument::fraction) {
    return {random.uniform(0, 1)};
  }
  const double size = a == argument::rotation ? random.uniform(0, 6.2) : random.uniform(0, 3);
  if (a == argument::quaternion) {
    const auto n = random.direction<4>();
    return {n[0] * size, n[1] * size, n[2] * size, n[3] * size};
  }
  const auto n = random.direction<3>();
  return {n[0] * size, n[1] * size, n[2] * size};
}

/// Special values of all arguments in varying combinations, then random ones.
std::vector<numbers<double>> inputs_of(const formula& f) {
  duet_test::random_source random(5);
  constexpr std::size_t special = 48;
  constexpr std::size_t count = 96;
  std::vector<numbers<double>> result;
  for (std::size_t i = 0; i < count; ++i) {
    numbers<double> x;
    for (std::size_t k = 0; k < f.arguments.size(); ++k) {
      const std::size_t which = i < special ? (i * (2 * k + 1) + i / 12 * k) % 13 : count;
      const auto values = values_of(f.arguments[k], which, random);
      x.insert(x.end(), values.begin(), values.end());
    }
    if (!f.is_valid || f.is_valid(x)) {
      result.push_back(x);
    }
  }
  return result;
}

wide largest(const numbers<wide>& y, std::size_t first, std::size_t count) {
  wide result = 0;
  for (std::size_t i = first; i < first + count; ++i) {
    result = std::max<wide>(result, abs(y[i]));
  }
  return result;
}

numbers<wide> widened(const numbers<double>& x) { return numbers<wide>(x.begin(), x.end()); }

/// Value, first and second derivative at one input in 50 digits, and the change of each by
/// the rounding of the arguments.
struct exact_values {
  numbers<wide> values;
  std::size_t size;
  std::array<wide, 3> scales;

  exact_values(const formula& f, const numbers<double>& x_double, const numbers<double>& d_double) {
    const numbers<wide> x = widened(x_double);
    const numbers<wide> d = widened(d_double);
    values = f.reference(x, d);
    size = values.size() / 2;
    const numbers<wide> second = second_derivative(f, x, d);
    values.insert(values.end(), second.begin(), second.end());
    for (std::size_t k = 0; k < 3; ++k) {
      scales[k] = largest(values, k * size, size);
    }
    scales[2] += scales[1] * wide("1e-16"); // differences cannot resolve a smaller derivative
    // ‖∂/∂x‖‖x‖ of all three, by relative differences.
    const wide step("1e-12");
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (x[i] == 0) {
        continue;
      }
      numbers<wide> moved = x;
      moved[i] *= 1 + step;
      numbers<wide> y = f.reference(moved, d);
      const numbers<wide> s = second_derivative(f, moved, d);
      y.insert(y.end(), s.begin(), s.end());
      for (std::size_t j = 0; j < y.size(); ++j) {
        y[j] -= values[j];
      }
      for (std::size_t k = 0; k < 3; ++k) {
        scales[k] += largest(y, k * size, size) / step;
      }
    }
  }

  /// Error of a method in ulp; negative if it does not compute the block.
  [[nodiscard]] double ulps(const numbers<double>& computed, std::size_t block) const {
    return ulps(computed, values, block);
  }
  /// Difference between two methods, in the same ulp.
  template <class T>
  [[nodiscard]] double ulps(const numbers<double>& computed, const numbers<T>& other,
                            std::size_t block) const {
    wide error = 0;
    for (std::size_t i = block * size; i < (block + 1) * size; ++i) {
      if (!std::isfinite(computed[i])) {
        return std::numeric_limits<double>::infinity();
      }
      error = std::max<wide>(error, abs(wide(computed[i] - wide(other[i]))));
    }
    return error == 0 ? 0 : double(wide(error / (scales[block] * wide(0x1p-53))));
  }

private:
  /// Second derivative by differences of the closed first derivative, exact to about 28 digits.
  static numbers<wide> second_derivative(const formula& f, const numbers<wide>& x,
                                         const numbers<wide>& d) {
    const wide h("1e-16"); // relative to a direction as large as the arguments
    numbers<wide> forth = x;
    numbers<wide> back = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
      forth[i] += h * d[i];
      back[i] -= h * d[i];
    }
    const numbers<wide> a = f.reference(forth, d);
    const numbers<wide> b = f.reference(back, d);
    numbers<wide> result;
    for (std::size_t i = a.size() / 2; i < a.size(); ++i) {
      result.push_back((a[i] - b[i]) / (2 * h));
    }
    return result;
  }
};

/// Largest errors of a formula by each method.
struct worst_errors {
  double value = 0;  ///< error of duet
  double closed = 0; ///< error of the textbook's derivative
  double dual = 0;   ///< error of derivatives over duals
  double taylor = 0; ///< error of first and second derivatives over Taylor numbers
  double nested = 0; ///< error of first and second derivatives over nested duals
  double highest = -1;
  std::string input;
  double expression = 0; ///< error of value and first derivative of the expression
  double from_dual = 0;  ///< difference of its first derivative from that over a dual
  std::string input_of_expression;
};

std::string text_of(const numbers<double>& x) {
  std::ostringstream text;
  text << std::setprecision(3);
  for (std::size_t i = 0; i < x.size(); ++i) {
    text << (i > 0 ? " " : "") << x[i];
  }
  return text.str();
}

/// A random direction; the part of an argument without another scale is as long as the argument.
numbers<double> direction(const formula& f, const numbers<double>& x,
                          duet_test::random_source& random) {
  numbers<double> d;
  for (const argument a : f.arguments) {
    const std::size_t count = a == argument::quaternion                          ? 4
                              : a == argument::number || a == argument::fraction ? 1
                                                                                 : 3;
    double size = 0;
    for (std::size_t i = d.size(); i < d.size() + count; ++i) {
      size = std::max(size, std::abs(x[i]));
    }
    const bool has_scale = a == argument::quaternion || a == argument::number;
    for (std::size_t i = 0; i < count; ++i) {
      d.push_back(random.uniform(-1, 1) * (has_scale ? size : std::max(size, 1.0)));
    }
  }
  if (f.only_last_moves) {
    std::fill(d.begin(), d.end() - 1, 0);
  }
  return d;
}

worst_errors measured(const formula& f, const expression_route& expression) {
  worst_errors worst;
  worst.expression = -1;
  duet_test::random_source random(9);
  const auto inputs = inputs_of(f);
  CHECK(inputs.size() >= 4);
  for (const auto& x : inputs) {
    const numbers<double> d = direction(f, x, random);
    const exact_values exact(f, x, d);
    const auto closed = f.closed(x, d);
    const auto dual = f.dual(x, d);
    const auto taylor = f.taylor(x, d);
    const auto nested = f.nested(x, d);
    worst.closed = std::max({worst.closed, exact.ulps(closed, 0), exact.ulps(closed, 1)});
    const double value = exact.ulps(dual, 0);
    const double slope = exact.ulps(dual, 1);
    const double series = std::max(exact.ulps(taylor, 1), exact.ulps(taylor, 2));
    const double nests = std::max(exact.ulps(nested, 1), exact.ulps(nested, 2));
    worst.value = std::max({worst.value, value, exact.ulps(taylor, 0), exact.ulps(nested, 0)});
    worst.dual = std::max(worst.dual, slope);
    worst.taylor = std::max(worst.taylor, series);
    worst.nested = std::max(worst.nested, nests);
    const auto as_expression = expression(x, d);
    CHECK(as_expression.size() == dual.size());
    const double of_expression =
        std::max(exact.ulps(as_expression, 0), exact.ulps(as_expression, 1));
    worst.from_dual = std::max(worst.from_dual, exact.ulps(as_expression, dual, 1));
    if (of_expression > worst.expression) {
      worst.expression = of_expression;
      worst.input_of_expression = text_of(x);
    }
    const double highest = std::max({value, slope, series, nests});
    if (highest > worst.highest) {
      worst.highest = highest;
      worst.input = text_of(x);
    }
  }
  return worst;
}

/// Relative error 1e-13 in ulp.
constexpr double second_derivative_limit = 1e-13 / 0x1p-53;

/// Two digits, or one digit for large numbers.
std::string ulp_text(double x) {
  std::ostringstream text;
  if (x >= 1e4) {
    text << std::scientific << std::setprecision(0) << x;
  } else {
    text << std::fixed << std::setprecision(x < 10 ? 1 : 0) << x;
  }
  return text.str();
}

/// The expression of a row.
expression_route expression_of(const formula& f, const std::vector<expression_route>& all) {
  const auto entry = std::find_if(all.begin(), all.end(), [&](const expression_route& e) {
    return e.label == f.label && e.function == f.function;
  });
  CAPTURE(f.label);
  CAPTURE(f.function);
  REQUIRE(entry != all.end());
  return *entry;
}

/// The part of a row that does not depend on a measurement.
std::string row_of(const formula& f) {
  const bool is_example = f.header.rfind("examples/", 0) == 0;
  return "| " + f.label + " | $" + f.text + "$ | [`" + f.function + "`](../../" +
         (is_example ? "" : "include/duet/") + f.header + ") |";
}
std::string row_of(const expression_route& e) {
  return "| " + e.label + " | " + e.text + " | " + e.derivative + " |";
}

} // namespace

TEST_CASE("formulas: every formula is within its bounds of 50 digits and is in the table") {
  std::ifstream file(DUET_FORMULAS_PAGE);
  std::ostringstream page;
  page << file.rdbuf();
  std::ostringstream table;
  std::map<std::string, int> rows;
  const auto require_row = [&](const std::string& row) {
    INFO("the page has no row ", row);
    CHECK(page.str().find("\n" + row) != std::string::npos);
  };
  const auto add = [&](const std::string& label, const std::string& row, const std::string& rest) {
    ++rows[label];
    table << row << rest << "\n";
    require_row(row);
  };

  std::vector<expression_route> expressions;
  for (const auto& group :
       {quaternion_expressions(), dual_quaternion_expressions(), planning_expressions(),
        motion_expressions(), experiment_expressions()}) {
    expressions.insert(expressions.end(), group.begin(), group.end());
  }
  std::ostringstream written;
  table << "| | formula | by | value | closed form | dual | Taylor | nested | expression | worst "
           "input |\n"
           "|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& group : {quaternion_formulas(), dual_formulas(), rigid_motion_formulas(),
                            planning_formulas(), motion_formulas(), experiment_formulas()}) {
    for (const formula& f : group) {
      const expression_route expression = expression_of(f, expressions);
      const worst_errors worst = measured(f, expression);
      add(f.label, row_of(f),
          " " + ulp_text(worst.value) + " | " + ulp_text(worst.closed) + " | " +
              ulp_text(worst.dual) + " | " + ulp_text(worst.taylor) + " | " +
              ulp_text(worst.nested) + " | " + ulp_text(worst.expression) + " | " + worst.input +
              " |");
      require_row(row_of(expression));
      written << row_of(expression) << " " << ulp_text(worst.from_dual) << " | "
              << worst.input_of_expression << " |\n";
      CAPTURE(f.label);
      CHECK(worst.value <= f.limits.value);
      CHECK(worst.dual <= f.limits.slope);
      CHECK(worst.taylor <= second_derivative_limit);
      CHECK(worst.nested <= second_derivative_limit);
      CHECK(worst.expression <= f.limits.expression * (1 + duet_test::if_fused(.5)));
    }
  }
  table << "\n| | as an expression | its derivative by | from the dual | worst input |\n"
           "|---|---|---|---|---|\n"
        << written.str();
  std::cout << table.str();
  std::ofstream(DUET_FORMULAS_TABLE) << table.str();

  for (const char* label : labels) {
    CAPTURE(label);
    CHECK(rows.erase(label) == 1);
  }
  CHECK(rows.empty()); // all labels are in the list
}
