// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/expression/tree/latex_text.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

/// \file
/// Arithmetic of sums of products: equal factors become powers, terms with equal factors are
/// collected. For those who extend duet.

namespace duet::expression::detail {

using latex_sum = std::vector<latex_term>;

/// Largest numerator and denominator of a term: a sum of two products of such numbers does not
/// overflow. Larger integers become factors.
inline constexpr std::int64_t largest_whole = std::int64_t(1) << 30;

/// Multiplies t by above/below, below > 0.
///
/// \return false, with t unchanged, if numerator or denominator would exceed `largest_whole`
[[nodiscard]] inline bool scale_if_small(latex_term& t, std::int64_t above, std::int64_t below) {
  above *= t.above;
  below *= t.below;
  const std::int64_t common = std::gcd(above, below);
  if (std::max({above, -above, below}) / common > largest_whole) {
    return false;
  }
  t.above = above / common;
  t.below = below / common;
  return true;
}

[[nodiscard]] inline latex_factor number_factor(const std::string& digits, int halves) {
  return {digits, precedence::atom, factor_order::number, 0, {}, {}, halves};
}

[[nodiscard]] inline latex_term whole_term(std::int64_t n) {
  latex_term t;
  t.above = n;
  return t;
}
/// Product of one factor.
[[nodiscard]] inline latex_term product_of(const latex_factor& f) {
  latex_term t;
  (f.order == factor_order::in_order ? t.in_order : t.factors).push_back(f);
  return t;
}

[[nodiscard]] inline int sign_of_ratio(const latex_factor& f, const latex_factor& g);

/// Twice the exponent that the base of f has in t; 0 if it does not occur.
[[nodiscard]] inline int halves_of(const latex_factor& f, const latex_term& t) {
  for (const latex_factor& g : t.factors) {
    const int sign = sign_of_ratio(f, g);
    if (sign == 1 || (sign == -1 && f.halves % 4 == 0)) { // (x - y)^2 = (y - x)^2
      return g.halves;
    }
  }
  return 0;
}

/// True if the terms are equal except for their numbers.
[[nodiscard]] inline bool has_same_factors(const latex_term& a, const latex_term& b) {
  bool same = a.factors.size() == b.factors.size() && a.in_order.size() == b.in_order.size();
  for (const latex_factor& f : a.factors) {
    same = same && halves_of(f, b) == f.halves;
  }
  for (std::size_t k = 0; same && k < a.in_order.size(); ++k) {
    same = a.in_order[k].text == b.in_order[k].text;
  }
  return same;
}

/// The sign s if the bases are found to satisfy f = s g with s = ±1; otherwise 0.
[[nodiscard]] inline int sign_of_ratio(const latex_factor& f, const latex_factor& g) {
  if (f.text == g.text) {
    return 1;
  }
  int sign = 0;
  for (const latex_term& t : f.terms) {
    int sign_of_t = 0;
    for (const latex_term& u : g.terms) {
      if ((t.above == u.above || t.above == -u.above) && t.below == u.below &&
          has_same_factors(t, u)) {
        sign_of_t = t.above == u.above ? 1 : -1;
      }
    }
    if (sign_of_t == 0 || f.terms.size() != g.terms.size() || sign_of_t == -sign) {
      return 0;
    }
    sign = sign_of_t;
  }
  return sign;
}

[[nodiscard]] inline latex_term power(const latex_term& t, int n);
inline void multiply(latex_term& t, const latex_term& by);

/// Multiplies t by f.
inline void multiply(latex_term& t, const latex_factor& f) {
  if (f.text == "1") {
    return;
  }
  std::size_t k = 0;
  int sign = 0;
  for (; k < t.factors.size(); ++k) {
    sign = sign_of_ratio(f, t.factors[k]);
    if (sign == 1 || (sign == -1 && f.halves % 2 == 0)) {
      break;
    }
  }
  if (k == t.factors.size()) {
    t.factors.push_back(f);
  } else {
    t.factors[k].halves += f.halves;
    t.above *= sign < 0 && f.halves % 4 != 0 ? -1 : 1;
  }
  const latex_factor joined = t.factors[k];
  const bool is_product = joined.terms.size() == 1 && joined.halves % 2 == 0; // as √(x y)² = x y
  if (is_product || joined.halves == 0) {
    t.factors.erase(t.factors.begin() + std::ptrdiff_t(k));
  }
  if (is_product) {
    multiply(t, power(joined.terms[0], joined.halves / 2));
  }
}

/// Multiplies t by (above/below)^n.
inline void multiply(latex_term& t, std::int64_t above, std::int64_t below, int n = 1) {
  latex_term result;
  result.above = t.above;
  result.below = t.below;
  bool is_small = true;
  for (int k = 0; is_small && k < n; ++k) {
    is_small = scale_if_small(result, above, below);
  }
  if (is_small) {
    t.above = result.above;
    t.below = result.below;
    return;
  }
  t.above *= above < 0 && n % 2 != 0 ? -1 : 1;
  multiply(t, number_factor(std::to_string(above < 0 ? -above : above), 2 * n));
  multiply(t, number_factor(std::to_string(below), -2 * n));
}

/// Multiplies t by another term.
inline void multiply(latex_term& t, const latex_term& by) {
  multiply(t, by.above, by.below);
  if (t.above == 0) {
    t.factors.clear();
    t.in_order.clear();
    return;
  }
  for (const latex_factor& f : by.factors) {
    multiply(t, f);
  }
  for (const latex_factor& f : by.in_order) {
    t.in_order.push_back(f);
  }
}

/// t^n of a t whose factors commute; 1/0 remains a fraction.
[[nodiscard]] inline latex_term power(const latex_term& t, int n) {
  if (t.above == 0 && n < 0) {
    return product_of(number_factor("0", 2 * n));
  }
  latex_term result;
  if (n >= 0) {
    multiply(result, t.above, t.below, n);
  } else {
    const std::int64_t sign = t.above < 0 ? -1 : 1;
    multiply(result, sign * t.below, sign * t.above, -n);
  }
  for (latex_factor f : t.factors) {
    f.halves *= n;
    multiply(result, f);
  }
  return result;
}

/// A sum as a product: its term if it has one, otherwise the sum as a single factor.
[[nodiscard]] inline latex_term as_product(const latex_sum& sum) {
  if (sum.size() == 1) {
    return sum[0];
  }
  const latex_part part = latex_text(sum, fractions::slashes);
  const factor_order order =
      sum[0].in_order.empty() ? factor_order::function : factor_order::in_order;
  return product_of({part.text, part.outermost, order, 0, sum, {}, 2});
}

/// The sum s if t is s times a number; otherwise null.
[[nodiscard]] inline const latex_sum* only_sum(const latex_term& t) {
  const bool is_one = t.below == 1 && t.factors.size() + t.in_order.size() == 1;
  const latex_factor* f = !is_one ? nullptr : &(t.factors.empty() ? t.in_order : t.factors)[0];
  return f != nullptr && f->terms.size() > 1 && f->halves == 2 ? &f->terms : nullptr;
}

/// Adds t to a sum, which is 0 if empty, and collects terms with equal factors. If t is s or −s of
/// a sum s, the terms of s are added; with `numbers`, also if t is another multiple of s.
inline void add(latex_sum& sum, const latex_term& t, bool numbers = false) {
  const latex_sum* inner = only_sum(t);
  if (inner != nullptr && (numbers || t.above == 1 || t.above == -1)) {
    for (latex_term u : *inner) {
      multiply(u, t.above, 1);
      add(sum, u, numbers);
    }
    return;
  }
  for (std::size_t k = 0; k < sum.size(); ++k) {
    latex_term& same = sum[k];
    latex_term number;
    if (has_same_factors(same, t) &&
        scale_if_small(number, same.above * t.below + t.above * same.below, same.below * t.below)) {
      same.above = number.above;
      same.below = number.below;
      if (number.above == 0) {
        sum.erase(sum.begin() + std::ptrdiff_t(k));
      }
      return;
    }
  }
  if (t.above != 0) {
    sum.push_back(t);
  }
}

} // namespace duet::expression::detail
