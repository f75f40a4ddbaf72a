// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/graph/evaluate.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/graph.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

/// \file
/// Values of formulas that are data, with bounds of their round-off.

namespace duet::expression::detail {

/// The values of a formula over a floating-point number S, also a long one, with bounds of their
/// round-off, by running error analysis: each operation is repeated with operands that are off by
/// their bounds. So complete cancellation, as in cosh(x)² − sinh(x)² of a large x, is not taken for
/// a value. Zeros have no sign, as in mathematics: atan2(0, −1) is π.
template <class S>
class bounded_values {
public:
  /// \param round_off  bound of the relative error of an operation, some units of the last place:
  /// less could get lost in the operand
  bounded_values(const formula_graph& f, const std::vector<S>& inputs, const S& round_off)
      : g_(f.operations()), round_off_(round_off), x_(std::size_t(g_.size())), error_(x_.size()),
        holds_(x_.size()) {
    const std::vector<bool> needed = f.needed();
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const graph_node& n = g_[int(i)];
      if (!needed[i]) {
        continue;
      }
      if (n.what == operation::number) {
        x_[i] = n.number;
      } else if (n.what == operation::variable) {
        x_[i] = inputs[std::size_t(n.index)];
      } else if (is_condition(n.what)) {
        compare(n, i);
      } else {
        compute(n, i);
      }
    }
  }
  [[nodiscard]] const S& value(int node) const { return x_[std::size_t(node)]; }
  [[nodiscard]] const S& error(int node) const { return error_[std::size_t(node)]; }

private:
  void compare(const graph_node& n, std::size_t i) {
    using std::abs;
    using std::isfinite;
    using std::isnan;
    using std::signbit;
    const std::size_t a = std::size_t(n.operands[0]);
    const std::size_t b = std::size_t(std::max(n.operands[1], 0));
    switch (n.what) {
    case operation::less:
    case operation::less_equal:
    case operation::equal: {
      holds_[i] = n.what == operation::less         ? x_[a] < x_[b]
                  : n.what == operation::less_equal ? x_[a] <= x_[b]
                                                    : x_[a] == x_[b];
      const S gap = abs(S(x_[a] - x_[b]));
      error_[i] = gap <= error_[a] + error_[b] && error_[a] + error_[b] > 0 ? infinity() : S(0);
      return;
    }
    case operation::is_finite:
      holds_[i] = isfinite(x_[a]);
      return;
    case operation::is_nan:
      holds_[i] = isnan(x_[a]);
      return;
    case operation::is_negative:
      holds_[i] = signbit(x_[a]);
      return;
    case operation::no:
      holds_[i] = !holds_[a];
      error_[i] = error_[a];
      return;
    default:
      holds_[i] = n.what == operation::both ? holds_[a] && holds_[b] : holds_[a] || holds_[b];
      error_[i] = error_[a] + error_[b];
    }
  }
  void compute(const graph_node& n, std::size_t i) {
    using std::abs;
    using std::isnan;
    const auto operand = [&](int k) { return std::size_t(n.operands[std::size_t(k)]); };
    if (n.what == operation::select) {
      const std::size_t chosen = operand(holds_[operand(0)] ? 1 : 2);
      x_[i] = x_[chosen];
      error_[i] = error_[chosen] + error_[operand(0)];
      return;
    }
    std::array<S, 3> x;
    const int count = operand_count(n.what);
    for (int k = 0; k < count; ++k) {
      x[std::size_t(k)] = x_[operand(k)];
    }
    const auto value = [&] {
      const S y = n.what == operation::fma ? S(x[0] * x[1] + x[2])
                  : count == 2             ? function_value<S>(n.what, x[0], x[1])
                                           : function_value<S>(n.what, n.index, x[0]);
      return y == 0 ? S(0) : y;
    };
    x_[i] = value();
    const bool is_exact =
        n.what == operation::negative || (n.what >= operation::abs && n.what <= operation::round);
    error_[i] = is_exact ? S(0) : S(abs(x_[i]) * round_off_);
    for (int k = 0; k < count; ++k) {
      const S& error = error_[operand(k)];
      if (error > 0) {
        S largest(0);
        for (int step = 1; step <= (may_oscillate(n.what) ? 8 : 1); ++step) {
          x[std::size_t(k)] = x_[operand(k)] + error / step;
          const S change = abs(S(value() - x_[i]));
          largest = isnan(change) ? infinity() : std::max(largest, change);
        }
        error_[i] += largest;
        x[std::size_t(k)] = x_[operand(k)];
      }
    }
  }
  /// True for functions whose value may change little over many periods.
  [[nodiscard]] static bool may_oscillate(operation what) {
    return what == operation::sin || what == operation::cos || what == operation::tan ||
           what == operation::stumpff;
  }
  [[nodiscard]] static S infinity() { return std::numeric_limits<S>::infinity(); }

  const graph& g_;
  S round_off_;
  std::vector<S> x_, error_;
  std::vector<bool> holds_;
};

} // namespace duet::expression::detail
