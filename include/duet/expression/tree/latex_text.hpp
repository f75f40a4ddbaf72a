// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

/// \file
/// Sums of products of powers, and their LaTeX. For those who extend duet.

namespace duet::expression {

/// Precedence of the outermost operation of a formula, lowest first. In LaTeX a fraction with a
/// slash ranks as `negative_number`: as factors, both take parentheses.
enum class precedence { condition, sum, negative_number, product, power, atom };

/// Order of the factors of a product in LaTeX. Those that do not commute, `in_order`, come last and
/// keep their order.
enum class factor_order { number, pi, symbol, function, in_order };

namespace detail {

struct latex_term;

/// Factor base^(halves/2) of a product.
struct latex_factor {
  std::string text; ///< text of the base, with slashes; equal texts mean equal bases
  precedence outermost;
  factor_order order;
  std::size_t name_end;              ///< length of f in f(x), where f^2(x) has its exponent; else 0
  std::vector<latex_term> terms;     ///< terms of a base that is a sum or a product
  std::vector<latex_term> logarithm; ///< terms of x of a base e^x
  int halves;
};

/// Product of the number above/below, below > 0, and factors. Those with negative exponents are
/// written in the denominator.
struct latex_term {
  std::int64_t above = 1, below = 1;
  std::vector<latex_factor> factors = {};  ///< factors that commute, in order of appearance
  std::vector<latex_factor> in_order = {}; ///< factors that do not commute
};

/// Text and its precedence outside all parentheses.
struct latex_part {
  std::string text;
  precedence outermost;

  [[nodiscard]] std::string inside(precedence beside) const {
    return outermost < beside ? "\\left(" + text + "\\right)" : text;
  }
};

/// Style of fractions: lines, or slashes in exponents, arguments and other fractions.
enum class fractions { lines, slashes };

[[nodiscard]] inline latex_part latex_text(const std::vector<latex_term>& sum, fractions style);

[[nodiscard]] inline latex_part latex_text(const latex_factor& f, fractions style) {
  if (!f.logarithm.empty() && f.halves != 2) { // (e^x)^2 is e^(2x)
    std::vector<latex_term> exponent = f.logarithm;
    for (latex_term& t : exponent) {
      const std::int64_t common = std::gcd(t.above * f.halves, t.below * 2);
      t.above = t.above * f.halves / common;
      t.below = t.below * 2 / common;
    }
    return {"e^{" + latex_text(exponent, fractions::slashes).text + "}", precedence::power};
  }
  const bool is_root = f.halves % 2 != 0;
  if (f.halves == 1) {
    return {"\\sqrt{" + f.text + "}", precedence::atom};
  }
  const bool is_plain = f.terms.empty() || is_root || style == fractions::slashes;
  const latex_part base = {is_plain ? f.text : latex_text(f.terms, style).text, f.outermost};
  if (f.halves == 2) {
    return base;
  }
  const std::string exponent =
      "^{" + (is_root ? std::to_string(f.halves) + "/2" : std::to_string(f.halves / 2)) + "}";
  if (f.name_end > 0) {
    return {std::string(f.text).insert(f.name_end, exponent), precedence::power};
  }
  return {base.inside(precedence::atom) + exponent, precedence::power};
}

/// Text of a number times factors with positive exponents.
[[nodiscard]] inline latex_part
latex_text(std::int64_t number, const std::vector<latex_factor>& factors, fractions style) {
  if (factors.empty()) {
    return {std::to_string(number), precedence::atom};
  }
  if (number == 1 && factors.size() == 1) {
    return latex_text(factors[0], style);
  }
  std::string text = number == 1 ? "" : std::to_string(number);
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const latex_factor& f = factors[k];
    // As the last factor, a · b and x^T A x need no parentheses; numbers such as 2 · 10^5 never do.
    const bool is_last =
        k + 1 == factors.size() && (k == 0 || factors[k - 1].order != factor_order::in_order);
    const bool is_number = f.order == factor_order::number && f.halves == 2;
    const std::string piece =
        latex_text(f, style).inside(is_last || is_number ? precedence::product : precedence::power);
    const bool is_digit = piece[0] >= '0' && piece[0] <= '9';
    text += (text.empty() ? "" : is_digit ? " \\cdot " : " ") + piece;
  }
  return {text, precedence::product};
}

/// Text of |t|.
[[nodiscard]] inline latex_part latex_text(const latex_term& t, fractions style) {
  std::vector<latex_factor> above, below;
  for (const factor_order order :
       {factor_order::number, factor_order::pi, factor_order::symbol, factor_order::function}) {
    for (latex_factor f : t.factors) {
      // Roots of symbols are written among functions.
      const bool is_behind = f.halves % 2 != 0 && f.order == factor_order::symbol;
      if ((is_behind ? factor_order::function : f.order) == order) {
        const bool is_below = f.halves < 0;
        f.halves = is_below ? -f.halves : f.halves;
        (is_below ? below : above).push_back(f);
      }
    }
  }

  const std::int64_t number = t.above < 0 ? -t.above : t.above;
  const bool is_fraction = t.below != 1 || !below.empty();
  const bool is_one_above = number == 1 && above.empty() && t.in_order.size() == 1;
  const bool is_joined =
      !is_fraction || style == fractions::slashes || t.in_order.empty() ||
      (is_one_above && latex_text(1, t.in_order, style).text.find("\\frac") == std::string::npos);
  for (const latex_factor& f : t.in_order) {
    if (is_joined) {
      above.push_back(f);
    }
  }
  if (!is_fraction) {
    return latex_text(number, above, style);
  }
  const latex_part top = latex_text(number, above, fractions::slashes);
  const latex_part bottom = latex_text(t.below, below, fractions::slashes);
  if (style == fractions::slashes) {
    return {top.inside(precedence::product) + "/" + bottom.inside(precedence::power),
            precedence::negative_number};
  }
  const std::string fraction = "\\frac{" + top.text + "}{" + bottom.text + "}";
  return {is_joined ? fraction
                    : fraction + " " + latex_text(1, t.in_order, style).inside(precedence::product),
          precedence::product};
}

[[nodiscard]] inline latex_part latex_text(const std::vector<latex_term>& sum, fractions style) {
  std::string text;
  for (const latex_term& t : sum) {
    const char* minus = text.empty() ? "-" : " - ";
    const char* plus = text.empty() ? "" : " + ";
    const latex_part part = latex_text(t, style);
    if (sum.size() == 1 && t.above >= 0) {
      return part;
    }
    text += (t.above < 0 ? minus : plus) + part.inside(precedence::negative_number);
  }
  return {text, precedence::sum};
}

} // namespace detail
} // namespace duet::expression
