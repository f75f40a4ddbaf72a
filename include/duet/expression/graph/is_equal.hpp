// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>
#include <duet/expression/graph/algebra.hpp>
#include <duet/expression/graph/bounded_values.hpp>
#include <duet/expression/graph/canonical_form.hpp>
#include <duet/expression/graph/formula_graph.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Proofs that two formulas are equal.

namespace duet::expression {

/// Verdict on the equality of two formulas.
enum class equality {
  proved,  ///< equal by algebra, and with values at the same inputs
  refuted, ///< unequal at an input
  unknown  ///< neither was found
};

/// Verdict on the equality of two formulas, with the input that refutes it.
struct equality_result {
  equality verdict = equality::unknown; ///< the verdict
  std::vector<double> witness = {};     ///< of a refuted equality the numbers of the inputs
  double first = 0, second = 0;         ///< of a refuted equality the values that differ there

  /// True for a proof alone.
  [[nodiscard]] explicit operator bool() const { return verdict == equality::proved; }
};

namespace detail {

/// The numbers of an input at which unit norms are kept.
inline void add_sample(const named_value& x, const assumptions& known, random_source& random,
                       int round, std::vector<double>& inputs) {
  const auto contains = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), x.name) != names.end();
  };
  const std::size_t begin = inputs.size();
  const double scale = round % 3 == 0 ? 0.3 : round % 3 == 1 ? 1 : 4;
  double square = 0;
  for (int k = 0; k < x.rows * x.columns; ++k) {
    const double number = random.uniform(-scale, scale);
    inputs.push_back(contains(known.positive) ? std::abs(number) : number);
    square += x.kind == shape::pose && k >= 4 ? 0 : number * number;
  }
  if (contains(known.unit)) {
    for (std::size_t k = begin; k < inputs.size(); ++k) {
      inputs[k] /= std::sqrt(square);
    }
    if (x.kind == shape::pose) {
      double along = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        along += inputs[begin + k] * inputs[begin + 4 + k];
      }
      for (std::size_t k = 0; k < 4; ++k) {
        inputs[begin + 4 + k] -= along * inputs[begin + k];
      }
    }
  }
}

/// True if the outputs of two formulas are the same nodes of the same operations.
[[nodiscard]] inline bool have_same_nodes(const formula_graph& f, const formula_graph& g) {
  const auto same_nodes = [](const named_value& x, const named_value& y) {
    return x.nodes == y.nodes;
  };
  const graph &a = f.operations(), &b = g.operations();
  bool result = a.size() == b.size() &&
                std::equal(f.outputs().begin(), f.outputs().end(), g.outputs().begin(), same_nodes);
  for (int i = 0; result && i < a.size(); ++i) {
    result = a[i] == b[i];
  }
  return result;
}

} // namespace detail

/// Tells whether two formulas of the same inputs are equal: proved by algebra, refuted by an input,
/// or unknown. A proof covers the domain: x/x = 1 is not proved, unless x is assumed not to be 0,
/// nor is √(x²) = x. The algebra knows sums, products and quotients, powers and roots, multiples
/// and sums of angles, exponentials, hyperbolic functions and Stumpff functions, with exact
/// arithmetic of the numbers of both formulas; other functions are equal if their arguments are.
///
/// \throws invalid_input if the formulas have other inputs, or outputs of other sizes
[[nodiscard]] inline equality_result is_equal(const formula_graph& f, const formula_graph& g,
                                              const assumptions& known = {}) {
  const auto have_equal_size = [](const named_value& x, const named_value& y) {
    return x.nodes.size() == y.nodes.size();
  };
  duet::detail::require(f.inputs().size() == g.inputs().size() &&
                            f.input_size() == g.input_size() &&
                            std::equal(f.outputs().begin(), f.outputs().end(), g.outputs().begin(),
                                       g.outputs().end(), have_equal_size),
                        "duet: is_equal: the formulas have other inputs or outputs");
  // The numbers of g's inputs in the order of f's.
  std::vector<std::size_t> indices;
  for (const named_value& x : g.inputs()) {
    const named_value& same = f.input(x.name);
    duet::detail::require(same.nodes.size() == x.nodes.size(), "duet: is_equal: the input '",
                          x.name, "' has other sizes");
    for (const int node : same.nodes) {
      indices.push_back(std::size_t(f.operations()[node].index));
    }
  }
  equality_result result;
  if (std::is_sorted(indices.begin(), indices.end()) && detail::have_same_nodes(f, g)) {
    result.verdict = equality::proved;
    return result;
  }
  duet::random_source random(1);
  for (int round = 0; round < 24; ++round) {
    std::vector<double> inputs, inputs_of_g;
    for (const named_value& x : f.inputs()) {
      detail::add_sample(x, known, random, round, inputs);
    }
    for (const std::size_t k : indices) {
      inputs_of_g.push_back(inputs[k]);
    }
    const detail::bounded_values<double> a(f, inputs, 0x1p-50), b(g, inputs_of_g, 0x1p-50);
    for (std::size_t k = 0; k < f.outputs().size(); ++k) {
      for (std::size_t i = 0; i < f.outputs()[k].nodes.size(); ++i) {
        const int m = f.outputs()[k].nodes[i], n = g.outputs()[k].nodes[i];
        const double x = a.value(m), y = b.value(n), size = std::max(std::abs(x), std::abs(y)),
                     error = 10 * (a.error(m) + b.error(n));
        if (std::isfinite(size) && size < 1e6 && std::abs(x - y) > 1e-6 * (1 + size) + error) {
          return {equality::refuted, inputs, x, y};
        }
      }
    }
  }
  std::map<std::string, detail::rational> bases;
  std::map<std::string, int> stumpff;
  for (int round = 0; round < 12; ++round) {
    detail::canonical_form form(known, bases, stumpff);
    const auto a = form.values_of(f), b = form.values_of(g);
    if (form.must_repeat() && !form.field().ring.is_too_large()) {
      continue;
    }
    bool is_proved = !form.must_repeat() && !form.field().ring.is_too_large();
    for (std::size_t k = 0; k < f.outputs().size() && is_proved; ++k) {
      const std::vector<int>&of_f = f.outputs()[k].nodes, &of_g = g.outputs()[k].nodes;
      for (std::size_t i = 0; i < of_f.size() && is_proved; ++i) {
        const auto &x = a[std::size_t(of_f[i])], &y = b[std::size_t(of_g[i])];
        is_proved = form.are_equal(x.number, y.number) &&
                    (known.where_both_have_values || form.have_equal_domains(x, y));
      }
    }
    is_proved = is_proved && !form.field().ring.is_too_large();
    result.verdict = is_proved ? equality::proved : equality::unknown;
    return result;
  }
  return result;
}

} // namespace duet::expression
