// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Exact algebra of fractions of polynomials in variables and functions of them, with relations as
/// sin² + cos² = 1. For those who extend duet.

namespace duet::expression::detail {

using rational = boost::multiprecision::cpp_rational;

/// A product of atoms: pairs of an atom and its exponent, which is not 0, by atoms.
using monomial = std::vector<std::pair<int, int>>;
/// Terms with their coefficients, which are not 0.
using polynomial = std::map<monomial, rational>;

/// An indeterminate: a variable, or a function of polynomials.
struct atom {
  std::string name;         ///< the same for equal functions of equal arguments
  bool is_positive = false; ///< wherever it has a value
  int degree = 0;           ///< of a relation x^degree = `relation`; 0 without
  polynomial relation = {}; ///< x^degree
};

/// Polynomials in atoms.
class polynomial_ring {
public:
  /// Bound on the pairs of terms of a product; beyond it results are meaningless.
  static constexpr std::size_t max_terms = 40000;
  /// Bound on the characters of a text.
  static constexpr std::size_t max_text = 10'000'000;

  [[nodiscard]] int find_atom(const std::string& name) {
    const auto [entry, is_new] = numbers_.emplace(name, int(atoms_.size()));
    if (is_new) {
      atoms_.push_back({name});
    }
    return entry->second;
  }
  [[nodiscard]] atom& operator[](int i) { return atoms_[std::size_t(i)]; }
  [[nodiscard]] const atom& operator[](int i) const { return atoms_[std::size_t(i)]; }

  [[nodiscard]] static polynomial constant(const rational& x) {
    polynomial p;
    if (x != 0) {
      p.emplace(monomial(), x);
    }
    return p;
  }
  [[nodiscard]] static polynomial power_of(int i, int exponent) {
    return {{monomial{{i, exponent}}, rational(1)}};
  }
  static void add(polynomial& sum, const polynomial& p, const rational& factor = 1) {
    for (const auto& [m, c] : p) {
      add_term(sum, m, rational(c * factor));
    }
  }
  [[nodiscard]] polynomial product(const polynomial& a, const polynomial& b) {
    is_too_large_ = is_too_large_ || a.size() * b.size() > max_terms;
    if (is_too_large_) {
      return {};
    }
    polynomial result;
    for (const auto& [m, c] : a) {
      for (const auto& [n, d] : b) {
        add_reduced(result, product_of(m, n), rational(c * d));
      }
    }
    return result;
  }
  [[nodiscard]] static monomial product_of(const monomial& a, const monomial& b) {
    monomial result;
    std::size_t i = 0, j = 0;
    while (i < a.size() || j < b.size()) {
      if (j == b.size() || (i < a.size() && a[i].first < b[j].first)) {
        result.push_back(a[i++]);
      } else if (i == a.size() || b[j].first < a[i].first) {
        result.push_back(b[j++]);
      } else {
        if (a[i].second + b[j].second != 0) {
          result.emplace_back(a[i].first, a[i].second + b[j].second);
        }
        ++i;
        ++j;
      }
    }
    return result;
  }

  /// m^n of |n| > 0
  [[nodiscard]] static monomial power_of(monomial m, int n) {
    for (auto& [i, exponent] : m) {
      exponent *= n;
    }
    return m;
  }
  /// The powers of atoms that all terms share.
  [[nodiscard]] static monomial common_factor(const polynomial& p) {
    monomial common = p.begin()->first;
    for (const auto& [m, c] : p) {
      monomial shared;
      for (const auto& [i, exponent] : common) {
        const auto found =
            std::find_if(m.begin(), m.end(), [i = i](const auto& x) { return x.first == i; });
        if (found != m.end() && (exponent > 0) == (found->second > 0)) {
          shared.emplace_back(i, exponent > 0 ? std::min(exponent, found->second)
                                              : std::max(exponent, found->second));
        }
      }
      common = shared;
    }
    return common;
  }

  /// True if a product or text exceeded its bound.
  [[nodiscard]] bool is_too_large() const { return is_too_large_; }

  /// True if surely no other polynomial times p is 0, so that identities of continuous functions
  /// hold where p vanishes as well: its norm over atoms without relations is not 0 at one point.
  [[nodiscard]] bool is_regular(const polynomial& p) const {
    polynomial norm = at_point(p);
    for (int i = int(atoms_.size()) - 1; i >= 0; --i) { // relations are of earlier atoms
      const atom& x = (*this)[i];
      polynomial rest, factor; // of norm = rest + factor x
      for (const auto& [m, c] : norm) {
        const auto found =
            std::find_if(m.begin(), m.end(), [i](const auto& y) { return y.first == i; });
        if (found != m.end() && found->second != 1) {
          return false;
        }
        add_term(found == m.end() ? rest : factor,
                 found == m.end() ? m : product_of(m, {{i, -found->second}}), c);
      }
      if (factor.empty()) {
        continue;
      }
      if (x.degree != 2) {
        return false;
      }
      polynomial square, product;
      add_product(square, factor, factor, 1);
      add_product(product, rest, rest, 1);
      add_product(product, square, x.relation, -1);
      norm = at_point(product);
    }
    return !norm.empty();
  }
  /// a/b if b divides a without remainder and without the relations of atoms.
  [[nodiscard]] std::optional<polynomial> quotient(polynomial a, const polynomial& b) const {
    polynomial result;
    const auto leading = largest(b);
    const std::size_t max_size = 4 * a.size() + 64;
    while (!a.empty()) {
      if (a.size() > max_size) {
        return std::nullopt;
      }
      const auto& [m, c] = *largest(a);
      const monomial factor = product_of(m, power_of(leading->first, -1));
      if (std::any_of(factor.begin(), factor.end(), [](const auto& x) { return x.second < 0; })) {
        return std::nullopt;
      }
      const rational ratio = c / leading->second;
      add_term(result, factor, ratio);
      for (const auto& [n, d] : b) {
        add_term(a, product_of(factor, n), rational(-ratio * d));
      }
    }
    return result;
  }

  /// A text that equal polynomials of all rings have in common.
  [[nodiscard]] std::string text(const monomial& m) const {
    std::string result;
    for (const auto& [i, exponent] : m) {
      result += "<" + (*this)[i].name + ">^" + std::to_string(exponent);
    }
    return result;
  }
  /// Empty beyond a bound, as texts of functions contain those of their arguments.
  [[nodiscard]] std::string text(const polynomial& p) const {
    std::vector<std::string> terms;
    std::size_t size = 0;
    for (const auto& [m, c] : p) {
      terms.push_back(c.str() + text(m));
      size += terms.back().size();
      is_too_large_ = is_too_large_ || size > max_text;
      if (is_too_large_) {
        return "";
      }
    }
    std::sort(terms.begin(), terms.end());
    std::string result;
    for (const std::string& term : terms) {
      result += (result.empty() ? "" : "+") + term;
    }
    return "{" + result + "}";
  }

  /// 1 or −1 if p is surely positive or negative wherever its atoms have values, otherwise 0.
  /// Terms are positive in which all atoms are, or have even exponents; `strictly` says that at
  /// least one of them cannot vanish.
  [[nodiscard]] int sign_of(const polynomial& p, bool strictly = true) const {
    int sign = 0;
    bool is_strict = !strictly;
    for (const auto& [m, c] : p) {
      bool cannot_vanish = true;
      for (const auto& [i, exponent] : m) {
        const bool is_positive = (*this)[i].is_positive;
        if (!is_positive && exponent % 2 != 0) {
          return 0;
        }
        cannot_vanish = cannot_vanish && is_positive;
      }
      const int of_term = c > 0 ? 1 : -1;
      if (sign == -of_term) {
        return 0;
      }
      sign = of_term;
      is_strict = is_strict || cannot_vanish;
    }
    return is_strict ? sign : 0;
  }

private:
  /// The polynomial of atoms with relations at values of the other ones.
  [[nodiscard]] polynomial at_point(const polynomial& p) const {
    polynomial result;
    for (const auto& [m, c] : p) {
      monomial rest;
      rational value = c;
      for (const auto& [i, exponent] : m) {
        if ((*this)[i].degree > 0) {
          rest.emplace_back(i, exponent);
          continue;
        }
        const rational x(7 * i % 31 + 2, 3 + i % 5);
        for (int k = 0; k < std::abs(exponent); ++k) {
          value = exponent > 0 ? rational(value * x) : rational(value / x);
        }
      }
      add_term(result, rest, value);
    }
    return result;
  }
  void add_product(polynomial& sum, const polynomial& a, const polynomial& b, int sign) const {
    for (const auto& [m, c] : a) {
      for (const auto& [n, d] : b) {
        add_reduced(sum, product_of(m, n), rational(sign * c * d));
      }
    }
  }
  /// The largest term in an order that products keep: by the exponents of atoms, first ones first.
  [[nodiscard]] static polynomial::const_iterator largest(const polynomial& p) {
    return std::max_element(p.begin(), p.end(), [](const auto& x, const auto& y) {
      const monomial &a = x.first, &b = y.first;
      for (std::size_t k = 0;; ++k) {
        if (k == a.size() || k == b.size()) {
          return k == a.size() ? k < b.size() && b[k].second > 0 : a[k].second < 0;
        }
        if (a[k] != b[k]) {
          return a[k].first == b[k].first  ? a[k].second < b[k].second
                 : a[k].first < b[k].first ? a[k].second < 0
                                           : b[k].second > 0;
        }
      }
    });
  }
  static void add_term(polynomial& sum, const monomial& m, const rational& c) {
    const auto [entry, is_new] = sum.emplace(m, c);
    if (!is_new) {
      entry->second += c;
    }
    if (entry->second == 0) {
      sum.erase(entry);
    }
  }
  /// Adds c m with powers of atoms replaced by their relations.
  void add_reduced(polynomial& sum, const monomial& m, const rational& c) const {
    for (std::size_t k = 0; k < m.size(); ++k) {
      const atom& x = (*this)[m[k].first];
      if (x.degree > 0 && m[k].second >= x.degree) {
        monomial rest = m;
        rest[k].second -= x.degree;
        if (rest[k].second == 0) {
          rest.erase(rest.begin() + std::ptrdiff_t(k));
        }
        for (const auto& [n, d] : x.relation) {
          add_reduced(sum, product_of(rest, n), rational(c * d));
        }
        return;
      }
    }
    add_term(sum, m, c);
  }

  std::vector<atom> atoms_;
  std::map<std::string, int> numbers_;
  mutable bool is_too_large_ = false; ///< set by `text`, too
};

/// A fraction: a polynomial over a product of powers of known divisors.
struct fraction {
  polynomial above;
  std::map<int, int> below = {}; ///< exponents of divisors, > 0
};

/// Fractions over a ring, with divisors in factored form.
class fraction_field {
public:
  polynomial_ring ring;

  [[nodiscard]] static fraction constant(const rational& x) {
    return {polynomial_ring::constant(x)};
  }
  [[nodiscard]] fraction sum(const fraction& a, const fraction& b, int sign = 1) {
    fraction result;
    result.below = a.below;
    for (const auto& [divisor, exponent] : b.below) {
      int& common = result.below[divisor];
      common = std::max(common, exponent);
    }
    result.above = scaled_to(a, result.below);
    polynomial_ring::add(result.above, scaled_to(b, result.below), sign);
    return reduced(result);
  }
  [[nodiscard]] fraction product(const fraction& a, const fraction& b) {
    fraction result{ring.product(a.above, b.above), a.below};
    for (const auto& [divisor, exponent] : b.below) {
      result.below[divisor] += exponent;
    }
    return reduced(result);
  }
  /// 1/a of what is not the constant 0.
  [[nodiscard]] fraction reciprocal(const fraction& a) {
    fraction result = constant(1);
    for (const auto& [divisor, exponent] : a.below) {
      for (int k = 0; k < exponent; ++k) {
        result.above = ring.product(result.above, divisors_[std::size_t(divisor)]);
      }
    }
    // common atoms are divisors of their own
    const monomial common = polynomial_ring::common_factor(a.above);
    const monomial inverse = polynomial_ring::power_of(common, -1);
    polynomial rest;
    const rational leading = a.above.begin()->second;
    for (const auto& [m, c] : a.above) {
      rest.emplace(polynomial_ring::product_of(m, inverse), rational(c / leading));
    }
    for (auto& [m, c] : result.above) {
      c /= leading;
    }
    for (const auto& [i, exponent] : common) {
      if (exponent > 0) {
        result.below[divisor_of(polynomial_ring::power_of(i, 1))] += exponent;
      } else { // of an exponential, whose reciprocal is one
        result.above = ring.product(result.above, polynomial_ring::power_of(i, -exponent));
      }
    }
    if (rest.size() > 1) {
      result.below[divisor_of(rest)] += 1;
    }
    return reduced(result);
  }
  [[nodiscard]] std::string text(const fraction& a) const {
    std::vector<std::string> factors;
    for (const auto& [divisor, exponent] : a.below) {
      factors.push_back(ring.text(divisors_[std::size_t(divisor)]) + "^" +
                        std::to_string(exponent));
    }
    std::sort(factors.begin(), factors.end());
    std::string result = ring.text(a.above);
    for (const std::string& factor : factors) {
      result += "/" + factor;
    }
    return result;
  }
  [[nodiscard]] const polynomial& divisor(int i) const { return divisors_[std::size_t(i)]; }

private:
  [[nodiscard]] int divisor_of(const polynomial& p) {
    for (std::size_t i = 0; i < divisors_.size(); ++i) {
      if (divisors_[i] == p) {
        return int(i);
      }
    }
    divisors_.push_back(p);
    return int(divisors_.size()) - 1;
  }
  [[nodiscard]] polynomial scaled_to(const fraction& a, const std::map<int, int>& below) {
    polynomial result = a.above;
    for (const auto& [divisor, exponent] : below) {
      const auto own = a.below.find(divisor);
      for (int k = own == a.below.end() ? 0 : own->second; k < exponent; ++k) {
        result = ring.product(result, divisors_[std::size_t(divisor)]);
      }
    }
    return result;
  }
  /// Without divisors that divide what is above.
  [[nodiscard]] fraction reduced(fraction a) const {
    if (a.above.empty()) {
      return {};
    }
    for (auto each = a.below.begin(); each != a.below.end();) {
      const polynomial& p = divisors_[std::size_t(each->first)];
      while (each->second > 0 && divide(a.above, p)) {
        --each->second;
      }
      each = each->second == 0 ? a.below.erase(each) : std::next(each);
    }
    return a;
  }
  [[nodiscard]] bool divide(polynomial& a, const polynomial& b) const {
    if (b.size() == 1) {
      return divide(a, b.begin()->first[0].first);
    }
    if (auto result = ring.quotient(a, b)) {
      a = std::move(*result);
      return true;
    }
    return false;
  }
  /// Divides all terms by an atom if it is in all of them.
  [[nodiscard]] static bool divide(polynomial& p, int i) {
    polynomial result;
    for (const auto& [m, c] : p) {
      const auto found =
          std::find_if(m.begin(), m.end(), [i](const auto& x) { return x.first == i; });
      if (found == m.end() || found->second < 1) {
        return false;
      }
      result.emplace(polynomial_ring::product_of(m, {{i, -1}}), c);
    }
    p = std::move(result);
    return true;
  }

  std::vector<polynomial> divisors_;
};

} // namespace duet::expression::detail
