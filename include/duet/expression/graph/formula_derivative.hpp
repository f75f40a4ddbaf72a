// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/tree/number.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Derivatives of formulas that are data, as formulas that one reads: by the rules of textbooks,
/// without rounded constants. For gradients that are computed, `reverse_gradient` takes fewer
/// operations.

namespace duet::expression {

namespace detail {

/// The derivatives of nodes with respect to one variable, recorded in their graph.
class node_derivatives {
public:
  /// \param variable  the node of the variable
  /// \param given  known derivatives: their nodes, by the nodes that they are of
  node_derivatives(graph& g, const std::vector<bool>& needed, int variable,
                   const std::map<int, int>& given = {})
      : g_(g), rates_(needed.size(), zero) {
    rates_[std::size_t(variable)] = constant(1);
    for (std::size_t i = 0; i < needed.size(); ++i) {
      if (const auto known = given.find(int(i)); known != given.end()) {
        rates_[i] = known->second;
      } else if (needed[i] && int(i) != variable) {
        rates_[i] = rate(g_[int(i)], int(i));
        if (rates_[i] != zero) {
          g_.require_own_derivative(int(i));
        }
      }
    }
  }

  /// The node of a derivative.
  [[nodiscard]] int operator[](int node) {
    const int rate = rates_[std::size_t(node)];
    return rate == zero ? constant(0) : rate;
  }

private:
  static constexpr int zero = -1; ///< the derivative of what does not depend on the variable

  [[nodiscard]] int constant(double x) { return g_.number(x); }
  [[nodiscard]] int of(operation what, int a, int b = -1, int c = -1) {
    return g_.apply(what, a, b, c);
  }
  [[nodiscard]] int negated(int a) { return a == zero ? zero : of(operation::negative, a); }
  [[nodiscard]] int sum_of(int a, int b) {
    return a == zero ? b : b == zero ? a : collected(operation::sum, a, b);
  }
  [[nodiscard]] int difference_of(int a, int b) {
    return a == zero ? negated(b) : b == zero ? a : collected(operation::difference, a, b);
  }
  /// factor · node, or the factor alone for node −1.
  struct linear_term {
    double factor; ///< 1 or −1, or the number of a product
    int node;
  };
  /// Adds the terms of a node with a sign, of long sums those at the end.
  void add_terms(int node, double factor, std::vector<linear_term>& terms, int depth = 16) const {
    using enum operation;
    constexpr std::size_t max_terms = 32;
    const graph_node& n = g_[node];
    if (depth == 0 || terms.size() >= max_terms) {
      terms.push_back({factor, node});
    } else if (n.what == sum || n.what == difference) {
      add_terms(n.operands[0], factor, terms, depth - 1);
      add_terms(n.operands[1], n.what == sum ? factor : -factor, terms, depth - 1);
    } else if (n.what == operation::negative) {
      add_terms(n.operands[0], -factor, terms, depth - 1);
    } else if (n.what == number) {
      terms.push_back({factor * n.number, -1});
    } else if (n.what == operation::product && g_.is_number(n.operands[0])) {
      terms.push_back({factor * g_[n.operands[0]].number, n.operands[1]});
    } else {
      terms.push_back({factor, node});
    }
  }
  /// a ± b, in which terms of a that occur in b have the sum of both factors: 2 − 2u of 2 − u − u.
  [[nodiscard]] int collected(operation what, int a, int b) {
    std::vector<linear_term> terms, added;
    add_terms(a, 1, terms);
    add_terms(b, what == operation::sum ? 1 : -1, added);
    bool is_simpler = false;
    for (const linear_term& t : added) {
      const auto same = std::find_if(terms.begin(), terms.end(), [&](const linear_term& u) {
        return u.node == t.node && is_sum_exact(u.factor, t.factor);
      });
      if (same == terms.end()) {
        terms.push_back(t);
      } else {
        same->factor += t.factor;
        is_simpler = true;
      }
    }
    if (!is_simpler) {
      return of(what, a, b);
    }
    int result = zero;
    for (const linear_term& t : terms) {
      const int size = constant(std::abs(t.factor));
      const int term = t.node < 0 ? size : of(operation::product, size, t.node);
      const bool is_negative = t.factor < 0;
      if (t.factor != 0) {
        result = result == zero
                     ? (is_negative ? negated(term) : term)
                     : of(is_negative ? operation::difference : operation::sum, result, term);
      }
    }
    return result;
  }
  [[nodiscard]] int product_of(int a, int b) {
    return a == zero || b == zero ? zero : of(operation::product, a, b);
  }
  [[nodiscard]] int quotient_of(int a, int b) {
    return a == zero ? zero : of(operation::quotient, a, b);
  }
  [[nodiscard]] int power_of(int a, int n) {
    return n == 0 ? constant(1) : n == 1 ? a : g_.apply(operation::power, a, -1, -1, n);
  }
  [[nodiscard]] int square(int a) { return power_of(a, 2); }

  [[nodiscard]] int rate(const graph_node n, int y) {
    using enum operation;
    const auto rate_of = [&](int k) {
      const int operand = n.operands[std::size_t(k)];
      return operand < 0 ? zero : rates_[std::size_t(operand)];
    };
    const int a = n.operands[0], b = n.operands[1];
    const int da = rate_of(0), db = rate_of(1), dc = rate_of(2);
    if (is_condition(n.what) || (da == zero && db == zero && dc == zero)) {
      return zero;
    }
    switch (n.what) {
    case operation::negative:
      return negated(da);
    case operation::sum:
      return sum_of(da, db);
    case operation::difference:
      return difference_of(da, db);
    case operation::product:
      return a == b ? product_of(product_of(constant(2), a), da)
                    : sum_of(product_of(da, b), product_of(a, db));
    case operation::quotient:
      return db == zero
                 ? quotient_of(da, b)
                 : quotient_of(difference_of(product_of(da, b), product_of(a, db)), square(b));
    case fma:
      return sum_of(sum_of(product_of(da, b), product_of(a, db)), dc);
    case select:
      return of(select, a, db == zero ? constant(0) : db, dc == zero ? constant(0) : dc);
    case pow:
      return rate_of_pow(a, b, da, db, y);
    case atan2:
      return quotient_of(difference_of(product_of(da, b), product_of(a, db)),
                         sum_of(square(a), square(b)));
    case hypot:
      return quotient_of(sum_of(product_of(a, da), product_of(b, db)), y);
    case fmod:
    case remainder:
      return difference_of(
          da, product_of(of(n.what == fmod ? trunc : round, of(operation::quotient, a, b)), db));
    case arc_ratio: {
      const int of_s = quotient_of(difference_of(quotient_of(b, sum_of(a, square(b))), y),
                                   product_of(constant(2), a));
      return difference_of(product_of(of_s, da), quotient_of(db, sum_of(a, square(b))));
    }
    default:
      return rate_of_function(n, a, da, y);
    }
  }
  [[nodiscard]] int rate_of_pow(int x, int p, int dx, int dp, int y) {
    const int of_x = product_of(
        product_of(p, of(operation::pow, x, of(operation::difference, p, constant(1)))), dx);
    return sum_of(of_x, product_of(product_of(y, of(operation::log, x)), dp));
  }
  /// The derivative of y = f(x) for a function of one number.
  [[nodiscard]] int rate_of_function(const graph_node& n, int x, int dx, int y) {
    using enum operation;
    switch (n.what) {
    case operation::power:
      return product_of(product_of(constant(n.index), power_of(x, n.index - 1)), dx);
    case sqrt:
      return g_.is(dx, operation::product) && g_.is_number(g_[dx].operands[0], 2)
                 ? quotient_of(g_[dx].operands[1], y)
                 : quotient_of(dx, product_of(constant(2), y));
    case cbrt:
      return quotient_of(dx, product_of(constant(3), square(y)));
    case exp:
      return product_of(y, dx);
    case exp2:
      return product_of(product_of(of(log, constant(2)), y), dx);
    case expm1:
      return product_of(of(exp, x), dx);
    case log:
      return quotient_of(dx, x);
    case log2:
    case log10:
      return quotient_of(dx, product_of(of(log, constant(n.what == log2 ? 2 : 10)), x));
    case log1p:
      return quotient_of(dx, sum_of(constant(1), x));
    case sin:
      return product_of(of(cos, x), dx);
    case cos:
      return negated(product_of(of(sin, x), dx));
    case tan:
      return product_of(sum_of(constant(1), square(y)), dx);
    case asin:
      return quotient_of(dx, of(sqrt, difference_of(constant(1), square(x))));
    case acos:
      return negated(quotient_of(dx, of(sqrt, difference_of(constant(1), square(x)))));
    case atan:
      return quotient_of(dx, sum_of(constant(1), square(x)));
    case sinh:
      return product_of(of(cosh, x), dx);
    case cosh:
      return product_of(of(sinh, x), dx);
    case tanh:
      return quotient_of(dx, square(of(cosh, x))); // 1 − y² would cancel
    case asinh:
      return quotient_of(dx, of(sqrt, sum_of(square(x), constant(1))));
    case acosh:
      return quotient_of(dx, of(sqrt, difference_of(square(x), constant(1))));
    case atanh:
      return quotient_of(dx, difference_of(constant(1), square(x)));
    case erf:
    case erfc: {
      const int bell = of(exp, negated(square(x)));
      const int slope =
          quotient_of(product_of(constant(2), bell), of(sqrt, of(acos, constant(-1))));
      return n.what == erf ? product_of(slope, dx) : negated(product_of(slope, dx));
    }
    case abs:
      return product_of(quotient_of(x, y), dx);
    case stumpff: {
      const auto c = [&](int index) { return g_.apply(stumpff, x, -1, -1, index); };
      const int first = n.index == 0 ? zero : product_of(constant(n.index), c(n.index + 2));
      return product_of(quotient_of(difference_of(first, c(n.index + 1)), constant(2)), dx);
    }
    case tgamma:
    case lgamma:
      duet::detail::raise(
          invalid_input("duet: derivative: the derivative of a gamma function has no formula"));
    default: // floor, ceil, trunc and round are constant by pieces
      return zero;
    }
  }

  graph& g_;
  std::vector<int> rates_;
};

} // namespace detail

/// The formula with the derivatives of its outputs with respect to a scalar input as its outputs;
/// or, of scalar outputs, with their gradients with respect to the numbers of a vector or rotation.
/// \throws invalid_input for an unknown input, for the gradient of an output that is not a scalar,
/// and for gamma functions
[[nodiscard]] inline formula_graph derivative(formula_graph f, const std::string& input) {
  const std::vector<int> variables = f.input(input).nodes;
  const std::vector<bool> needed = f.needed();
  std::vector<named_value> outputs = f.take_outputs();
  std::vector<named_value> derivatives = outputs;
  for (named_value& y : derivatives) {
    y.nodes.clear();
  }
  for (const int variable : variables) {
    std::vector<bool> until = needed;
    until.resize(std::max(until.size(), std::size_t(variable) + 1), false);
    detail::node_derivatives by(f.operations(), until, variable);
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      duet::detail::require(variables.size() == 1 || outputs[k].nodes.size() == 1,
                            "duet: derivative: the output '", outputs[k].name,
                            "' has several numbers, as the input '", input,
                            "' has (expected a scalar)");
      for (const int node : outputs[k].nodes) {
        derivatives[k].nodes.push_back(by[node]);
      }
    }
  }
  for (named_value& y : derivatives) {
    if (variables.size() > 1) {
      y.kind = f.input(input).kind;
      y.rows = f.input(input).rows;
    }
    f.add_output(std::move(y));
  }
  return f;
}

} // namespace duet::expression
