// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/number_text.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/printed.hpp>
#include <duet/expression/tree/written.hpp>

#include <array>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

/// \file
/// Formulas as text and as LaTeX.

namespace duet::expression {

namespace detail {

/// A number, with ×10^n in LaTeX.
[[nodiscard]] inline printed printed_number(notation style, std::string digits) {
  const std::size_t e = digits.find('e');
  const auto negative = precedence::negative_number;
  const bool is_negative = digits[0] == '-';
  if (style == notation::latex && e != std::string::npos) {
    const std::size_t exponent = digits.find_first_not_of("+0", e + 1);
    const std::string factor = digits.substr(0, e);
    digits = (factor == "1" ? "" : factor + " \\cdot ") + "10^{" +
             (digits[e + 1] == '-' ? "-" + digits.substr(digits.find_first_not_of("-0", e + 1))
                                   : digits.substr(exponent)) +
             "}";
    return {digits, is_negative ? negative : precedence::product, style};
  }
  return {digits, is_negative ? negative : precedence::atom, style};
}

/// Greek letters by their names, what follows the letters as an index, columns with an
/// arrow.
[[nodiscard]] inline std::string latex_name(const std::string& name, kind k) {
  static constexpr std::array greek = {
      "alpha",   "beta",   "gamma", "delta", "epsilon", "zeta",  "eta",   "theta", "iota",
      "kappa",   "lambda", "mu",    "nu",    "xi",      "pi",    "rho",   "sigma", "tau",
      "upsilon", "phi",    "chi",   "psi",   "omega",   "Gamma", "Delta", "Theta", "Lambda",
      "Xi",      "Pi",     "Sigma", "Phi",   "Psi",     "Omega"};
  const std::size_t end = name.find_first_of("_0123456789");
  std::string letters = name.substr(0, end);
  for (const char* letter : greek) {
    if (letters == letter) {
      letters = "\\" + letters;
    }
  }
  if (letters.size() > 1 && letters[0] != '\\') {
    letters = "\\mathrm{" + letters + "}";
  }
  if (is_matrix(k) && columns_of(k) == 1) {
    letters = "\\vec{" + letters + "}";
  }
  if (end == std::string::npos) {
    return letters;
  }
  return letters + "_{" + name.substr(name[end] == '_' ? end + 1 : end) + "}";
}

template <class T>
[[nodiscard]] printed printed_constant(notation style, const T& value) {
  if constexpr (std::floating_point<T>) {
    return printed_number(style, duet::to_text(value));
  } else if constexpr (is_sized_matrix(constant_traits<T>::kind_of)) {
    std::vector<std::string> entries;
    for (Eigen::Index i = 0; i < value.rows(); ++i) {
      for (Eigen::Index j = 0; j < value.cols(); ++j) {
        entries.push_back(printed_constant(style, value(i, j)).text);
      }
    }
    return printed_matrix(style, std::size_t(value.cols()), entries);
  } else {
    std::ostringstream text;
    if constexpr (requires { value.transpose(); }) {
      const Eigen::IOFormat row(Eigen::StreamPrecision, Eigen::DontAlignCols, ", ", ", ", "", "",
                                "(", ")");
      text << value.transpose().format(row);
    } else {
      text << value;
    }
    return {text.str(), precedence::atom, style};
  }
}

template <kind K, char... Letters>
[[nodiscard]] printed print(notation style, symbol_node<K, Letters...>, const auto&) {
  const std::string name = {Letters...};
  return {style == notation::latex ? latex_name(name, K) : name, precedence::atom, style};
}
template <kind K, class Tag>
[[nodiscard]] printed print(notation style, constant_node<K, Tag>, const auto& h) {
  return printed_constant(style, value_in<constant_node<K, Tag>>(h));
}
template <std::uint64_t Bits>
[[nodiscard]] printed print(notation style, number_node<Bits> n, const auto&) {
  return printed_number(style, duet::to_text(n.value));
}
[[nodiscard]] inline printed print(notation style, pi_node, const auto&) {
  return {style == notation::latex ? "\\pi" : "pi", precedence::atom, style};
}
template <kind K>
[[nodiscard]] printed print(notation style, zero_node<K>, const auto&) {
  return {"0", precedence::atom, style};
}
template <class Operation, class... Operands>
[[nodiscard]] printed print(notation style, applied_node<Operation, Operands...>, const auto& h) {
  printed result = printed_operation<Operation>(style, print(style, Operands{}, h)...);
  result.style = style;
  return result;
}

} // namespace detail

/// The formula as one writes it in a program: `2 * x * cos(x^2)`.
template <Formula F>
[[nodiscard]] std::string to_text(const F& f) {
  return detail::print(notation::text, detail::written_t<typename F::node_type>{}, f.held()).text;
}

/// The formula for a paper, to stand in mathematics mode: `2 \cdot x \cos\left(x^{2}\right)`.
/// Symbols with the names of Greek letters are those letters; digits, and what follows _, are an
/// index.
template <Formula F>
[[nodiscard]] std::string to_latex(const F& f) {
  return detail::print(notation::latex, detail::written_t<typename F::node_type>{}, f.held()).text;
}

} // namespace duet::expression
