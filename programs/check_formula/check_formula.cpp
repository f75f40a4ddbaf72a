// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "check_formula.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/expression/graph/bounded_values.hpp>
#include <duet/expression/graph/evaluate.hpp>
#include <duet/expression/graph/formula_derivative.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/formula_latex.hpp>
#include <duet/expression/graph/formula_text.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/is_equal.hpp>
#include <duet/expression/graph/read_formula.hpp>
#include <duet/interop/multiprecision.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace check_formula {
namespace {

using duet::real_50;
using namespace duet::expression;

const real_50 round_off("1e-49");
const real_50 tolerance("1e-30");

// Inputs.

/// Numbers that are special to many formulas.
const std::vector<double> special_numbers{0,
                                          1,
                                          -1,
                                          2,
                                          -2,
                                          0.5,
                                          -0.5,
                                          3,
                                          -3,
                                          10,
                                          -10,
                                          0.1,
                                          -0.1,
                                          100,
                                          -100,
                                          1e-8,
                                          -1e-8,
                                          1e6,
                                          0.9,
                                          -0.9,
                                          1.5,
                                          -1.5,
                                          4,
                                          5,
                                          0.25,
                                          1.5707963267948966,
                                          3.141592653589793};
const std::vector<std::array<double, 4>> special_rotations{
    {1, 0, 0, 0},  {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1},   {1, 1, 0, 0},  {1, 0, 1, 0},
    {1, 0, 0, 1},  {1, 1, 1, 1}, {2, 1, 0, 0}, {-1, 0, 0, 0},  {-1, 1, 0, 0}, {2, 0, 1, 1},
    {1, -1, 2, 0}, {0, 1, 1, 0}, {3, 1, 2, 1}, {1, 1e-6, 0, 0}};

/// Number of characters of an input: fewer are simpler.
[[nodiscard]] std::size_t digits_of(const std::vector<double>& input) {
  std::size_t digits = 0;
  for (const double x : input) {
    digits += duet::to_text(x).size();
  }
  return digits;
}

class sampling {
public:
  sampling(const formula_graph& f, const claim& c) : f_(f), c_(c) {}

  /// Inputs with the simplest first.
  [[nodiscard]] std::vector<std::vector<double>> inputs(int count) {
    constexpr int kinds = 4;
    std::vector<std::vector<double>> result;
    for (std::size_t k = 0; k < special_numbers.size(); ++k) {
      result.push_back(one([&](const auto& values) { return values[k % values.size()]; }, 1));
    }
    for (int k = 0; k < count; ++k) {
      result.push_back(one(
          [&](const auto& values) {
            return values[std::size_t(random_.integer(0, int(values.size()) - 1))];
          },
          k % kinds));
    }
    std::sort(result.begin(), result.end(), [&](const auto& x, const auto& y) {
      return std::pair(digits_of(x), x) < std::pair(digits_of(y), y);
    });
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  /// The input with numbers replaced by simpler ones, as long as it still fails.
  template <class F>
  [[nodiscard]] std::vector<double> simplified(std::vector<double> input, const F& fails) const {
    std::size_t first = 0;
    for (const named_value& x : f_.inputs()) {
      const auto range = c_.ranges.find(x.name);
      for (std::size_t i = first; i < first + x.nodes.size(); ++i) {
        for (const double simple : {0.0, 1.0, 2.0, -1.0}) {
          std::vector<double> other = input;
          other[i] = simple;
          const bool is_within = range == c_.ranges.end() ||
                                 (range->second.first <= simple && simple <= range->second.second);
          const bool is_zero = std::all_of(other.begin() + std::ptrdiff_t(first),
                                           other.begin() + std::ptrdiff_t(first + x.nodes.size()),
                                           [](double each) { return each == 0; });
          if (is_within && !(is_zero && x.kind == shape::quaternion) &&
              std::pair(digits_of(other), std::abs(simple)) <
                  std::pair(digits_of(input), std::abs(input[i])) &&
              fails(other)) {
            input = other;
          }
        }
      }
      first += x.nodes.size();
    }
    return input;
  }

private:
  /// An input of numbers that `choose` takes from lists, or random ones of few digits (kind 2), or
  /// of all (kind 3).
  template <class F>
  [[nodiscard]] std::vector<double> one(const F& choose, int kind) {
    std::vector<double> result;
    for (const named_value& x : f_.inputs()) {
      if (x.kind == shape::quaternion) {
        std::array<double, 4> q = choose(special_rotations);
        if (kind >= 2) {
          do {
            std::generate(q.begin(), q.end(), [&] { return number(-3, 3, kind); });
          } while (q == std::array<double, 4>{});
        }
        result.insert(result.end(), q.begin(), q.end());
        continue;
      }
      const auto range = c_.ranges.find(x.name);
      for (std::size_t i = 0; i < x.nodes.size(); ++i) {
        if (range == c_.ranges.end()) {
          result.push_back(kind < 2 ? choose(special_numbers) : number(-4, 4, kind));
        } else {
          result.push_back(within(range->second, kind, choose));
        }
      }
    }
    return result;
  }
  [[nodiscard]] double number(double low, double high, int kind) {
    const double x = random_.uniform(low, high);
    constexpr double tenths = 10;
    return kind == 2 ? std::round(tenths * x) / tenths + 0.0 : x; // 0, not -0
  }
  template <class F>
  [[nodiscard]] double within(const std::pair<double, double>& range, int kind, const F& choose) {
    const auto [low, high] = range;
    std::vector<double> special{low, high};
    for (const double x : special_numbers) {
      if (low < x && x < high) {
        special.push_back(x);
      }
    }
    return kind < 2 ? choose(special) : std::clamp(number(low, high, kind), low, high);
  }

  const formula_graph& f_;
  const claim& c_;
  duet::random_source random_{1};
};

/// The input over another scalar, with rotations normalised.
template <class S>
[[nodiscard]] std::vector<S> input_over(const formula_graph& f, const std::vector<double>& x) {
  std::vector<S> result(x.begin(), x.end());
  std::size_t first = 0;
  for (const named_value& each : f.inputs()) {
    if (each.kind == shape::quaternion) {
      S square(0);
      for (std::size_t k = first; k < first + 4; ++k) {
        square += result[k] * result[k];
      }
      using std::sqrt;
      const S norm = sqrt(square);
      for (std::size_t k = first; k < first + 4; ++k) {
        result[k] /= norm;
      }
    }
    first += each.nodes.size();
  }
  return result;
}

/// The value of a side in 50 digits.
struct side_value {
  std::vector<real_50> numbers;
  real_50 size = 0, error = 0;
  bool is_finite = true;

  side_value(const formula_graph& f, const std::vector<real_50>& input) {
    const detail::bounded_values<real_50> values(f, input, round_off);
    for (const int node : f.outputs()[0].nodes) {
      numbers.push_back(values.value(node));
      is_finite = is_finite && isfinite(numbers.back());
      size = std::max(size, real_50(abs(numbers.back())));
      error = std::max(error, values.error(node));
    }
  }
  [[nodiscard]] std::string text() const {
    constexpr int digits = 15;
    std::string list;
    for (const real_50& x : numbers) {
      const bool is_zero = abs(x) <= 10 * error; // to round-off
      list += (list.empty() ? "" : ", ") + (is_zero ? "0" : x.str(digits));
    }
    return !is_finite ? "" : numbers.size() == 1 ? list : "[" + list + "]";
  }
};

/// The values of both sides at an input.
struct comparison {
  side_value claimed, expected;

  [[nodiscard]] bool has_no_value() const { return !claimed.is_finite || !expected.is_finite; }
  [[nodiscard]] bool is_one_sided() const { return claimed.is_finite != expected.is_finite; }
  [[nodiscard]] real_50 size() const { return std::max(claimed.size, expected.size); }
  [[nodiscard]] real_50 error() const { return 10 * (claimed.error + expected.error); }
  [[nodiscard]] bool differ() const {
    real_50 difference = 0;
    for (std::size_t k = 0; k < claimed.numbers.size(); ++k) {
      difference = std::max(difference, real_50(abs(claimed.numbers[k] - expected.numbers[k])));
    }
    return difference > tolerance * size() + error();
  }
  /// True if round-off could hide a difference.
  [[nodiscard]] bool is_undecided() const {
    return error() > tolerance && error() > tolerance * size();
  }
};

[[nodiscard]] input_texts texts_of(const formula_graph& f, const std::vector<double>& input) {
  input_texts result;
  std::size_t i = 0;
  for (const named_value& x : f.inputs()) {
    std::string text;
    for (std::size_t k = 0; k < x.nodes.size(); ++k) {
      text += (k == 0 ? "" : ", ") + duet::to_text(input[i++]);
    }
    result.emplace_back(x.name, x.kind == shape::scalar       ? text
                                : x.kind == shape::quaternion ? "normalized(" + text + ")"
                                                              : "[" + text + "]");
  }
  return result;
}

/// Reads a side, with its only output.
[[nodiscard]] named_value read_side(detail::formula_builder& builder, const std::string& text) {
  std::vector<named_value> outputs;
  duet::detail::catching<duet::invalid_input>(
      [&] {
        builder.read(text);
        outputs = builder.take_outputs();
      },
      [&](const duet::invalid_input& error) {
        const std::string message = error.what(), begin = "duet: read_formula: ";
        duet::detail::raise(duet::invalid_input(
            duet::printable(text) + ": " +
            (message.starts_with(begin) ? message.substr(begin.size()) : message)));
      });
  duet::detail::require(outputs.size() == 1, duet::printable(text), ": has ", outputs.size(),
                        " outputs (expected one)");
  return outputs[0];
}

/// The relative error of the side in double.
[[nodiscard]] double double_error(const formula_graph& f, const std::vector<double>& input,
                                  const side_value& exact) {
  const std::vector<double> x = evaluate(f, input_over<double>(f, input));
  real_50 error = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!std::isfinite(x[k])) {
      return exact.size < std::numeric_limits<double>::max() ? 1 : 0;
    }
    error = std::max(error, real_50(abs(x[k] - exact.numbers[k])));
  }
  return exact.size > std::numeric_limits<double>::min() ? double(error / exact.size) : 0;
}

} // namespace

judgement judge(const claim& c) {
  read_options options{.vectors = c.vectors, .rotations = c.rotations, .exact_constants = true};
  const auto has = [&](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (c.wrt && !has(c.vectors, *c.wrt) && !has(c.rotations, *c.wrt)) {
    options.scalars.push_back(*c.wrt);
  }
  detail::formula_builder builder(options);
  const named_value claimed = read_side(builder, c.text);
  const named_value reference = read_side(builder, c.reference);
  formula_graph left = builder.formula(), right = builder.formula();
  left.add_output(claimed);
  right.add_output(reference);
  judgement result;
  if (c.wrt) {
    right = derivative(std::move(right), *c.wrt);
    result.right = detail::formula_writer(right, true).text(false);
    if (detail::refusal_in_latex(right).empty()) {
      result.right_latex = to_latex(right);
    }
  }
  const std::size_t claimed_size = claimed.nodes.size(),
                    expected_size = right.outputs()[0].nodes.size();
  duet::detail::require(claimed_size == expected_size, "the claim has ", claimed_size,
                        " numbers, and ", c.wrt ? "the derivative" : "the other side", " has ",
                        expected_size);
  for (const auto& [name, range] : c.ranges) {
    static_cast<void>(left.input(name));
  }

  constexpr int max_operations = 100'000, min_samples = 20, max_samples = 240;
  const int operations = 1 + left.operations().size() + right.operations().size();
  sampling samples(left, c);
  const auto compared = [&](const std::vector<double>& input) {
    const std::vector<real_50> x = input_over<real_50>(left, input);
    return comparison{side_value(left, x), side_value(right, x)};
  };
  const auto values = [&](const std::vector<double>& input) {
    const comparison both = compared(input);
    return values_at{texts_of(left, input), both.claimed.text(), both.expected.text()};
  };
  double worst = 1e-8; // a loss of half the digits
  std::vector<double> failing;
  for (const std::vector<double>& input :
       samples.inputs(std::clamp(max_operations / operations, min_samples, max_samples))) {
    const comparison both = compared(input);
    if (both.has_no_value()) {
      ++(both.is_one_sided() ? result.one_sided : result.neither);
      if (both.is_one_sided() && !result.first_one_sided) {
        result.first_one_sided = values(input);
      }
    } else if (both.differ()) {
      ++result.disagree;
      failing = failing.empty() ? input : failing;
    } else if (both.is_undecided()) {
      ++result.undecided;
    } else {
      ++result.agree;
      const double loss = double_error(left, input, both.claimed);
      if (loss > worst) {
        worst = loss;
        result.loss = texts_of(left, input);
      }
    }
  }
  if (!failing.empty()) {
    result.simplest = values(samples.simplified(failing, [&](const std::vector<double>& input) {
      const comparison both = compared(input);
      return !both.has_no_value() && both.differ();
    }));
  }
  result.outcome = result.disagree > 0 ? verdict::disagrees
                   : result.agree > 0  ? verdict::agrees
                                       : verdict::no_value;
  constexpr int max_proved_operations = 2000;
  result.is_proved = result.outcome == verdict::agrees && operations <= max_proved_operations &&
                     is_equal(left, right, {.unit = c.rotations}).verdict == equality::proved;
  return result;
}

} // namespace check_formula
