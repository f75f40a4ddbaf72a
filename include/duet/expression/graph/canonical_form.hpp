// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/graph/algebra.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/graph_text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Formulas as fractions of polynomials, with the conditions under which they have values, for
/// proofs. For those who extend duet; users call `is_equal`.

namespace duet::expression {

/// Knowledge of the inputs of formulas, by their names.
struct assumptions {
  std::vector<std::string> positive = {}; ///< scalars that are positive
  std::vector<std::string> nonzero = {};  ///< scalars, vectors and rotations that are not 0
  std::vector<std::string> unit = {};     ///< vectors, quaternions and poses of unit norm
  /// The claim is equality where both have values, as x/x = 1.
  bool where_both_have_values = false;
};

namespace detail {

/// A condition for a value: of a polynomial, or of an argument that is only known by its text.
struct value_condition {
  enum class kind { nonzero, not_negative, positive, other };
  kind what;
  polynomial p;
  std::string text;
};

/// Formulas as fractions of polynomials.
class canonical_form {
public:
  /// \param bases    unit of the coefficients of each angle, by its text; refined here
  /// \param stumpff  largest order of the Stumpff functions of each argument, likewise
  canonical_form(const assumptions& known, std::map<std::string, rational>& bases,
                 std::map<std::string, int>& stumpff)
      : known_(known), bases_(bases), stumpff_(stumpff) {}

  /// True if a unit of angles or an order was refined: then all has to be done again.
  [[nodiscard]] bool must_repeat() const { return must_repeat_; }
  [[nodiscard]] const fraction_field& field() const { return field_; }

  struct value {
    fraction number;
    std::string condition;            ///< of a condition its text
    std::set<int> needs;              ///< conditions for a value
    polynomial nonzero_if_true = {};  ///< of a condition: cannot vanish where it holds
    polynomial nonzero_if_false = {}; ///< likewise where it does not
  };

  /// The nodes of a formula.
  [[nodiscard]] std::vector<value> values_of(const formula_graph& f) {
    const graph& g = f.operations();
    const std::vector<bool> needed = f.needed();
    std::vector<value> values(needed.size());
    add_inputs(f, values);
    for (int i = 0; i < g.size(); ++i) {
      if (needed[std::size_t(i)] && !g.is(i, operation::variable)) {
        values[std::size_t(i)] = value_of(g[i], values);
      }
    }
    return values;
  }

  /// True if the values are equal as functions, where both have values.
  [[nodiscard]] bool are_equal(const fraction& a, const fraction& b) {
    return field_.sum(a, b, -1).above.empty();
  }
  /// True if what one of two values needs holds always or is needed by the other as well.
  [[nodiscard]] bool have_equal_domains(const value& a, const value& b) const {
    const auto covers = [this](const value& x, const value& y) {
      return std::all_of(y.needs.begin(), y.needs.end(),
                         [&](int need) { return x.needs.count(need) > 0 || holds(need); });
    };
    return covers(a, b) && covers(b, a);
  }

private:
  using kind = value_condition::kind;

  [[nodiscard]] bool holds(int need) const {
    const value_condition& c = conditions_[std::size_t(need)];
    return c.what == kind::nonzero        ? cannot_vanish(c.p)
           : c.what == kind::not_negative ? field_.ring.sign_of(c.p, false) == 1
           : c.what == kind::positive     ? field_.ring.sign_of(c.p) == 1
                                          : !c.p.empty() && cannot_vanish(c.p);
  }
  /// True for a polynomial that is of one sign, or a multiple of one that is assumed not to be 0.
  [[nodiscard]] bool cannot_vanish(const polynomial& p) const {
    return field_.ring.sign_of(p) != 0 ||
           std::any_of(nonzero_polynomials_.begin(), nonzero_polynomials_.end(),
                       [&](const polynomial& known) { return are_proportional(p, known); });
  }
  /// True if a is a multiple of b, neither of which is 0.
  [[nodiscard]] static bool are_proportional(const polynomial& a, const polynomial& b) {
    const rational leading_a = a.begin()->second, leading_b = b.begin()->second;
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [&](const auto& x, const auto& y) {
             return x.first == y.first && x.second * leading_b == y.second * leading_a;
           });
  }

  [[nodiscard]] static bool contains(const std::vector<std::string>& names,
                                     const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  }
  void add_inputs(const formula_graph& f, std::vector<value>& values) {
    for (const named_value& x : f.inputs()) {
      std::vector<int> atoms;
      for (std::size_t k = 0; k < x.nodes.size(); ++k) {
        const int a = field_.ring.find_atom("input " + x.name + " " + std::to_string(k));
        atoms.push_back(a);
        atom& info = field_.ring[a];
        info.is_positive = contains(known_.positive, x.name);
        if (contains(known_.nonzero, x.name) && x.nodes.size() == 1) {
          nonzero_.insert(a);
        }
        if (std::size_t(x.nodes[k]) < values.size()) {
          values[std::size_t(x.nodes[k])] = {{polynomial_ring::power_of(a, 1)}, {}, {}};
        }
      }
      if (contains(known_.nonzero, x.name) && x.nodes.size() > 1) {
        polynomial square;
        for (const int a : atoms) {
          polynomial_ring::add(square, polynomial_ring::power_of(a, 2));
        }
        nonzero_polynomials_.push_back(std::move(square));
      }
      if (contains(known_.unit, x.name)) { // a pose has the norm of its real part
        const std::size_t size = x.kind == shape::pose ? 4 : atoms.size();
        atom& first = field_.ring[atoms[0]];
        first.degree = 2;
        first.relation = polynomial_ring::constant(1);
        for (std::size_t k = 1; k < size; ++k) {
          polynomial_ring::add(first.relation, polynomial_ring::power_of(atoms[k], 2), -1);
        }
      }
    }
  }

  [[nodiscard]] int condition_of(kind what, const fraction& x) {
    value_condition c{what, x.above, {}};
    if (what == kind::nonzero) { // the same up to a factor
      const rational leading = c.p.empty() ? rational(1) : c.p.begin()->second;
      for (auto& [m, coefficient] : c.p) {
        coefficient /= leading;
      }
    } else if (!x.below.empty()) {
      c = {kind::other, {}, std::to_string(int(what)) + field_.text(x)};
    }
    for (std::size_t i = 0; i < conditions_.size(); ++i) {
      if (conditions_[i].what == c.what && conditions_[i].p == c.p &&
          conditions_[i].text == c.text) {
        return int(i);
      }
    }
    conditions_.push_back(std::move(c));
    return int(conditions_.size()) - 1;
  }
  void require(value& x, kind what, const fraction& of) {
    if (what == kind::nonzero) { // each factor apart
      const auto is_known = [&](int a) {
        const atom& info = field_.ring[a];
        return nonzero_.count(a) > 0 || info.is_positive ||
               (info.degree == 2 && is_root(info) && cannot_vanish(info.relation));
      };
      if (of.above.size() == 1) {
        for (const auto& [a, exponent] : of.above.begin()->first) {
          if (!is_known(a)) {
            x.needs.insert(condition_of(kind::nonzero, {polynomial_ring::power_of(a, 1)}));
          }
        }
        return;
      }
    }
    x.needs.insert(condition_of(what, of));
  }
  /// A condition that is only known by its text, and holds where a polynomial does not vanish.
  void require_other(value& x, const std::string& text, const polynomial& sufficient = {}) {
    value_condition c{kind::other, sufficient, text};
    for (std::size_t i = 0; i < conditions_.size(); ++i) {
      if (conditions_[i].what == kind::other && conditions_[i].text == text) {
        x.needs.insert(int(i));
        return;
      }
    }
    conditions_.push_back(std::move(c));
    x.needs.insert(int(conditions_.size()) - 1);
  }

  [[nodiscard]] static bool is_root(const atom& x) { return x.name.rfind("root2", 0) == 0; }
  /// The square root in a product, where it has one with exponent 1; otherwise -1.
  [[nodiscard]] int root_in(const monomial& m) const {
    int root = -1;
    for (const auto& [a, exponent] : m) {
      if (is_root(field_.ring[a])) {
        if (root >= 0 || exponent != 1) {
          return -1;
        }
        root = a;
      }
    }
    return root;
  }
  /// cos and sin of c m with a square root √p in m, by the Stumpff functions of its square, which
  /// has none.
  [[nodiscard]] std::pair<fraction, fraction> pair_of_root(const monomial& m, const rational& c,
                                                           int root) {
    const fraction rest{{{polynomial_ring::product_of(m, {{root, -1}}), c}}};
    const fraction square =
        field_.product(field_.product(rest, rest), {field_.ring[root].relation});
    const fraction sine = field_.product({{{m, c}}}, stumpff_function(square, 1));
    return {stumpff_function(square, 0), sine};
  }

  [[nodiscard]] fraction atom_of(const std::string& name) {
    return {polynomial_ring::power_of(field_.ring.find_atom(name), 1)};
  }
  [[nodiscard]] fraction negated(const fraction& x) {
    return field_.product(fraction_field::constant(-1), x);
  }

  /// A function that is only known by its argument; odd ones are those of an argument whose first
  /// term is positive.
  [[nodiscard]] fraction opaque(const std::string& function, const fraction& x, int parity = 0) {
    const std::string text = field_.text(x);
    const std::string other = parity == 0 ? text : field_.text(negated(x));
    if (other < text) {
      const fraction f = atom_of(function + "(" + other + ")");
      return parity == 1 ? negated(f) : f;
    }
    return atom_of(function + "(" + text + ")");
  }

  /// The coefficient c of a term of an angle as a multiple of its unit; 0 if the unit was refined.
  [[nodiscard]] int multiple(const std::string& term, const rational& c) {
    const rational size = abs(c);
    const auto [entry, is_new] = bases_.emplace(term, size);
    if (is_new) {
      return c < 0 ? -1 : 1;
    }
    const rational ratio = c / entry->second;
    if (denominator(ratio) == 1 && abs(ratio) <= 24) {
      return int(numerator(ratio));
    }
    const auto common = gcd(numerator(size) * denominator(entry->second),
                            numerator(entry->second) * denominator(size));
    const rational finer(common, denominator(size) * denominator(entry->second));
    if (finer < entry->second && abs(c) / finer <= 24) {
      entry->second = finer;
      must_repeat_ = true;
    }
    return 0;
  }

  /// cos x and sin x.
  [[nodiscard]] std::pair<fraction, fraction> cosine_and_sine(const fraction& x) {
    if (!x.below.empty()) {
      return circular_pair(opaque_angle(x));
    }
    std::pair<fraction, fraction> result{fraction_field::constant(1), fraction_field::constant(0)};
    for (const auto& [m, c] : x.above) {
      const std::string term = field_.ring.text(m);
      const int n = multiple(term, c);
      if (n == 0) {
        return circular_pair(opaque_angle(x));
      }
      const int root = root_in(m);
      const auto unit = root >= 0 ? pair_of_root(m, bases_.at(term), root)
                                  : circular_pair({term + "*" + bases_.at(term).str(), 1});
      for (int k = 0; k < std::abs(n); ++k) {
        const fraction sine = n < 0 ? negated(unit.second) : unit.second;
        const fraction cosine = field_.sum(field_.product(result.first, unit.first),
                                           field_.product(result.second, sine), -1);
        result.second = field_.sum(field_.product(result.second, unit.first),
                                   field_.product(result.first, sine));
        result.first = cosine;
      }
    }
    return result;
  }
  [[nodiscard]] std::pair<std::string, int> opaque_angle(const fraction& x) {
    const std::string text = field_.text(x), other = field_.text(negated(x));
    return other < text ? std::pair{other, -1} : std::pair{text, 1};
  }
  [[nodiscard]] std::pair<fraction, fraction>
  circular_pair(const std::pair<std::string, int>& angle) {
    const fraction sine = atom_of("sin " + angle.first);
    const int cosine = field_.ring.find_atom("cos " + angle.first);
    atom& info = field_.ring[cosine];
    info.degree = 2;
    info.relation = polynomial_ring::constant(1);
    polynomial_ring::add(info.relation,
                         {{monomial{{sine.above.begin()->first[0].first, 2}}, rational(1)}}, -1);
    return {{polynomial_ring::power_of(cosine, 1)}, angle.second < 0 ? negated(sine) : sine};
  }

  /// e^x as a product of powers of exponentials.
  [[nodiscard]] fraction exponential(const fraction& x) {
    fraction result = fraction_field::constant(1);
    const auto positive_atom = [this](const std::string& name, int exponent) {
      const int a = field_.ring.find_atom(name);
      field_.ring[a].is_positive = true;
      return fraction{polynomial_ring::power_of(a, exponent)};
    };
    if (!x.below.empty()) {
      return positive_atom("exp " + field_.text(x), 1);
    }
    for (const auto& [m, c] : x.above) {
      const auto logarithm =
          m.size() == 1 && m[0].second == 1 ? logs_.find(m[0].first) : logs_.end();
      if (logarithm != logs_.end() && denominator(c) <= 2 && abs(c) <= 8) { // e^{c log x} = x^c
        fraction base = denominator(c) == 1 ? logarithm->second : root(logarithm->second, 2);
        base = c < 0 ? field_.reciprocal(base) : base;
        for (int k = 0; k < abs(numerator(c)); ++k) {
          result = field_.product(result, base);
        }
        continue;
      }
      const std::string term = field_.ring.text(m);
      const int n = multiple("exp " + term, c);
      if (n == 0) {
        return positive_atom("exp " + field_.text(x), 1);
      }
      result = field_.product(
          result, positive_atom("exp " + term + "*" + bases_.at("exp " + term).str(), n));
    }
    return result;
  }

  [[nodiscard]] fraction root(const fraction& x, int degree) {
    if (!x.below.empty()) {
      const bool is_separate = degree == 2 && !is_implicit(x) &&
                               std::all_of(x.below.begin(), x.below.end(), [&](const auto& each) {
                                 return field_.ring.sign_of(field_.divisor(each.first), false) == 1;
                               });
      if (!is_separate) {
        return opaque("root" + std::to_string(degree), x);
      }
      fraction result = root({x.above}, 2); // over those of positive divisors
      for (const auto& [divisor, exponent] : x.below) {
        const polynomial of = field_.divisor(divisor);
        const fraction inverse = field_.reciprocal(root({of}, 2));
        for (int k = 0; k < exponent; ++k) {
          result = field_.product(result, inverse);
        }
      }
      return result;
    }
    if (x.above.empty()) {
      return x;
    }
    fraction outside = fraction_field::constant(1), rest = x;
    if (degree == 2) { // squares of numbers and of what is positive
      monomial common;
      for (const auto& [i, exponent] : polynomial_ring::common_factor(x.above)) {
        if (field_.ring[i].is_positive && exponent >= 2) {
          common.emplace_back(i, exponent / 2);
        }
      }
      rational number = 1;
      if (const auto root = square_root({{{}, x.above.begin()->second}}); !root.empty()) {
        number = root.begin()->second;
      }
      const monomial inverse = polynomial_ring::power_of(common, -2);
      rest.above.clear();
      for (const auto& [n, d] : x.above) {
        rest.above.emplace(polynomial_ring::product_of(n, inverse), d / (number * number));
      }
      outside.above = {{common, number}};
      if (rest.above == polynomial_ring::constant(1)) {
        return outside;
      }
    }
    const fraction f = opaque("root" + std::to_string(degree), rest);
    atom& info = field_.ring[f.above.begin()->first[0].first];
    info.degree = degree;
    info.relation = rest.above;
    info.is_positive = degree == 2 && field_.ring.sign_of(rest.above) == 1;
    return field_.product(outside, f);
  }

  /// c_n(s) by that of the largest order of the same argument: c_n = 1/n! − s c_{n+2}.
  [[nodiscard]] fraction stumpff_function(const fraction& s, int order) {
    if (s.below.empty() && field_.ring.is_regular(s.above) &&
        !(s.above.size() == 1 && s.above.begin()->first.empty())) {
      if (order > 1) { // c_n = (1/(n − 2)! − c_{n−2})/s
        const fraction constant = fraction_field::constant(1 / factorial_of(order - 2));
        return continued_quotient(field_.sum(constant, stumpff_function(s, order - 2), -1),
                                  s.above);
      }
      if (const auto angle = square_root(s.above); !angle.empty()) {
        const auto [cosine, sine] = cosine_and_sine({angle});
        return order == 0 ? cosine : continued_quotient(sine, angle);
      }
      if (const auto arc = pair_of_arc(s.above)) {
        return order == 0 ? arc->first : arc->second;
      }
    }
    const std::string text = field_.text(s);
    int& largest = stumpff_[text];
    if (order > largest) {
      must_repeat_ = must_repeat_ || largest > 1 || order > 1;
      largest = order;
    }
    if (largest <= 1) {
      const fraction f = atom_of("stumpff" + std::to_string(order) + text);
      if (order == 0) {
        const fraction c1 = atom_of("stumpff1" + text);
        atom& info = field_.ring[f.above.begin()->first[0].first];
        if (s.below.empty() && info.degree == 0) { // c₀² = 1 − s c₁²
          info.degree = 2;
          info.relation = polynomial_ring::constant(1);
          const polynomial square = field_.ring.product(c1.above, c1.above);
          polynomial_ring::add(info.relation, field_.ring.product(s.above, square), -1);
        }
      }
      return f;
    }
    return by_largest_order(s, text, order, largest);
  }
  [[nodiscard]] static rational factorial_of(int n) {
    rational factorial = 1;
    for (int i = 2; i <= n; ++i) {
      factorial *= i;
    }
    return factorial;
  }
  /// A square root of a term, otherwise 0.
  [[nodiscard]] static polynomial square_root(const polynomial& p) {
    if (p.size() != 1 || p.begin()->second < 0) {
      return {};
    }
    monomial m = p.begin()->first;
    const rational c = p.begin()->second;
    const rational root(sqrt(numerator(c)), sqrt(denominator(c)));
    for (auto& [i, exponent] : m) {
      if (exponent % 2 != 0) {
        return {};
      }
      exponent /= 2;
    }
    return root * root == c ? polynomial{{m, root}} : polynomial();
  }
  /// cos kφ and sin kφ/kφ of k²φ² for the angle φ = √s a of a = arc_ratio(s, w) and an integer k:
  /// cos φ = w/√(s + w²), sin φ/φ = 1/(a √(s + w²)).
  [[nodiscard]] std::optional<std::pair<fraction, fraction>> pair_of_arc(const polynomial& square) {
    for (const auto& [a, arc] : arcs_) {
      const auto rest = field_.ring.quotient(square, polynomial_ring::power_of(a, 2));
      const polynomial& s = arc.first.above;
      if (!rest || !are_proportional(*rest, s)) {
        continue;
      }
      const polynomial k = square_root({{{}, rest->begin()->second / s.begin()->second}});
      if (k.empty() || denominator(k.begin()->second) != 1 || k.begin()->second > 8) {
        continue;
      }
      const fraction w = arc.second, ratio{polynomial_ring::power_of(a, 1)};
      const fraction norm = root(field_.sum(arc.first, field_.product(w, w)), 2);
      if (norm.above.empty()) {
        continue;
      }
      const fraction inverse = field_.reciprocal(norm);
      const fraction cosine = field_.product(w, inverse);
      const fraction sine = field_.product(inverse, field_.reciprocal(ratio)); // over φ
      std::pair<fraction, fraction> result{cosine, sine};
      const int count = int(numerator(k.begin()->second));
      const fraction phi_square{field_.ring.product(s, polynomial_ring::power_of(a, 2))};
      for (int i = 1; i < count; ++i) {
        const fraction next =
            field_.sum(field_.product(result.first, cosine),
                       field_.product(phi_square, field_.product(result.second, sine)), -1);
        result.second =
            field_.sum(field_.product(result.second, cosine), field_.product(result.first, sine));
        result.first = next;
      }
      result.second = field_.product(result.second, fraction_field::constant(rational(1, count)));
      return result;
    }
    return std::nullopt;
  }
  [[nodiscard]] fraction by_largest_order(const fraction& s, const std::string& text, int order,
                                          int largest) {
    if (order + 2 > largest) {
      return atom_of("stumpff" + std::to_string(order) + text);
    }
    return field_.sum(fraction_field::constant(1 / factorial_of(order)),
                      field_.product(s, by_largest_order(s, text, order + 2, largest)), -1);
  }

  [[nodiscard]] value value_of(const graph_node& n, const std::vector<value>& values) {
    value result;
    std::array<const value*, 3> x{};
    for (int k = 0; k < operand_count(n.what); ++k) {
      x[std::size_t(k)] = &values[std::size_t(n.operands[std::size_t(k)])];
      result.needs.insert(x[std::size_t(k)]->needs.begin(), x[std::size_t(k)]->needs.end());
    }
    if (is_condition(n.what)) {
      result.condition = std::to_string(int(n.what));
      for (int k = 0; k < operand_count(n.what); ++k) {
        const value& operand = *x[std::size_t(k)];
        result.condition +=
            "(" + (operand.condition.empty() ? field_.text(operand.number) : operand.condition) +
            ")";
      }
      note_what_cannot_vanish(n, x, result);
      return result;
    }
    if (n.what == operation::select) {
      return choice(*x[0], *x[1], *x[2]);
    }
    result.number = number_of(n, x, result);
    return result;
  }

  /// Divisors that do not vanish where c < p of a number c ≥ 0, or p ≠ 0.
  void note_what_cannot_vanish(const graph_node& n, const std::array<const value*, 3>& x,
                               value& result) const {
    const auto number_in = [](const fraction& f) {
      const bool is_number =
          f.below.empty() &&
          (f.above.empty() || (f.above.size() == 1 && f.above.begin()->first.empty()));
      return !is_number ? rational(-1) : f.above.empty() ? rational(0) : f.above.begin()->second;
    };
    if (n.what == operation::no) {
      result.nonzero_if_true = x[0]->nonzero_if_false;
      result.nonzero_if_false = x[0]->nonzero_if_true;
    } else if (n.what == operation::less && number_in(x[0]->number) >= 0 &&
               !is_implicit(x[1]->number)) {
      result.nonzero_if_true = x[1]->number.above;
    } else if (n.what == operation::equal && number_in(x[1]->number) == 0 &&
               !is_implicit(x[0]->number)) {
      result.nonzero_if_false = x[0]->number.above;
    }
  }
  [[nodiscard]] bool is_implied(int need, const polynomial& divisor) const {
    const value_condition& c = conditions_[std::size_t(need)];
    if (c.what != kind::nonzero || divisor.empty()) {
      return false;
    }
    if (divisor.size() == 1 && c.p.size() == 1) { // none of the atoms of a product vanishes
      const monomial &of_condition = divisor.begin()->first, &m = c.p.begin()->first;
      return std::all_of(m.begin(), m.end(), [&](const auto& factor) {
        return std::any_of(of_condition.begin(), of_condition.end(),
                           [&](const auto& known) { return known.first == factor.first; });
      });
    }
    return field_.ring.quotient(divisor, c.p).has_value();
  }
  /// True for a value that keeps its meaning where its divisors vanish: by continuity.
  [[nodiscard]] bool is_kept(const fraction& x) const {
    return std::all_of(x.below.begin(), x.below.end(), [&](const auto& each) {
      return field_.ring.is_regular(field_.divisor(each.first));
    });
  }
  /// True if it has divisors that may vanish where it has a value.
  [[nodiscard]] bool is_implicit(const fraction& x) const {
    return std::any_of(x.below.begin(), x.below.end(),
                       [&](const auto& each) { return implicit_.count(each.first) > 0; });
  }
  /// a/b of a regular b that may vanish, where the quotient is continued.
  [[nodiscard]] fraction continued_quotient(const fraction& a, const polynomial& b) {
    const fraction inverse = field_.reciprocal({b});
    for (const auto& [divisor, exponent] : inverse.below) {
      implicit_.insert(divisor);
    }
    return field_.product(a, inverse);
  }

  [[nodiscard]] value choice(const value& condition, const value& b, const value& c) {
    value result{{}, {}, condition.needs};
    result.needs.insert(b.needs.begin(), b.needs.end());
    result.needs.insert(c.needs.begin(), c.needs.end());
    if (are_equal(b.number, c.number)) {
      const fraction& kept = c.number.below.empty() || !is_kept(b.number) ? c.number : b.number;
      value common{kept, {}, condition.needs};
      const auto add_needs = [&](const value& branch, const polynomial& cannot_vanish) {
        for (const int need : branch.needs) {
          if (!is_implied(need, cannot_vanish)) {
            common.needs.insert(need);
          }
        }
      };
      add_needs(b, condition.nonzero_if_true);
      add_needs(c, condition.nonzero_if_false);
      if (common.needs == result.needs) {
        return common;
      }
      if (is_kept(kept)) {
        for (const auto& [divisor, exponent] : kept.below) {
          implicit_.insert(divisor);
        }
        return common;
      }
    }
    result.number = atom_of("select(" + condition.condition + field_.text(b.number) +
                            field_.text(c.number) + ")");
    return result;
  }

  [[nodiscard]] fraction number_of(const graph_node& n, const std::array<const value*, 3>& x,
                                   value& result) {
    const auto arg = [&](std::size_t k) -> const fraction& { return x[k]->number; };
    const auto one = [] { return fraction_field::constant(1); };
    switch (n.what) {
    case operation::number:
      if (!std::isfinite(n.number)) {
        return atom_of("number" + std::to_string(n.number));
      }
      return fraction_field::constant(rational(n.number));
    case operation::negative:
      return negated(arg(0));
    case operation::sum:
      return field_.sum(arg(0), arg(1));
    case operation::difference:
      return field_.sum(arg(0), arg(1), -1);
    case operation::product:
      return field_.product(arg(0), arg(1));
    case operation::fma:
      return field_.sum(field_.product(arg(0), arg(1)), arg(2));
    case operation::quotient:
      return field_.product(arg(0), inverse(arg(1), result));
    case operation::power: {
      const fraction base = n.index < 0 ? inverse(arg(0), result) : arg(0);
      fraction product = one();
      for (int k = 0; k < std::abs(n.index); ++k) {
        product = field_.product(product, base);
      }
      return product;
    }
    case operation::sqrt:
      require(result, kind::not_negative, arg(0));
      return root(arg(0), 2);
    case operation::cbrt:
      return root(arg(0), 3);
    case operation::exp:
      return exponential(arg(0));
    case operation::expm1:
      return field_.sum(exponential(arg(0)), one(), -1);
    case operation::log:
      if (const polynomial* square = square_of_root(arg(0))) {
        require(result, kind::positive, {*square});
      } else {
        require(result, kind::positive, arg(0));
      }
      return logarithm(arg(0));
    case operation::log1p: {
      const fraction y = field_.sum(one(), arg(0));
      require(result, kind::positive, y);
      return logarithm(y);
    }
    case operation::sin:
      return cosine_and_sine(arg(0)).second;
    case operation::cos:
      return cosine_and_sine(arg(0)).first;
    case operation::tan: {
      const auto [cosine, sine] = cosine_and_sine(arg(0));
      return field_.product(sine, inverse(cosine, result));
    }
    case operation::sinh:
    case operation::cosh: {
      const fraction e = exponential(arg(0)), other = exponential(negated(arg(0)));
      return field_.product(fraction_field::constant(rational(1, 2)),
                            field_.sum(e, other, n.what == operation::sinh ? -1 : 1));
    }
    case operation::tanh: {
      const fraction e = exponential(arg(0)), other = exponential(negated(arg(0)));
      return field_.product(field_.sum(e, other, -1), inverse(field_.sum(e, other), result));
    }
    case operation::hypot:
      return root(field_.sum(field_.product(arg(0), arg(0)), field_.product(arg(1), arg(1))), 2);
    case operation::abs: {
      const fraction f = opaque("abs", arg(0), 2);
      atom& info = field_.ring[f.above.begin()->first[0].first];
      if (arg(0).below.empty()) {
        info.degree = 2;
        info.relation = field_.ring.product(arg(0).above, arg(0).above);
      }
      return f;
    }
    case operation::erfc:
      return field_.sum(one(), opaque("erf", arg(0), 1), -1);
    case operation::stumpff:
      return stumpff_function(arg(0), n.index);
    case operation::arc_ratio:
      return arc_ratio_of(arg(0), arg(1), result);
    case operation::atan2: { // atan2(√s, w) is √s times the ratio of the arc to it
      const polynomial& y = arg(0).above;
      const bool is_single = arg(0).below.empty() && y.size() == 1 && y.begin()->second > 0;
      if (is_single && y.begin()->first.size() == 1 && root_in(y.begin()->first) >= 0) {
        return field_.product(arg(0), arc_ratio_of(field_.product(arg(0), arg(0)), arg(1), result));
      }
      break;
    }
    case operation::asin:
    case operation::atanh:
      require_other(result, std::string(function_name_of(n.what)) + field_.text(arg(0)));
      return opaque(std::string(function_name_of(n.what)), arg(0), 1);
    case operation::atan:
    case operation::asinh:
    case operation::erf:
      return opaque(std::string(function_name_of(n.what)), arg(0), 1);
    default:
      break;
    }
    std::string text(function_name_of(n.what));
    text += std::to_string(n.index);
    for (int k = 0; k < operand_count(n.what); ++k) {
      text += "(" + field_.text(arg(std::size_t(k))) + ")";
    }
    require_other(result, text);
    return atom_of(text);
  }

  /// atan2(√s, w)/√s, which has a value where s does not vanish, and elsewhere for w > 0.
  [[nodiscard]] fraction arc_ratio_of(const fraction& s, const fraction& w, value& result) {
    const std::string text = "arc_ratio(" + field_.text(s) + ")(" + field_.text(w) + ")";
    require_other(result, text, s.below.empty() ? s.above : polynomial());
    fraction f = atom_of(text);
    const int a = f.above.begin()->first[0].first;
    field_.ring[a].is_positive = true;
    if (!s.above.empty() && s.below.empty() && w.below.empty() && field_.ring.is_regular(s.above)) {
      arcs_.emplace(a, std::pair(s, w));
    }
    return f;
  }
  [[nodiscard]] fraction inverse(const fraction& x, value& result) {
    if (x.above.empty()) {
      return atom_of("1/0");
    }
    if (is_implicit(x)) {
      require_other(result, "1/" + field_.text(x));
      return atom_of("1/" + field_.text(x));
    }
    require(result, kind::nonzero, x);
    return field_.reciprocal(x);
  }
  /// p of √p, otherwise null.
  [[nodiscard]] const polynomial* square_of_root(const fraction& x) const {
    const bool is_atom = x.below.empty() && x.above.size() == 1 && x.above.begin()->second == 1 &&
                         x.above.begin()->first.size() == 1;
    const int root = is_atom ? root_in(x.above.begin()->first) : -1;
    return root < 0 ? nullptr : &field_.ring[root].relation;
  }
  /// log x, of a square root half that of its square.
  [[nodiscard]] fraction logarithm(const fraction& x) {
    if (const polynomial* square = square_of_root(x)) {
      return field_.product(fraction_field::constant(rational(1, 2)), logarithm({*square}));
    }
    fraction f = opaque("log", x);
    if (!x.above.empty() && !is_implicit(x)) {
      logs_.emplace(f.above.begin()->first[0].first, x);
    }
    return f;
  }

  const assumptions& known_;
  std::map<std::string, rational>& bases_;
  std::map<std::string, int>& stumpff_;
  fraction_field field_;
  std::vector<value_condition> conditions_;
  std::set<int> nonzero_;
  std::set<int> implicit_;       ///< divisors that may vanish where values exist
  std::map<int, fraction> logs_; ///< x of the atoms of log x
  std::map<int, std::pair<fraction, fraction>> arcs_; ///< s and w of the atoms of arc_ratio(s, w)
  std::vector<polynomial> nonzero_polynomials_;
  bool must_repeat_ = false;
};

} // namespace detail
} // namespace duet::expression
