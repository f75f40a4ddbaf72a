// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/version.hpp>
#include <duet/dual/stumpff.hpp>
#include <duet/expression/graph/evaluate.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/graph.hpp>
#include <duet/expression/graph/graph_text.hpp>
#include <duet/expression/graph/recorded.hpp>
#include <duet/expression/tree/number.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Common parts of the emitters of C, C++, Python and MATLAB: names that compile everywhere, and
/// the statements of a formula in order. For those who extend duet.

namespace duet::expression {

/// Options of formulas as code.
struct code_options {
  /// First sentence of the function's comment; by default none.
  std::string description = {};
  /// `float` instead of `double`, in C and C++.
  bool is_single_precision = false;
  /// Matrices row by row (as C's arrays of arrays); otherwise column by column (as Eigen, Fortran).
  /// (C alone: other languages have matrices.)
  bool is_row_major = true;
  /// Sines and cosines of an angle together by duet's algorithm instead of the library's, in C and
  /// C++ of `double`: the same bits on every machine that does not fuse products with sums.
  bool has_own_sines = false;
};

namespace detail {

/// The decimal digits of x that make it again, with a point or an exponent.
template <class T>
[[nodiscard]] std::string number_literal(T x) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr;
  const std::string text(digits.data(), end);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

/// The decimal digits of x, or the names that a language has for NaN and infinity.
template <class T>
[[nodiscard]] std::string number_literal(T x, const char* nan, const std::string& infinity) {
  return std::isnan(x) ? nan : std::isinf(x) ? (x < 0 ? "-" : "") + infinity : number_literal(x);
}

/// Keywords of C, C++, Python, MATLAB and Octave, and names that their libraries take or that look
/// like numbers there.
[[nodiscard]] inline const std::set<std::string>& reserved_names() {
  static const std::set<std::string> names = [] {
    constexpr std::string_view words =
        "alignas alignof and and_eq as asm assert async atomic auto await bitand bitor bool "
        "break case catch char class classdef co_await co_return co_yield compl complex "
        "concept const consteval constexpr constinit continue decltype def default del delete "
        "do double dynamic_cast elif else elseif end end_try_catch endfor endfunction endif "
        "endswitch endwhile enum except explicit export extern false finally float for friend "
        "from function global goto if import imaginary in inline int is lambda long mutable "
        "namespace new noexcept nonlocal not not_eq nullptr operator or or_eq otherwise parfor "
        "pass persistent private protected public raise register reinterpret_cast requires "
        "restrict return short signed sizeof spmd static static_assert static_cast struct "
        "switch template this thread_local "
        "throw true try typedef typeid typename typeof union unsigned until unwind_protect "
        "using virtual void volatile wchar_t while with xor xor_eq yield None True False NAN "
        "INFINITY NaN nan inf Inf eps pi e i j I J np math ans main signgam y0 y1 yn j0 j1 jn "
        "gamma sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 "
        "expm1 log log2 log10 log1p logb sqrt cbrt pow hypot erf erfc tgamma lgamma abs fabs "
        "floor ceil trunc round rint fma fmod remainder remquo drem fmax fmin fdim frexp ldexp "
        "modf scalb significand isnan isinf isfinite signbit copysign div index time exit "
        "abort free malloc select std Eigen unix linux real imag numel size fix rem mod max "
        "min sum zeros reshape char8_t char16_t char32_t arguments enumeration events methods "
        "properties end_unwind_protect endparfor unwind_protect_cleanup endclassdef "
        "endenumeration endevents endmethods endproperties endspmd endarguments NA gammaln "
        "nthroot sign errno stdin stdout stderr NULL EOF BUFSIZ HUGE HUGE_VAL OVERFLOW "
        "UNDERFLOW DOMAIN SING PLOSS TLOSS near far error single i386 sincos exp10 pow10 "
        "nearbyint lrint llrint lround llround ilogb nextafter nexttoward scalbn scalbln "
        "finite lgamma_r isreal functools Fraction";
    std::set<std::string> result;
    for (std::size_t begin = 0; begin < words.size();) {
      const std::size_t end = std::min(words.find(' ', begin), words.size());
      result.emplace(words.substr(begin, end - begin));
      begin = end + 1;
    }
    return result;
  }();
  return names;
}

/// Letters, digits and underscores for a name: Greek letters and indices spelt out, other
/// characters by their codes.
[[nodiscard]] inline std::string plain_name(const std::string& name) {
  std::string result;
  for (const char letter : spelt_out(name)) {
    const bool is_digit = letter >= '0' && letter <= '9';
    const bool is_plain =
        (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || letter == '_';
    result += result.empty() && !is_plain ? "x" : "";
    if (is_plain || is_digit) {
      result += letter;
      continue;
    }
    constexpr const char* hexadecimal = "0123456789abcdef";
    const auto code = static_cast<unsigned char>(letter);
    result += hexadecimal[code / 16];
    result += hexadecimal[code % 16];
  }
  return result;
}

/// Names that differ from each other and from reserved ones.
class name_table {
public:
  /// The name, with underscores behind it as long as it is taken, and x before one that languages
  /// or helper functions reserve.
  std::string add(const std::string& name) {
    std::string result = plain_name(name);
    if (result.rfind('_', 0) == 0 || result.rfind("duet_", 0) == 0) {
      result.insert(0, "x");
    }
    while (reserved_names().count(result) > 0 || taken_.count(result) > 0) {
      result += "_";
    }
    taken_.insert(result);
    return result;
  }
  /// A prefix for numbered names, of which none is taken.
  [[nodiscard]] std::string prefix(std::string text) const {
    const auto is_taken = [&] {
      return std::any_of(taken_.begin(), taken_.end(), [&](const std::string& name) {
        return name.rfind(text, 0) == 0 && name.size() > text.size() &&
               name.find_first_not_of("0123456789", text.size()) == std::string::npos;
      });
    };
    while (is_taken()) {
      text += "_";
    }
    return text;
  }

private:
  std::set<std::string> taken_;
};

/// The formula with whole powers as products, and nothing that its outputs do not need.
[[nodiscard]] inline formula_graph without_powers(const formula_graph& f) {
  formula_graph result;
  for (const named_value& x : f.inputs()) {
    result.add_input(x);
  }
  graph& to = result.operations();
  const graph& from = f.operations();
  const std::vector<bool> needed = f.needed();
  std::vector<int> image(needed.size(), -1);
  const auto power = [](const recorded& x, int n) {
    return is_accurate_by_products(n) ? power_by_products(x, n)
                                      : recorded::of(operation::pow, x, recorded(n));
  };
  for (int i = 0; i < from.size(); ++i) {
    if (!needed[std::size_t(i)]) {
      continue;
    }
    const graph_node& n = from[i];
    std::array<int, 3> x{-1, -1, -1};
    for (int k = 0; k < operand_count(n.what); ++k) {
      x[std::size_t(k)] = image[std::size_t(n.operands[std::size_t(k)])];
    }
    image[std::size_t(i)] = n.what == operation::number     ? to.number(n.number)
                            : n.what == operation::variable ? to.variable(n.index)
                            : n.what == operation::power
                                ? power(recorded(to, x[0]), n.index).node_in(to)
                                : to.apply(n.what, x[0], x[1], x[2], n.index);
  }
  for (named_value y : f.outputs()) {
    for (int& node : y.nodes) {
      node = image[std::size_t(node)];
    }
    result.add_output(std::move(y));
  }
  return result;
}

/// A language: how numbers, functions, conditions, choices and assignments are written, where
/// operands come as texts.
template <class L>
concept CodeLanguage = requires(const L& language, const graph_node& n,
                                const std::array<printed, 3>& x) {
  { language.number(1.0) } -> std::same_as<std::string>;
  { language.call(n, x) } -> std::same_as<printed>;
  { language.condition(n, x) } -> std::same_as<printed>;
  { language.choice(x) } -> std::same_as<printed>;
  { language.assignment(std::string(), std::string(), true) } -> std::same_as<std::string>;
};

/// The statements of a formula, and the texts of its outputs.
struct code_body {
  std::vector<std::string> statements;
  std::vector<std::string> outputs; ///< of each number of the outputs, in order
  int temporaries = 0;              ///< numbers that have names of their own
  std::set<int> stumpff;            ///< orders of the Stumpff functions in it
  std::set<operation> functions;    ///< functions, conditions and choices in it
  bool has_sine_pairs = false;      ///< of the language's own
};

/// A language that can take sine and cosine of an angle in one statement.
template <class L>
concept HasSinePairs = requires(const L& language) {
  { language.has_own_sines() } -> std::same_as<bool>;
  { language.sine_pair(std::string(), std::string(), std::string()) } -> std::same_as<std::string>;
};

/// Writes each node as one statement, or, where it is used once and the line has room, into that
/// which uses it.
///
/// \param inputs  how the i-th input number is written
template <CodeLanguage Language>
[[nodiscard]] code_body write_body(const formula_graph& f, const std::vector<std::string>& inputs,
                                   const std::string& prefix, const Language& language) {
  const graph& g = f.operations();
  const std::vector<int> uses = f.uses();
  code_body body;
  std::vector<printed> texts(uses.size());
  std::map<int, std::array<std::string, 2>> pairs; // sine and cosine by the node of the angle
  const auto new_name = [&] { return prefix + std::to_string(++body.temporaries); };
  for (int i = 0; i < g.size(); ++i) {
    const graph_node& n = g[i];
    printed& text = texts[std::size_t(i)];
    if (uses[std::size_t(i)] == 0) {
      continue;
    }
    if (n.what == operation::number) {
      text = {language.number(n.number),
              n.number < 0 ? precedence::negative_number : precedence::atom};
      continue;
    }
    if (n.what == operation::variable) {
      text = {inputs[std::size_t(n.index)]};
      continue;
    }
    std::array<printed, 3> x;
    for (int k = 0; k < operand_count(n.what); ++k) {
      x[std::size_t(k)] = texts[std::size_t(n.operands[std::size_t(k)])];
    }
    if (n.what == operation::stumpff) {
      for (int order = n.index; order >= 0; order -= 2) {
        body.stumpff.insert(order);
      }
    }
    if constexpr (HasSinePairs<Language>) {
      if (language.has_own_sines() && (n.what == operation::sin || n.what == operation::cos)) {
        const auto [pair, is_new] = pairs.try_emplace(n.operands[0]);
        if (is_new) {
          pair->second = {new_name(), new_name()};
          body.statements.push_back(
              language.sine_pair(x[0].text, pair->second[0], pair->second[1]));
          body.has_sine_pairs = true;
        }
        text = {pair->second[n.what == operation::sin ? 0 : 1]};
        continue;
      }
    }
    if (n.what > operation::quotient) {
      body.functions.insert(n.what);
    }
    if (is_condition(n.what)) {
      text = language.condition(n, x);
    } else if (n.what == operation::select) {
      text = language.choice(x);
    } else if (n.what >= operation::negative && n.what <= operation::quotient) {
      text = text_of(g, n, x);
    } else {
      text = language.call(n, x);
    }
    constexpr std::size_t max_inlined = 60;
    const bool is_inlined = uses[std::size_t(i)] == 1 && text.text.size() <= max_inlined &&
                            n.what != operation::sin && n.what != operation::cos;
    if (!is_inlined) {
      const std::string name = new_name();
      body.statements.push_back(language.assignment(name, text.text, is_condition(n.what)));
      text = {name};
    }
  }
  for (const named_value& y : f.outputs()) {
    for (const int node : y.nodes) {
      body.outputs.push_back(texts[std::size_t(node)].text);
    }
  }
  return body;
}

/// The position of the k-th number of a value in the order of the code.
[[nodiscard]] inline int index_in_code(const named_value& x, int k, bool is_row_major) {
  return x.kind == shape::matrix && is_row_major ? k % x.rows * x.columns + k / x.rows : k;
}

/// A sentence on a value, for comments.
///
/// \param order  of matrices, behind a comma
[[nodiscard]] inline std::string described(const named_value& x, const std::string& order) {
  switch (x.kind) {
  case shape::scalar:
    return "scalar";
  case shape::matrix:
    return x.columns == 1
               ? "vector of " + std::to_string(x.rows)
               : std::to_string(x.rows) + " x " + std::to_string(x.columns) + " matrix" + order;
  case shape::quaternion:
    return "quaternion w, x, y, z";
  case shape::dual_vector:
    return "dual vector n + eps m: n, then m";
  case shape::pose:
    return "dual quaternion: w, x, y, z of the real part, then of the dual part";
  }
  return {};
}

/// Text that ends no comment and no line.
[[nodiscard]] inline std::string comment_text(std::string text) {
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char before = k > 0 ? text[k - 1] : ' ';
    if (static_cast<unsigned char>(text[k]) < ' ' || text[k] == '\\') {
      text[k] = ' ';
    } else if ((text[k] == '/' && before == '*') || (text[k] == '*' && before == '/')) {
      text[k] = ' ';
    } else if (text[k] == '"') {
      text[k] = '\'';
    }
  }
  return text;
}

/// The names of a function's inputs and outputs, and those that are taken.
struct code_names {
  name_table table;
  std::string function;
  std::vector<std::string> inputs, outputs;

  /// \param others  names that the code of the function takes, too
  /// \throws invalid_input for a name that is no identifier
  code_names(const formula_graph& f, const std::string& name, const char* emitter,
             const std::vector<std::string>& others = {})
      : function(name) {
    duet::detail::require(!name.empty() && plain_name(name) == name && name[0] != '_' &&
                              reserved_names().count(name) == 0,
                          "duet: ", emitter, ": '", name, "' is no name for a function");
    static_cast<void>(table.add(name));
    for (const std::string& other : others) {
      static_cast<void>(table.add(other));
    }
    for (const named_value& x : f.inputs()) {
      inputs.push_back(table.add(x.name));
    }
    for (const named_value& y : f.outputs()) {
      outputs.push_back(table.add(y.name));
    }
  }
};

/// True if an output needs a number of the input.
[[nodiscard]] inline bool is_used(const named_value& x, const std::vector<bool>& needed) {
  return std::any_of(x.nodes.begin(), x.nodes.end(),
                     [&](int node) { return needed[std::size_t(node)]; });
}

/// The texts of all numbers of the inputs.
///
/// \param at  (value, name, row, column) of a number
template <class F>
[[nodiscard]] std::vector<std::string> input_texts(const formula_graph& f, const code_names& names,
                                                   const F& at) {
  std::vector<std::string> result;
  for (std::size_t k = 0; k < f.inputs().size(); ++k) {
    const named_value& x = f.inputs()[k];
    for (int i = 0; i < x.rows * x.columns; ++i) {
      result.push_back(x.kind == shape::scalar ? names.inputs[k]
                                               : at(x, names.inputs[k], i % x.rows, i / x.rows));
    }
  }
  return result;
}

/// Lines of at most 96 characters, broken at spaces.
[[nodiscard]] inline std::vector<std::string> wrapped(const std::vector<std::string>& lines) {
  constexpr std::size_t width = 96;
  std::vector<std::string> result;
  for (std::string line : lines) {
    while (line.size() > width) {
      const std::size_t space = line.rfind(' ', width);
      if (space == std::string::npos || space < 4) {
        break;
      }
      result.push_back(line.substr(0, space));
      line = "    " + line.substr(space + 1);
    }
    result.push_back(line);
  }
  return result;
}

/// The sentences of the comment, without the marks of a comment.
/// \param describe  the sentence on a value
template <class Describe>
[[nodiscard]] std::vector<std::string>
comment_lines(const formula_graph& f, const code_names& names, const code_options& options,
              const Describe& describe) {
  std::vector<std::string> lines = {
      names.function +
          (options.description.empty() ? "" : ": " + comment_text(options.description)),
      ""};
  const auto list = [&](const char* title, const std::vector<named_value>& values,
                        const std::vector<std::string>& texts) {
    lines.push_back(title);
    for (std::size_t k = 0; k < values.size(); ++k) {
      lines.push_back("  " + texts[k] + ": " + describe(values[k]));
    }
  };
  list("Inputs:", f.inputs(), names.inputs);
  list("Outputs:", f.outputs(), names.outputs);
  const operation_counts n = count_operations(f);
  std::string counts;
  const auto count = [&](int number, const std::string& one, const char* ending = "s") {
    if (number > 0) {
      counts += (counts.empty() ? "" : ", ") + std::to_string(number) + " " + one +
                (number == 1 ? "" : ending);
    }
  };
  count(n.multiplications, "multiplication");
  count(n.additions, "addition");
  count(n.divisions, "division");
  count(n.sines, "sine-cosine pair");
  count(n.functions, "other function");
  count(n.choices, "choice");
  lines.push_back("Operations: " + (counts.empty() ? "none" : counts) + ".");
  lines.push_back("Written by duet " DUET_VERSION_STRING "; free of licence conditions.");
  return wrapped(lines);
}

/// Texts with commas between them.
[[nodiscard]] inline std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) {
    text += (text.empty() ? "" : ", ") + part;
  }
  return text;
}

/// Lines behind a margin.
[[nodiscard]] inline std::string indented(const std::vector<std::string>& lines,
                                          const std::string& margin = "  ") {
  std::string text;
  for (const std::string& line : lines) {
    const std::string whole = margin + line;
    text += whole.substr(0, whole.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

/// The coefficients 1/(2k+order)! with which c_order is summed, and their number.
[[nodiscard]] inline std::vector<double> stumpff_terms(int order) {
  const auto all = duet::detail::stumpff_coefficients<double, 13>(order);
  return {all.begin(), all.begin() + (order < 2 ? 10 : 13)};
}

/// 1/n!
[[nodiscard]] inline double inverse_factorial(int n) {
  return duet::detail::inverse_factorial<double>(n);
}

/// Every other term from the `first` on by Horner's rule, in a variable `square`.
template <class Number>
[[nodiscard]] std::string horner(const std::vector<double>& terms, std::size_t first,
                                 const Number& number) {
  std::string text;
  std::string closing;
  for (std::size_t k = first; k < terms.size(); k += 2) {
    const bool is_last = k + 2 >= terms.size();
    text += number(terms[k]) + (is_last ? "" : " + square * (");
    closing += is_last ? "" : ")";
  }
  return text + closing;
}

} // namespace detail
} // namespace duet::expression
