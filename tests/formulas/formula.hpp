// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/dual/math.hpp>
#include <duet/interop/multiprecision.hpp>

/// \file
/// A formula of the documents by four methods: duet over duals, Taylor numbers and nested duals, an
/// expression, the closed form of textbooks, and this closed form in 50 digits as the reference.

namespace duet_formulas {

using wide = duet::real_50;
template <class T>
using numbers = std::vector<T>;

/// Kind of an argument; its special values are those at which formulas may fail.
enum class argument {
  number,     ///< any
  fraction,   ///< from 0 to 1
  vector,     ///< three components
  rotation,   ///< a rotation vector: zero, tiny, half turn, nearly full turn
  quaternion, ///< four components, not zero
};

/// Bounds of the errors relative to the reference.
struct bounds {
  double value = 4;          ///< bound of the formula, in ulp
  double slope = 16;         ///< bound of its first derivative, in ulp
  double expression = slope; ///< bound of both for the formula as an expression
};

/// One row of the table.
struct formula {
  std::string label;
  std::string text;     ///< the formula, in TeX
  std::string function; ///< function that computes it
  std::string header;   ///< path below include/duet/, or beginning with examples/
  std::vector<argument> arguments;
  bounds limits;
  /// True if all arguments except the last are constant.
  bool only_last_moves = false;
  /// True if the formula is defined at this input.
  std::function<bool(const numbers<double>&)> is_valid;

  /// Value and first derivative along a direction, concatenated.
  std::function<numbers<double>(const numbers<double>&, const numbers<double>&)> closed;
  std::function<numbers<wide>(const numbers<wide>&, const numbers<wide>&)> reference;
  /// Value and first derivative by duet over duals; over Taylor numbers and nested duals also the
  /// second derivative.
  std::function<numbers<double>(const numbers<double>&, const numbers<double>&)> dual;
  std::function<numbers<double>(const numbers<double>&, const numbers<double>&)> taylor;
  std::function<numbers<double>(const numbers<double>&, const numbers<double>&)> nested;
};

/// A row by a further method: an expression over symbols, which the compiler differentiates.
class expression_route {
public:
  std::string label;
  std::string function;   ///< label and function identify the row
  std::string text;       ///< the expression
  std::string derivative; ///< function that differentiates it

  expression_route(std::string row_label, std::string row_function)
      : label(std::move(row_label)), function(std::move(row_function)) {}
  /// A row computed by a separate function.
  template <class Values>
  expression_route(std::string row_label, std::string row_function, std::string expression,
                   std::string differentiated_by, const Values& values)
      : label(std::move(row_label)), function(std::move(row_function)), text(std::move(expression)),
        derivative(std::move(differentiated_by)), all_(values) {}

  /// Adds a formula to the result: its value, and its derivative along all variable inputs.
  template <class F, class Moves, class Stands = std::tuple<>>
  expression_route part(const F& f, const Moves& moves, const Stands& stands = {}) &&;

  /// Value and first derivative along a direction, concatenated.
  numbers<double> operator()(const numbers<double>& x, const numbers<double>& d) const {
    if (all_) {
      return all_(x, d);
    }
    numbers<double> y;
    for (const auto& value : values_) {
      value(y, x);
    }
    for (const auto& slope : slopes_) {
      slope(y, x, d);
    }
    return y;
  }

private:
  std::function<numbers<double>(const numbers<double>&, const numbers<double>&)> all_;
  std::vector<std::function<void(numbers<double>&, const numbers<double>&)>> values_;
  std::vector<std::function<void(numbers<double>&, const numbers<double>&, const numbers<double>&)>>
      slopes_;
};

/// Values of all, then first derivatives of all, and so on, by f(part) = {value, derivative, …}.
template <class T, class F>
numbers<double> listed(const numbers<T>& y, const F& f) {
  numbers<double> result;
  for (std::size_t k = 0; k < f(y[0]).size(); ++k) {
    for (const T& part : y) {
      result.push_back(f(part)[k]);
    }
  }
  return result;
}

/// `library` and `closed` are templates over the scalar: library(x) → f(x) with duet, and
/// closed(x, ẋ) → f and ∂f/∂x ẋ written out.
template <class Library, class Closed>
formula make_formula(std::string label, std::string text, std::string function, std::string header,
                     std::vector<argument> arguments, const Library& library, const Closed& closed,
                     bounds limits = {},
                     std::function<bool(const numbers<double>&)> is_valid = {}) {
  formula f;
  f.label = std::move(label);
  f.text = std::move(text);
  f.function = std::move(function);
  f.header = std::move(header);
  f.arguments = std::move(arguments);
  f.limits = limits;
  f.is_valid = std::move(is_valid);
  using first = duet::dual<double, 1, duet::derivative_tag<struct inner>>;
  using second = duet::dual<first, 1, duet::derivative_tag<struct outer>>;
  using series = duet::taylor<double, 2>;
  f.closed = [closed](const numbers<double>& x, const numbers<double>& d) { return closed(x, d); };
  f.reference = [closed](const numbers<wide>& x, const numbers<wide>& d) { return closed(x, d); };
  f.dual = [library](const numbers<double>& x, const numbers<double>& d) {
    numbers<first> s;
    for (std::size_t i = 0; i < x.size(); ++i) {
      s.push_back(first(x[i], d[i]));
    }
    const numbers<first> y = library(s);
    return listed(y, [](const first& part) { return std::array{part.value(), part.epsilon()}; });
  };
  f.nested = [library](const numbers<double>& x, const numbers<double>& d) {
    numbers<second> s;
    for (std::size_t i = 0; i < x.size(); ++i) {
      s.push_back(second(first(x[i], d[i]), first(d[i], 0)));
    }
    const numbers<second> y = library(s);
    return listed(y, [](const second& part) {
      return std::array{part.value().value(), part.value().epsilon(), part.epsilon().epsilon()};
    });
  };
  f.taylor = [library](const numbers<double>& x, const numbers<double>& d) {
    numbers<series> s;
    for (std::size_t i = 0; i < x.size(); ++i) {
      s.push_back(x[i] + d[i] * series::variable(0));
    }
    const numbers<series> y = library(s);
    return listed(y, [](const series& part) {
      return std::array{part.derivative(0), part.derivative(1), part.derivative(2)};
    });
  };
  return f;
}

} // namespace duet_formulas
