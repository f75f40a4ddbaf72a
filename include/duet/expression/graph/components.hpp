// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/expression/graph/algebra.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/trace.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Formulas as they stand in papers: every number of the result a sum of products, with sines and
/// cosines of whole angles.

namespace duet::expression {

namespace detail {

/// The number that the shortest decimal digits of x stand for.
[[nodiscard]] inline rational decimal_of(double x) {
  const std::string digits = duet::to_text(x);
  const std::size_t e = digits.find('e');
  std::string mantissa = digits.substr(0, e);
  int exponent = e == std::string::npos ? 0 : std::atoi(digits.c_str() + e + 1);
  if (const std::size_t point = mantissa.find('.'); point != std::string::npos) {
    exponent -= int(mantissa.size() - point - 1);
    mantissa.erase(point, 1);
  }
  const bool is_negative = mantissa[0] == '-';
  const std::size_t first = mantissa.find_first_not_of("-0"); // digits with a 0 are octal
  boost::multiprecision::cpp_int above(first == std::string::npos ? "0" : mantissa.substr(first)),
      below(1);
  for (int k = 0; k < std::abs(exponent); ++k) {
    (exponent < 0 ? below : above) *= 10;
  }
  return rational(is_negative ? -above : above, below);
}

/// A formula in which each number is a polynomial of variables, functions and powers of
/// z = e^{iφ}, of units φ of its angles.
class expanded_formula {
public:
  /// \param units  unit of the coefficients of each angle, by its text; refined here
  expanded_formula(const formula_graph& f, std::map<std::string, rational>& units) : units_(units) {
    const int i = ring_.find_atom("i");
    ring_[i].degree = 2;
    ring_[i].relation = polynomial_ring::constant(-1);
    nodes_.push_back(-1);
    for (const named_value& x : f.inputs()) {
      result_.add_input(x);
    }
    const graph& g = f.operations();
    const std::vector<bool> needed = f.needed();
    std::vector<polynomial> values(needed.size());
    std::vector<int> conditions(needed.size(), -1);
    for (int k = 0; k < g.size() && !must_repeat_; ++k) {
      if (needed[std::size_t(k)]) {
        add(g, k, values, conditions);
      }
    }
    if (must_repeat_) {
      return;
    }
    for (named_value y : f.outputs()) {
      for (int& node : y.nodes) {
        node = node_of(values[std::size_t(node)]);
      }
      result_.add_output(std::move(y));
    }
  }

  /// True if a unit was refined: then all has to be done again.
  [[nodiscard]] bool must_repeat() const { return must_repeat_; }
  [[nodiscard]] bool is_too_large() const { return ring_.is_too_large(); }
  [[nodiscard]] const formula_graph& result() const { return result_; }

private:
  /// cos(Σ kⱼφⱼ) and sin(Σ kⱼφⱼ) with their coefficients; of no angles a number.
  struct harmonic {
    rational cosine = 0, sine = 0;
  };

  [[nodiscard]] graph& out() { return result_.operations(); }
  [[nodiscard]] polynomial number_of(double x) {
    return std::isfinite(x) ? polynomial_ring::constant(decimal_of(x)) : atom_of(out().number(x));
  }
  /// The atom of a node of the result.
  [[nodiscard]] polynomial atom_of(int node) {
    const int a = ring_.find_atom("n" + std::to_string(node));
    nodes_.resize(std::max(nodes_.size(), std::size_t(a) + 1), -1);
    nodes_[std::size_t(a)] = node;
    return polynomial_ring::power_of(a, 1);
  }
  [[nodiscard]] static polynomial scaled(const polynomial& p, const rational& c) {
    polynomial q;
    polynomial_ring::add(q, p, c);
    return q;
  }

  void add(const graph& g, int k, std::vector<polynomial>& values, std::vector<int>& conditions) {
    using enum operation;
    const graph_node n = g[k];
    polynomial& y = values[std::size_t(k)];
    const auto x = [&](std::size_t j) -> const polynomial& {
      return values[std::size_t(n.operands[j])];
    };
    switch (n.what) {
    case number:
      y = number_of(n.number);
      return;
    case variable:
      y = atom_of(out().variable(n.index));
      return;
    case negative:
      y = scaled(x(0), -1);
      return;
    case sum:
    case difference:
      y = x(0);
      polynomial_ring::add(y, x(1), n.what == sum ? 1 : -1);
      return;
    case product:
      y = ring_.product(x(0), x(1));
      return;
    case fma:
      y = ring_.product(x(0), x(1));
      polynomial_ring::add(y, x(2));
      return;
    case power:
      if (n.index > 0 && n.index <= 16) {
        y = polynomial_ring::constant(1);
        for (int j = 0; j < n.index; ++j) {
          y = ring_.product(y, x(0));
        }
        return;
      }
      break;
    case quotient:
      if (x(1).size() == 1 && is_plain(x(1).begin()->first)) {
        const monomial inverse = polynomial_ring::power_of(x(1).begin()->first, -1);
        y = ring_.product(x(0), {{inverse, rational(1 / x(1).begin()->second)}});
        return;
      }
      break;
    case sin:
    case cos:
      y = circular(x(0), n.what == sin);
      return;
    default:
      break;
    }
    add_other(g, k, values, conditions);
  }
  /// Another operation, of expanded operands.
  void add_other(const graph& g, int k, std::vector<polynomial>& values,
                 std::vector<int>& conditions) {
    const graph_node n = g[k];
    std::array<int, 3> operands{-1, -1, -1};
    for (std::size_t j = 0; j < std::size_t(operand_count(n.what)); ++j) {
      const std::size_t operand = std::size_t(n.operands[j]);
      operands[j] = conditions[operand] >= 0 ? conditions[operand] : node_of(values[operand]);
    }
    const int node = out().apply(n.what, operands[0], operands[1], operands[2], n.index);
    if (is_condition(n.what)) {
      conditions[std::size_t(k)] = node;
    } else {
      values[std::size_t(k)] =
          out().is_number(node) ? number_of(out()[node].number) : atom_of(node);
    }
  }
  /// True for a product without angles.
  [[nodiscard]] bool is_plain(const monomial& m) const {
    for (const auto& [a, exponent] : m) {
      if (ring_[a].name[0] != 'n') {
        return false;
      }
    }
    return true;
  }

  /// The atom of e^{iφ} of the unit φ of an angle, and how many of it are in c times the angle.
  [[nodiscard]] std::pair<int, int> rotation_by(const monomial& m, const rational& c) {
    const std::string term = ring_.text(m);
    const rational size = abs(c);
    const auto [entry, is_new] = units_.emplace(term, size);
    rational& unit = entry->second;
    rational ratio = c / unit;
    if (denominator(ratio) != 1) {
      const auto common =
          gcd(numerator(size) * denominator(unit), numerator(unit) * denominator(size));
      unit = rational(common, denominator(size) * denominator(unit));
      must_repeat_ = true;
      ratio = 1;
    }
    if (abs(ratio) > 64) { // an angle of its own
      const int a = ring_.find_atom("z" + term + "*" + size.str());
      angles_.emplace(a, std::pair(m, size));
      return {a, c < 0 ? -1 : 1};
    }
    const int a = ring_.find_atom("z" + term);
    angles_.emplace(a, std::pair(m, unit));
    return {a, int(numerator(ratio))};
  }
  /// The sine or cosine of a sum of angles.
  [[nodiscard]] polynomial circular(const polynomial& angle, bool is_sine) {
    for (const auto& [m, c] : angle) {
      if (!is_plain(m)) {
        return atom_of(out().apply(is_sine ? operation::sin : operation::cos, node_of(angle)));
      }
    }
    monomial forth, back;
    for (const auto& [m, c] : angle) {
      const auto [z, n] = rotation_by(m, c);
      forth = polynomial_ring::product_of(forth, {{z, n}});
      back = polynomial_ring::product_of(back, {{z, -n}});
    }
    const polynomial i = polynomial_ring::power_of(ring_.find_atom("i"), 1);
    polynomial y; // sin φ = (e^{iφ} − e^{−iφ})/2i
    polynomial_ring::add(y, {{forth, rational(1, 2)}});
    polynomial_ring::add(y, {{back, rational(is_sine ? -1 : 1, 2)}});
    return is_sine ? scaled(ring_.product(i, y), -1) : y;
  }

  // Back to operations.

  [[nodiscard]] int number_node(const rational& c) {
    const double x = c.convert_to<double>();
    constexpr int max_denominator = 10000; // of fractions that one reads
    if (!std::isfinite(x) || decimal_of(x) == c || denominator(c) > max_denominator) {
      return out().number(x);
    }
    return out().apply(operation::quotient, out().number(numerator(c).convert_to<double>()),
                       out().number(denominator(c).convert_to<double>()));
  }
  [[nodiscard]] int power_node(int node, int n) {
    return n == 1 ? node : out().apply(operation::power, node, -1, -1, n);
  }
  /// A product of atoms that are nodes.
  [[nodiscard]] int product_node(const monomial& m) {
    int above = out().number(1), below = above;
    for (const auto& [a, exponent] : m) {
      int& side = exponent > 0 ? above : below;
      side = out().apply(operation::product, side,
                         power_node(nodes_[std::size_t(a)], std::abs(exponent)));
    }
    return out().is_number(below, 1) ? above : out().apply(operation::quotient, above, below);
  }
  [[nodiscard]] int sum_node(int a, const rational& c, int factor) {
    const int size = number_node(abs(c));
    const int term = out().is_number(factor, 1) ? size
                     : out().is_number(size, 1) ? factor
                                                : out().apply(operation::product, size, factor);
    return a < 0 ? (c < 0 ? out().apply(operation::negative, term) : term)
                 : out().apply(c < 0 ? operation::difference : operation::sum, a, term);
  }
  /// Σ kⱼφⱼ.
  [[nodiscard]] int angle_node(const monomial& m) {
    int angle = -1;
    for (const auto& [a, n] : m) {
      const auto& [of, unit] = angles_.at(a);
      angle = sum_node(angle, unit * n, product_node(of));
    }
    return angle;
  }

  /// The powers of e^{iφ} of each product, as sines and cosines of sums of angles.
  [[nodiscard]] std::map<monomial, std::map<monomial, harmonic>>
  harmonics_of(const polynomial& p) const {
    std::map<monomial, std::map<monomial, harmonic>> result;
    for (const auto& [m, c] : p) {
      monomial plain, angle;
      bool is_imaginary = false;
      for (const auto& [a, exponent] : m) {
        const char kind = ring_[a].name[0];
        is_imaginary = is_imaginary || kind == 'i';
        if (kind != 'i') {
          (kind == 'n' ? plain : angle).emplace_back(a, exponent);
        }
      }
      const bool is_back = !angle.empty() && angle[0].second < 0;
      for (auto& [a, exponent] : angle) {
        exponent = is_back ? -exponent : exponent;
      }
      harmonic& h = result[plain][angle]; // c e^{iφ} + conjugate
      (is_imaginary ? h.sine : h.cosine) += is_imaginary && !is_back ? rational(-c) : c;
    }
    return result;
  }
  /// The atom of the cosine or sine of an angle Σ kⱼφⱼ, and a sign.
  [[nodiscard]] std::pair<int, int> circle(monomial angle, bool is_sine) {
    const bool is_back = angle[0].second < 0;
    for (auto& [a, exponent] : angle) {
      exponent = is_back ? -exponent : exponent;
    }
    const polynomial p =
        atom_of(out().apply(is_sine ? operation::sin : operation::cos, angle_node(angle)));
    const int atom = p.begin()->first[0].first;
    circles_.emplace(atom, std::pair(angle, is_sine));
    return {atom, is_sine && is_back ? -1 : 1};
  }
  /// A polynomial of the sines and cosines of single angles, by e^{iφ} = C + iS.
  [[nodiscard]] polynomial by_single_angles(const polynomial& p) {
    std::map<int, int> common; // of the exponents of each angle
    for (const auto& [m, c] : p) {
      for (const auto& [a, exponent] : m) {
        if (ring_[a].name[0] == 'z') {
          common[a] = std::gcd(common[a], exponent);
        }
      }
    }
    for (auto& [a, n] : common) { // sin²φ, not that of 2φ
      const rational written = 1 / angles_.at(a).second;
      const int size = denominator(written) == 1 && written <= n ? int(numerator(written)) : n;
      n = n % size == 0 ? size : n;
    }
    const int i = ring_.find_atom("i");
    polynomial result;
    for (const auto& [m, c] : p) {
      polynomial term = polynomial_ring::constant(c);
      for (const auto& [a, exponent] : m) {
        if (ring_[a].name[0] != 'z') {
          term = ring_.product(term, polynomial_ring::power_of(a, exponent));
          continue;
        }
        const int cosine = circle({{a, common[a]}}, false).first;
        const int sine = circle({{a, common[a]}}, true).first;
        ring_[sine].degree = 2;
        ring_[sine].relation = polynomial_ring::constant(1);
        polynomial_ring::add(ring_[sine].relation, polynomial_ring::power_of(cosine, 2), -1);
        polynomial unit = polynomial_ring::power_of(cosine, 1);
        polynomial_ring::add(
            unit, {{polynomial_ring::product_of({{i, 1}}, {{sine, 1}}), exponent < 0 ? -1 : 1}});
        for (int k = 0; k < std::abs(exponent / common[a]); ++k) {
          term = ring_.product(term, unit);
        }
      }
      polynomial_ring::add(result, term);
    }
    return result;
  }
  /// Joins two terms to one of cos(α ± β) or sin(α ± β); false if no two can be joined.
  [[nodiscard]] bool join_angles(polynomial& p) {
    constexpr std::size_t max_size = 500;
    for (auto t = p.begin(); t != p.end() && p.size() <= max_size; ++t) {
      const auto& [m, c] = *t;
      for (const auto& [a, n] : m) {
        for (const auto& [b, n_of_b] : m) {
          const auto of_a = circles_.find(a), of_b = circles_.find(b);
          if (a == b || of_a == circles_.end() || of_b == circles_.end() ||
              of_b->second.second) { // b is a cosine
            continue;
          }
          const bool is_sine = of_a->second.second;
          const monomial alpha = of_a->second.first, beta = of_b->second.first;
          const monomial rest =
              polynomial_ring::product_of(m, {{std::min(a, b), -1}, {std::max(a, b), -1}});
          monomial partner =
              polynomial_ring::product_of(rest, {{circle(alpha, !is_sine).first, 1}});
          partner = polynomial_ring::product_of(partner, {{circle(beta, true).first, 1}});
          const auto other = p.find(partner);
          if (other == p.end() || other == t || abs(other->second) != abs(c)) {
            continue;
          }
          // cos α cos β ∓ sin α sin β, sin α cos β ± cos α sin β
          const bool is_difference = (other->second == c) != is_sine;
          monomial angle = beta;
          for (auto& [z, exponent] : angle) {
            exponent = is_difference ? -exponent : exponent;
          }
          angle = polynomial_ring::product_of(alpha, angle);
          polynomial joined;
          rational factor = c;
          if (angle.empty()) { // the sine or cosine of 0
            factor = is_sine ? 0 : c;
            joined = {{rest, 1}};
          } else {
            const auto [atom, sign] = circle(angle, is_sine);
            factor *= sign;
            joined = {{polynomial_ring::product_of(rest, {{atom, 1}}), 1}};
          }
          p.erase(other);
          p.erase(t);
          polynomial_ring::add(p, joined, factor);
          return true;
        }
      }
    }
    return false;
  }
  /// A polynomial of atoms that are nodes, with what all terms share before the others.
  [[nodiscard]] int sum_of_products(const polynomial& p) {
    const monomial common = p.size() == 1 ? monomial() : polynomial_ring::common_factor(p);
    const monomial inverse = polynomial_ring::power_of(common, -1);
    const bool is_negative =
        std::all_of(p.begin(), p.end(), [](const auto& term) { return term.second < 0; });
    int result = -1;
    for (const auto& [m, c] : p) {
      const int product = product_node(polynomial_ring::product_of(m, inverse));
      result = sum_node(result, is_negative ? rational(-c) : c, product);
    }
    result =
        common.empty() ? result : out().apply(operation::product, product_node(common), result);
    return is_negative ? out().apply(operation::negative, result) : result;
  }
  /// The node of a polynomial: of sines and cosines of single angles and of sums that two terms
  /// join to, or of sums of angles alone where that has fewer terms.
  [[nodiscard]] int node_of(const polynomial& p) {
    if (p.empty()) {
      return out().number(0);
    }
    polynomial by_sums;
    for (const auto& [plain, of_angle] : harmonics_of(p)) {
      for (const auto& [angle, h] : of_angle) {
        if (angle.empty()) {
          polynomial_ring::add(by_sums, {{plain, 1}}, h.cosine);
          continue;
        }
        for (const bool is_sine : {false, true}) {
          const auto [atom, sign] = circle(angle, is_sine);
          polynomial_ring::add(by_sums, {{polynomial_ring::product_of(plain, {{atom, 1}}), 1}},
                               is_sine ? h.sine : h.cosine);
        }
      }
    }
    polynomial single = by_single_angles(p);
    while (join_angles(single)) {
    }
    const polynomial& shorter = single.size() <= by_sums.size() ? single : by_sums;
    return shorter.empty() ? out().number(0) : sum_of_products(shorter);
  }

  std::map<std::string, rational>& units_;
  polynomial_ring ring_;
  formula_graph result_;
  std::vector<int> nodes_;                              ///< of atoms that are nodes
  std::map<int, std::pair<monomial, rational>> angles_; ///< φ of z, a product and its factor
  std::map<int, std::pair<monomial, bool>> circles_;    ///< angles of sines (true) and cosines
  bool must_repeat_ = false;
};

} // namespace detail

/// The formula with each number of its outputs expanded, as it stands in papers: a sum of products,
/// in which half angles of quaternions and poses are gone, and sines and cosines are those of
/// single angles or of sums of angles, whichever takes fewer terms. Numbers are read as the
/// decimals that they print as. `to_latex` writes the result; to compute, use the formula itself.
///
/// \throws invalid_input for formulas with products of more than 40000 pairs of terms
template <class F>
[[nodiscard]] formula_graph components(const F& f) {
  const formula_graph& g = graph_of(f);
  std::map<std::string, detail::rational> units;
  for (;;) {
    const detail::expanded_formula expanded(g, units);
    duet::detail::require(!expanded.is_too_large(),
                          "duet: components: a product has more than 40000 pairs of terms");
    if (!expanded.must_repeat()) {
      return expanded.result();
    }
  }
}

} // namespace duet::expression
