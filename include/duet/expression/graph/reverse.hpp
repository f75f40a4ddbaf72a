// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/dual/rules/of_many.hpp>
#include <duet/dual/stumpff.hpp>
#include <duet/expression/graph/evaluate.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/functions_of_one.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/recorded.hpp>

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Reverse accumulation: the derivatives of one output with respect to all variables in one sweep
/// from the output to the inputs, by the rules of dual numbers.

namespace duet::expression::detail {

/// ∂y/∂x of the functions of one number.
[[nodiscard]] inline recorded slope_of(operation what, int index, const recorded& x,
                                       const recorded& y) {
#define DUET_CASE(name)                                                                            \
  case operation::name:                                                                            \
    return duet::rule::name{}.slope(x, y);
  switch (what) {
    DUET_EACH_FUNCTION_WITH_SLOPE(DUET_CASE)
#undef DUET_CASE
  case operation::sin:
    return cos(x);
  case operation::cos:
    return -sin(x);
  case operation::sinh:
    return cosh(x);
  case operation::cosh:
    return sinh(x);
  case operation::abs:
    return select(
        signbit(x), [] { return recorded(-1); }, [] { return recorded(1); });
  case operation::power:
    return recorded(index) * pow(x, recorded(index - 1));
  case operation::stumpff:
    return stumpff_of_order{index}.slope(x, y);
  case operation::tgamma:
  case operation::lgamma:
    duet::detail::raise(invalid_input("duet: the derivative of a gamma function has no formula"));
  default: // floor, ceil, trunc and round are constant by pieces
    return recorded(0);
  }
}

/// The partial derivatives of y = f(a, b).
[[nodiscard]] inline std::array<recorded, 2> slopes_of(operation what, const recorded& a,
                                                       const recorded& b, const recorded& y) {
  switch (what) {
  case operation::atan2:
    return duet::rule::atan2{}.slopes(y, a, b);
  case operation::hypot:
    return duet::rule::hypot{}.slopes(y, a, b);
  case operation::pow:
    return {duet::rule::power<recorded>{b}.slope(a, y),
            duet::rule::exponential<recorded>{a}.slope(b, y)};
  case operation::fmod:
    return duet::rule::fmod{}.slopes(y, a, b);
  case operation::remainder:
    return duet::rule::remainder{}.slopes(y, a, b);
  default:
    return duet::rule::arc_ratio{}.slopes(y, a, b);
  }
}

/// Adjoints: the derivatives of a node with respect to the nodes before it, recorded in its graph.
/// Within a branch of a choice they are those of the chosen branch, and masked where they leave it:
/// infinite slopes of a branch that is not chosen do no harm.
class adjoints {
public:
  /// Computes them for the node `root`, in one sweep over the nodes before it.
  adjoints(graph& g, int root) : g_(g), values_(std::size_t(root) + 1) {
    values_[std::size_t(root)].sum = recorded(1);
    for (int i = root; i >= 0; --i) {
      const auto& [sum, branch, is_known] = values_[std::size_t(i)];
      if (!(sum.is_constant() && sum.number() == 0)) {
        g_.require_own_derivative(i);
        branch_ = branch;
        propagate(g_[i], i, sum);
      }
    }
  }

  /// With respect to a node.
  [[nodiscard]] recorded operator[](int node) const {
    if (std::size_t(node) >= values_.size()) {
      return recorded(0);
    }
    const entry& x = values_[std::size_t(node)];
    return masked(x.sum, x.branch, 0);
  }

private:
  struct entry {
    recorded sum = recorded(0);
    std::vector<int> branch = {}; ///< nodes of conditions under which it is meant; else it is 0
    bool is_known = false;
  };

  [[nodiscard]] recorded at(int node) { return {g_, node}; }
  /// x where all conditions from the `first` on hold, otherwise 0.
  [[nodiscard]] recorded masked(recorded x, const std::vector<int>& branch,
                                std::size_t first) const {
    for (std::size_t k = branch.size(); k > first; --k) {
      x = blended(recorded_condition(g_, branch[k - 1]), x, recorded(0));
    }
    return x;
  }
  void add(int node, const recorded& x) {
    auto& [sum, branch, is_known] = values_[std::size_t(node)];
    if (!is_known) {
      sum = x;
      branch = branch_;
      is_known = true;
      return;
    }
    std::size_t common = 0;
    while (common < branch.size() && common < branch_.size() && branch[common] == branch_[common]) {
      ++common;
    }
    if (branch.size() == common + 1 && branch_.size() == common + 1 &&
        g_.apply(operation::no, branch.back()) == branch_.back()) {
      sum = blended(recorded_condition(g_, branch.back()), sum, x); // of both branches
    } else {
      sum = masked(sum, branch, common) + masked(x, branch_, common);
    }
    branch.resize(common);
  }
  void propagate(const graph_node n, int i, const recorded adjoint) {
    const int a = n.operands[0], b = n.operands[1], c = n.operands[2];
    switch (n.what) {
    case operation::number:
    case operation::variable:
      return;
    case operation::negative:
      return add(a, -adjoint);
    case operation::sum:
      add(a, adjoint);
      return add(b, adjoint);
    case operation::difference:
      add(a, adjoint);
      return add(b, -adjoint);
    case operation::product:
      if (a == b) {
        return add(a, 2 * (adjoint * at(a)));
      }
      add_unless_number(a, [&] { return adjoint * at(b); });
      return add_unless_number(b, [&] { return adjoint * at(a); });
    case operation::quotient: {
      const recorded share = adjoint / at(b);
      add_unless_number(a, [&] { return share; });
      return add_unless_number(b, [&] { return -(share * at(i)); });
    }
    case operation::fma:
      add_unless_number(a, [&] { return adjoint * at(b); });
      add_unless_number(b, [&] { return adjoint * at(a); });
      return add_unless_number(c, [&] { return adjoint; });
    case operation::select: {
      branch_.push_back(a);
      add_unless_number(b, [&] { return adjoint; });
      branch_.back() = g_.apply(operation::no, a);
      return add_unless_number(c, [&] { return adjoint; });
    }
    default:
      break;
    }
    if (is_condition(n.what)) {
      return;
    }
    if (operand_count(n.what) == 1) {
      return add(a, adjoint * slope_of(n.what, n.index, at(a), at(i)));
    }
    const std::array<recorded, 2> slopes = slopes_of(n.what, at(a), at(b), at(i));
    add_unless_number(a, [&] { return adjoint * slopes[0]; });
    add_unless_number(b, [&] { return adjoint * slopes[1]; });
  }
  template <class F>
  void add_unless_number(int node, const F& f) {
    if (!g_.is_number(node)) {
      add(node, f());
    }
  }

  graph& g_;
  std::vector<entry> values_;
  std::vector<int> branch_; ///< that of the node whose adjoint is propagated
};

/// A column of Eigen of floating-point numbers.
template <class X>
concept RealColumn = std::derived_from<X, Eigen::MatrixBase<X>> &&
                     std::floating_point<typename X::Scalar> && X::ColsAtCompileTime == 1;

} // namespace duet::expression::detail

namespace duet::expression {

/// The formula with, for its only scalar output, the outputs `value` and `gradient`, by reverse
/// accumulation: at most a few times the operations of the value, however many variables there are.
/// The gradient has the derivatives with respect to the numbers of the named inputs, in their
/// order; rotations and poses are taken by their numbers. Where a slope is infinite, as of √ at 0,
/// the gradient is NaN, also where dual numbers keep a derivative that is zero.
///
/// \throws invalid_input unless the formula has one scalar output, and for an unknown name
[[nodiscard]] inline formula_graph reverse_gradient(formula_graph f,
                                                    const std::vector<std::string>& names) {
  const std::vector<named_value> outputs = f.take_outputs();
  duet::detail::require(outputs.size() == 1 && outputs[0].nodes.size() == 1,
                        "duet: reverse_gradient takes a formula with one scalar output");
  const detail::adjoints by(f.operations(), outputs[0].nodes[0]);
  named_value gradient{.name = "gradient", .kind = shape::matrix, .rows = 0};
  for (const std::string& name : names) {
    for (const int node : f.input(name).nodes) {
      gradient.nodes.push_back(by[node].node_in(f.operations()));
    }
  }
  gradient.rows = int(gradient.nodes.size());
  f.add_output({.name = "value", .nodes = outputs[0].nodes});
  f.add_output(std::move(gradient));
  return f;
}

/// The formula with the outputs `value`, `gradient` and `hessian`, symmetric, of its only scalar
/// output: forward over reverse accumulation, by dual numbers through the gradient.
///
/// \throws invalid_input as `reverse_gradient`
[[nodiscard]] inline formula_graph reverse_hessian(const formula_graph& f,
                                                   const std::vector<std::string>& names) {
  using moving = dual<recorded>;
  const formula_graph gradient = reverse_gradient(f, names);
  const std::vector<bool> needed = gradient.needed();
  formula_graph result;
  std::vector<moving> inputs;
  for (const named_value& x : f.inputs()) {
    for (const int node : result.add_input(x).nodes) {
      inputs.emplace_back(recorded(result.operations(), node));
    }
  }
  const std::vector<int>& slopes = gradient.outputs()[1].nodes;
  const int n = int(slopes.size());
  named_value hessian{.name = "hessian", .kind = shape::matrix, .rows = n, .columns = n};
  hessian.nodes.resize(std::size_t(n) * std::size_t(n));
  const auto node = [&](const recorded& x) { return x.node_in(result.operations()); };
  int column = 0;
  for (const std::string& name : names) {
    for (const int variable : f.input(name).nodes) {
      moving& x = inputs[std::size_t(f.operations()[variable].index)];
      x = moving(x.value(), recorded(1));
      const detail::node_values<moving> values(gradient.operations(), needed, inputs);
      x = moving(x.value());
      if (column == 0) {
        named_value value{.name = "value"};
        value.nodes.push_back(node(values[gradient.outputs()[0].nodes[0]].value()));
        named_value first{.name = "gradient", .kind = shape::matrix, .rows = n};
        for (const int slope : slopes) {
          first.nodes.push_back(node(values[slope].value()));
        }
        result.add_output(std::move(value));
        result.add_output(std::move(first));
      }
      for (int row = column; row < n; ++row) {
        const int second = node(values[slopes[std::size_t(row)]].epsilon());
        hessian.nodes[std::size_t(row + column * n)] = second;
        hessian.nodes[std::size_t(column + row * n)] = second;
      }
      ++column;
    }
  }
  result.add_output(std::move(hessian));
  return result;
}

/// The value and the gradient of a function that is generic over scalars, at a column x, by reverse
/// accumulation. Each call traces the function, which takes far longer than its evaluation: for
/// many calls make an `evaluator` of `reverse_gradient(trace(f, n), {"x"})`.
///
/// \return `value_and_gradient`
/// \throws invalid_input where the function branches on a value
template <class F, detail::RealColumn X>
[[nodiscard]] auto reverse_gradient(F&& f, const X& x) {
  using column = Eigen::Matrix<recorded, X::RowsAtCompileTime, 1>;
  using S = typename X::Scalar;
  formula_graph g;
  const recorded y = f(detail::add_column<column>(g, x.size()));
  g.add_output({.name = "y", .nodes = {y.node_in(g.operations())}});
  const std::vector<S> values =
      evaluate(reverse_gradient(std::move(g), {"x"}), std::vector<S>(x.begin(), x.end()));
  value_and_gradient<S, Eigen::Matrix<S, X::RowsAtCompileTime, 1>> result;
  result.value = values[0];
  result.gradient =
      Eigen::Map<const Eigen::Matrix<S, X::RowsAtCompileTime, 1>>(values.data() + 1, x.size());
  return result;
}

} // namespace duet::expression
