// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/expression/tree/latex_terms.hpp>
#include <duet/expression/tree/latex_text.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

/// \file
/// Sums of fractions over a common denominator, so that no fraction contains another. For those who
/// extend duet.

namespace duet::expression::detail {

[[nodiscard]] inline bool is_fraction(const latex_term& t) {
  bool result = t.below != 1;
  for (const latex_factor& f : t.factors) {
    result = result || f.halves < 0;
  }
  return result;
}
/// True if the sum, or a sum among its factors that is not under a root, has a fraction.
[[nodiscard]] inline bool has_fraction(const latex_sum& sum) {
  bool result = false;
  for (const latex_term& t : sum) {
    result = result || is_fraction(t);
    for (const latex_factor& f : t.factors) {
      result = result || (f.halves % 2 == 0 && has_fraction(f.terms));
    }
  }
  return result;
}

/// True if all terms have a common factor in the denominator.
[[nodiscard]] inline bool has_common_denominator(const latex_sum& sum) {
  bool result = false;
  for (const latex_factor& f : sum[0].factors) {
    int largest = f.halves;
    for (const latex_term& t : sum) {
      largest = std::max(largest, halves_of(f, t));
    }
    result = result || largest < 0;
  }
  return result;
}

/// Greatest common factor of the terms of a sum without fractions, numbers included.
[[nodiscard]] inline latex_term common_factor(const latex_sum& sum) {
  latex_term common = whole_term(0);
  if (sum.empty()) {
    return common;
  }
  for (const latex_term& t : sum) {
    common.above = std::gcd(common.above, t.above);
  }
  for (latex_factor f : sum[0].factors) {
    for (const latex_term& t : sum) {
      f.halves = std::min(f.halves, halves_of(f, t));
    }
    if (f.halves > 0) {
      common.factors.push_back(f);
    }
  }
  return common;
}

[[nodiscard]] inline latex_term without_inner_fractions(const latex_term& t, bool is_inner);

/// A sum of scalars as one fraction, with the common factor of its numerator in front.
[[nodiscard]] inline latex_term over_common_denominator(const latex_sum& sum) {
  latex_sum terms;
  latex_term below;
  for (const latex_term& t : sum) {
    terms.push_back(without_inner_fractions(t, true));
    const latex_term& fraction = terms.back();
    below.above = std::lcm(below.above, fraction.below);
    if (below.above > largest_whole) {
      return as_product(sum);
    }
    for (latex_factor f : fraction.factors) {
      f.halves = -f.halves - halves_of(f, below); // power of f that the common denominator lacks
      if (f.halves > 0) {
        multiply(below, f);
      }
    }
  }
  latex_sum above;
  for (latex_term& t : terms) {
    multiply(t, below);
    add(above, t, true);
  }
  latex_term result = common_factor(above);
  const latex_term divisor = power(result, -1);
  latex_sum rest;
  for (latex_term& t : above) {
    multiply(t, divisor);
    add(rest, t, true);
  }
  if (rest.empty()) {
    return whole_term(0);
  }
  for (std::size_t k = 1; rest[0].above < 0 && k < rest.size(); ++k) {
    std::swap(rest[0], rest[k]); // b - a, not -a + b
  }
  if (rest[0].above < 0) {
    result.above = -result.above;
    for (latex_term& t : rest) {
      t.above = -t.above;
    }
  }
  multiply(result, as_product(rest));
  multiply(result, power(below, -1));
  return result;
}

/// t with each factor that is a sum of fractions brought over a common denominator, if t is a
/// fraction or inside of one, or if all terms of the sum share a denominator.
[[nodiscard]] inline latex_term without_inner_fractions(const latex_term& t, bool is_inner) {
  is_inner = is_inner || is_fraction(t);
  latex_term result = t;
  result.factors.clear();
  for (const latex_factor& f : t.factors) {
    if (f.halves % 2 == 0 && has_fraction(f.terms) &&
        (is_inner || has_common_denominator(f.terms))) {
      multiply(result, power(over_common_denominator(f.terms), f.halves / 2));
    } else {
      multiply(result, f);
    }
  }
  return result;
}

} // namespace duet::expression::detail
