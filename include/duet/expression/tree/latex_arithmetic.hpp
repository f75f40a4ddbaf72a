// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/tree/latex_fractions.hpp>
#include <duet/expression/tree/latex_terms.hpp>
#include <duet/expression/tree/latex_text.hpp>
#include <duet/expression/tree/printed.hpp>

#include <string>
#include <vector>

/// \file
/// LaTeX of sums, products, quotients and powers. For those who extend duet.

namespace duet::expression::detail {

[[nodiscard]] inline latex_sum latex_terms(const printed& p) {
  if (!p.terms.empty()) {
    return p.terms;
  }
  latex_factor f = {p.text, p.outermost, p.order, p.name_end, {}, {}, 2};
  int sign = 1;
  if (p.order == factor_order::number && p.text[0] == '-') {
    sign = -1;
    f.text.erase(0, 1);
    const bool has_power_of_ten = f.text.find('^') != std::string::npos;
    f.outermost = has_power_of_ten ? precedence::product : precedence::atom;
  }
  const bool is_whole = p.order == factor_order::number && f.text.size() < 10 &&
                        f.text.find_first_not_of("0123456789") == std::string::npos;
  latex_sum sum;
  sum.push_back(is_whole ? whole_term(std::stoi(f.text)) : product_of(f));
  sum[0].above *= sign;
  return sum;
}

[[nodiscard]] inline printed latex_printed(const latex_sum& sum) {
  if (sum.empty()) {
    return {"0", precedence::atom, notation::latex, factor_order::number, 0, {}};
  }
  const latex_part part = latex_text(sum, fractions::slashes);
  return {part.text, part.outermost, notation::latex, factor_order::function, 0, sum};
}
[[nodiscard]] inline printed latex_printed(const latex_term& t) {
  latex_sum sum;
  add(sum, without_inner_fractions(t, false));
  return latex_printed(sum);
}

/// a + sign b
[[nodiscard]] inline printed latex_sum_of(const printed& a, int sign, const printed& b) {
  latex_sum sum;
  for (const latex_term& t : latex_terms(a)) {
    add(sum, t);
  }
  for (latex_term t : latex_terms(b)) {
    t.above *= sign;
    add(sum, t);
  }
  return latex_printed(sum);
}

/// a b^n
[[nodiscard]] inline printed latex_product_of(const printed& a, const printed& b, int n = 1) {
  latex_term t = as_product(latex_terms(a));
  const latex_term factor = as_product(latex_terms(b));
  multiply(t, n == 1 ? factor : power(factor, n));
  return latex_printed(t);
}

/// Bilinear product of vectors, such as a · b, with their scalar factors in front.
[[nodiscard]] inline printed latex_bilinear(const printed& a, const char* sign, const printed& b,
                                            precedence beside, factor_order order) {
  latex_term t = as_product(latex_terms(a));
  latex_term u = as_product(latex_terms(b));
  const auto vector = [&](const latex_term& v) {
    return latex_text(1, v.in_order, fractions::slashes).inside(beside);
  };
  const latex_factor f = {vector(t) + sign + vector(u), precedence::product, order, 0, {}, {}, 2};
  t.in_order.clear();
  u.in_order.clear();
  multiply(t, u);
  multiply(t, product_of(f));
  return latex_printed(t);
}

/// √x
[[nodiscard]] inline printed latex_root(const printed& x) {
  const latex_sum sum = latex_terms(x);
  latex_term t = as_product(sum);
  if (t.above == 1 && t.below == 1 && t.factors.size() == 1 && t.factors[0].halves == 2) {
    t.factors[0].halves = 1;
  } else {
    t = product_of({x.text, x.outermost, factor_order::function, 0, sum, {}, 1});
  }
  return latex_printed(t);
}

/// e^x
[[nodiscard]] inline printed latex_exponential(const printed& x) {
  const std::string text = "e^{" + x.text + "}";
  return latex_printed(
      product_of({text, precedence::power, factor_order::function, 0, {}, latex_terms(x), 2}));
}

/// x^p
[[nodiscard]] inline printed latex_power(const printed& x, const printed& p) {
  const latex_sum exponent = latex_terms(p);
  const latex_term base = as_product(latex_terms(x));
  const latex_term& n = exponent[0];
  const bool is_whole = exponent.size() == 1 && n.below == 1 && n.factors.empty();
  if (is_whole && base.in_order.empty() && -99 <= n.above && n.above <= 99) {
    return latex_printed(power(base, int(n.above)));
  }
  return {x.inside(precedence::atom) + "^{" + p.text + "}",
          precedence::power,
          notation::latex,
          factor_order::symbol,
          0,
          {}};
}

/// Result of an operation as an operand of others. A scalar is a factor that commutes, even if it
/// is composed of factors that do not, such as x^T A x.
[[nodiscard]] inline printed latex_of_kind(printed p, bool is_scalar) {
  p.style = notation::latex;
  if (p.terms.empty() && !is_scalar) {
    p.order = factor_order::in_order;
  }
  for (latex_term& t : p.terms) {
    if (is_scalar && !t.in_order.empty()) {
      const latex_part part = latex_text(1, t.in_order, fractions::slashes);
      t.in_order.clear();
      multiply(t, product_of({part.text, part.outermost, factor_order::function, 0, {}, {}, 2}));
    }
  }
  return p;
}

} // namespace duet::expression::detail
