// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/dual/rules/of_many.hpp>
#include <duet/dual/stumpff.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/functions_of_one.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/recorded.hpp>
#include <duet/expression/tree/number.hpp>

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// Values of graphs over any scalar: numbers, dual numbers, batches, and recorded numbers, which
/// make another graph of it.

namespace duet::expression::detail {

/// x^n as `power_by_products`, or by `pow`, which rounds once; slopes are n x^(n−1).
struct whole_power {
  int n;

  template <class S>
  [[nodiscard]] S value(const S& x) const {
    using std::pow;
    if constexpr (duet::detail::is_recording<S>) {
      return pow(x, S(n));
    } else if constexpr (Infinitesimal<S>) {
      return duet::detail::lift(*this, x);
    } else {
      return is_accurate_by_products(n) ? power_by_products(x, n) : S(pow(x, n));
    }
  }
  template <class S>
  [[nodiscard]] S slope(const S& x, const S&) const {
    return duet::detail::integer<S>(n) * whole_power{n - 1}.value(x);
  }
};

/// Stumpff functions of a higher order occur in derivatives of an order that nobody takes.
inline constexpr int max_stumpff = 24;

/// c_index(s) of a floating-point number, with the bits of `duet::stumpff`: the order is known when
/// the program runs alone, as instantiations for all orders take compilers seconds.
template <std::floating_point S>
[[nodiscard]] S stumpff_of_real(const S& s, int index) {
  if (index < 2 ? s <= S(1) : !duet::detail::is_beyond_series(s)) {
    constexpr bool has_double = std::numeric_limits<S>::digits <= 53;
    const int terms = index < 2 ? (has_double ? 10 : 13) : (has_double ? 13 : 15);
    const auto coefficients = duet::detail::stumpff_coefficients<S, 15>(index);
    const S square = s * s;
    const auto half = [&](int first) { // every other term
      int k = first + (terms - 1 - first) / 2 * 2;
      S sum = coefficients[std::size_t(k)];
      for (k -= 2; k >= first; k -= 2) {
        sum = coefficients[std::size_t(k)] + square * sum;
      }
      return sum;
    };
    return half(0) - s * half(1);
  }
  S c = index % 2 == 0 ? duet::stumpff<0>(s) : duet::stumpff<1>(s);
  for (int n = index % 2 + 2; n <= index; n += 2) {
    c = (duet::detail::inverse_factorial<S>(n - 2) - c) / s;
  }
  return c;
}

/// `rule::stumpff` of an order that is known when the program runs.
struct stumpff_of_order {
  int n;

  template <class S>
  [[nodiscard]] S value(const S& s) const {
    if constexpr (Infinitesimal<S>) {
      return duet::detail::lift(*this, s);
    } else if constexpr (duet::detail::is_recording<S>) {
      return s.is_constant() ? S(stumpff_of_real(s.number(), n)) : recorded_stumpff(s, n);
    } else if constexpr (std::floating_point<S>) {
      return stumpff_of_real(s, n);
    } else {
      return of_constant_order(s, std::make_integer_sequence<int, max_stumpff>{});
    }
  }
  template <class S>
  [[nodiscard]] S slope(const S& s, const S& y) const {
    const auto c = [&](int order) { return stumpff_of_order{order}.value(s); };
    if (n == 0) {
      return -c(1) / 2;
    }
    return duet::select(
        !duet::detail::is_beyond_series(innermost(s)),
        [&] { return S((n * c(n + 2) - c(n + 1)) / 2); },
        [&] { return S((c(n - 1) - n * y) / (2 * s)); });
  }

private:
  template <class S, int... N>
  [[nodiscard]] S of_constant_order(const S& s, std::integer_sequence<int, N...>) const {
    duet::detail::require(n < max_stumpff, "duet: a formula with the Stumpff function c_", n);
    S result(0);
    static_cast<void>(((n == N ? (result = S(duet::stumpff<N>(s)), true) : false) || ...));
    return result;
  }
};

/// The functions of one number.
template <class S>
[[nodiscard]] S function_value(operation what, int index, const S& x) {
#define DUET_CASE(name)                                                                            \
  case operation::name: {                                                                          \
    using std::name;                                                                               \
    return S(name(x));                                                                             \
  }
  switch (what) {
    DUET_EACH_FUNCTION(DUET_CASE)
    DUET_EACH_ROUNDING(DUET_CASE)
  case operation::power:
    return whole_power{index}.value(x);
  case operation::stumpff:
    return stumpff_of_order{index}.value(x);
  default:
    return S(-x);
  }
#undef DUET_CASE
}

/// The functions of two numbers.
template <class S>
[[nodiscard]] S function_value(operation what, const S& a, const S& b) {
  using std::atan2;
  using std::fmod;
  using std::hypot;
  using std::pow;
  using std::remainder;
  switch (what) {
  case operation::sum:
    return S(a + b);
  case operation::difference:
    return S(a - b);
  case operation::product:
    return S(a * b);
  case operation::quotient:
    return S(a / b);
  case operation::atan2:
    return S(atan2(a, b));
  case operation::hypot:
    return S(hypot(a, b));
  case operation::pow:
    return S(pow(a, b));
  case operation::fmod:
    return S(fmod(a, b));
  case operation::remainder:
    return S(remainder(a, b));
  default:
    return S(duet::arc_ratio(a, b));
  }
}

/// The values of all nodes that are needed, over S: numbers in one list, conditions in another.
template <class S>
class node_values {
public:
  using condition = decltype(std::declval<const S&>() < std::declval<const S&>());

  /// Sets the constants.
  node_values(const graph& g, const std::vector<bool>& needed)
      : numbers_(std::size_t(g.size()), S(0)),
        conditions_(std::size_t(g.size()), condition(false)) {
    for (int i = 0; i < g.size(); ++i) {
      if (needed[std::size_t(i)] && g.is_number(i)) {
        numbers_[std::size_t(i)] = S(g[i].number);
      } else if (needed[std::size_t(i)]) {
        steps_.push_back(i);
      }
    }
  }
  node_values(const graph& g, const std::vector<bool>& needed, const std::vector<S>& inputs)
      : node_values(g, needed) {
    evaluate(g, inputs);
  }

  /// Evaluates all other nodes.
  void evaluate(const graph& g, const std::vector<S>& inputs) {
    for (const int i : steps_) {
      evaluate(g[i], std::size_t(i), inputs);
    }
  }

  [[nodiscard]] const S& operator[](int node) const { return numbers_[std::size_t(node)]; }

private:
  [[nodiscard]] const S& number(int node) const { return numbers_[std::size_t(node)]; }
  [[nodiscard]] condition holds(int node) const { return conditions_[std::size_t(node)]; }

  void evaluate(const graph_node& n, std::size_t i, const std::vector<S>& inputs) {
    const auto [a, b, c] = n.operands;
    switch (n.what) { // frequent operations first
    case operation::variable:
      numbers_[i] = inputs[std::size_t(n.index)];
      return;
    case operation::sum:
      numbers_[i] = S(number(a) + number(b));
      return;
    case operation::difference:
      numbers_[i] = S(number(a) - number(b));
      return;
    case operation::product:
      numbers_[i] = S(number(a) * number(b));
      return;
    case operation::quotient:
      numbers_[i] = S(number(a) / number(b));
      return;
    case operation::negative:
      numbers_[i] = S(-number(a));
      return;
    case operation::fma: {
      using std::fma;
      numbers_[i] = S(fma(number(a), number(b), number(c)));
      return;
    }
    case operation::select: {
      const S& if_true = number(b);
      const S& if_false = number(c);
      numbers_[i] = duet_select(
          holds(a), [&] { return if_true; }, [&] { return if_false; });
      return;
    }
    default:
      break;
    }
    if (is_condition(n.what)) {
      conditions_[i] = condition_value(n);
    } else if (operand_count(n.what) == 2) {
      numbers_[i] = function_value<S>(n.what, number(a), number(b));
    } else {
      numbers_[i] = function_value<S>(n.what, n.index, number(a));
    }
  }
  template <class F, class G>
  [[nodiscard]] static S duet_select(const condition& holds, const F& f, const G& g) {
    using duet::select;
    return select(holds, f, g);
  }
  [[nodiscard]] condition condition_value(const graph_node& n) const {
    using std::isfinite;
    using std::isnan;
    using std::signbit;
    const auto [a, b, c] = n.operands;
    switch (n.what) {
    case operation::less:
      return number(a) < number(b);
    case operation::less_equal:
      return number(a) <= number(b);
    case operation::equal:
      return number(a) == number(b);
    case operation::is_finite:
      return condition(isfinite(number(a)));
    case operation::is_nan:
      return condition(isnan(number(a)));
    case operation::is_negative:
      return condition(signbit(number(a)));
    case operation::both:
      return holds(a) && holds(b);
    case operation::either:
      return holds(a) || holds(b);
    default:
      return !holds(a);
    }
  }

  std::vector<S> numbers_;
  std::vector<condition> conditions_;
  std::vector<int> steps_; ///< nodes that are no constants, in order
};

/// The values of the nodes that the outputs of a formula need.
/// \throws invalid_input over dual numbers, for a function of `with_derivative`
template <class S>
[[nodiscard]] node_values<S> values_for_outputs(const formula_graph& f) {
  const std::vector<bool> needed = f.needed();
  for (std::size_t i = 0; Infinitesimal<S> && i < needed.size(); ++i) {
    if (needed[i]) {
      f.operations().require_own_derivative(int(i));
    }
  }
  return node_values<S>(f.operations(), needed);
}

/// Evaluates the nodes, and gives the numbers of the outputs, one after the other.
/// \throws invalid_input for another number of inputs
template <class S>
void evaluate_outputs(const formula_graph& f, node_values<S>& values, const std::vector<S>& inputs,
                      std::vector<S>& outputs) {
  duet::detail::require(int(inputs.size()) == f.input_size(), "duet: evaluate: the formula has ",
                        f.input_size(), " input numbers, not ", inputs.size());
  values.evaluate(f.operations(), inputs);
  outputs.clear();
  for (const named_value& y : f.outputs()) {
    for (const int node : y.nodes) {
      outputs.push_back(values[node]);
    }
  }
}

} // namespace duet::expression::detail

namespace duet::expression {

/// The numbers of the outputs of a formula, one after the other, over any scalar S.
/// \param inputs  the numbers of the inputs, likewise
/// \throws invalid_input for another number of inputs; over dual numbers, for a function of
/// `with_derivative`, whose derivative is not recorded
template <class S>
[[nodiscard]] std::vector<S> evaluate(const formula_graph& f, const std::vector<S>& inputs) {
  auto values = detail::values_for_outputs<S>(f);
  std::vector<S> outputs;
  detail::evaluate_outputs(f, values, inputs, outputs);
  return outputs;
}

/// A formula prepared for many evaluations over a scalar S: a list of the operations that its
/// outputs need, with memory for their values. Each thread needs its own.
template <class S>
class evaluator {
public:
  /// \throws invalid_input over dual numbers, for a function of `with_derivative`
  explicit evaluator(formula_graph f)
      : f_(std::move(f)), values_(detail::values_for_outputs<S>(f_)) {}

  /// The numbers of the outputs, as by `evaluate`; valid until the next call.
  /// \throws invalid_input for another number of inputs
  const std::vector<S>& operator()(const std::vector<S>& inputs) {
    detail::evaluate_outputs(f_, values_, inputs, outputs_);
    return outputs_;
  }

private:
  formula_graph f_;
  detail::node_values<S> values_;
  std::vector<S> outputs_;
};

} // namespace duet::expression
