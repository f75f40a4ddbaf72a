// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

/// \file
/// The grammar of formulas in text, by recursive descent. For those who extend duet; users call
/// `read_formula`.

// The rules:
//
// formula     = { statement ";" } outputs [";"]
// statement   = kind name {"," name}  |  name "=" condition    kind: scalar, vector or rotation
// outputs     = output {"," output}            output = [name "="] condition
// condition   = both {"||" both}               both = comparison {"&&" comparison}
// comparison  = sum [("<" | "<=" | ">" | ">=" | "==" | "!=") sum]
// sum         = product {("+" | "-") product}  product = signed {("*" | "/") signed}
// signed      = ("-" | "+" | "!") signed  |  implicit
// implicit    = number (power of a name or parenthesis)  |  power     2x, 2 sin(x), 2(x + 1)
// power       = primary [("^" | "**") signed]  without an implicit product in the exponent
// primary     = number  |  name  |  name "(" arguments ")"  |  "(" condition ")"
//             | "[" arguments "]"  |  primary "[" digit "]"

namespace duet::expression::detail {

/// Lines and columns of untrusted text are counted in characters from 1.
[[nodiscard]] constexpr std::size_t column_of(std::string_view text, std::size_t at) {
  std::size_t column = 1;
  for (const char c : text.substr(0, at)) {
    column += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }
  return column;
}

[[nodiscard]] constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Number of bytes of the letter, or digit of an index as in x₁, that the text begins with; else 0.
/// Letters are those of alphabets, CJK and mathematics.
[[nodiscard]] constexpr std::size_t letter_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const unsigned c = byte(0);
  if (c < 0x80) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ? 1 : 0;
  }
  const std::size_t count = c < 0xE0 ? 2 : c < 0xF0 ? 3 : 4;
  unsigned code = c & (0x7FU >> count);
  for (std::size_t i = 1; i < count; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) {
      return 0;
    }
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  const bool is_latin = code >= 0xC0 && code <= 0x24F && code != 0xD7 && code != 0xF7;
  const bool is_alphabet = code >= 0x370 && code <= 0x1FFF && code != 0x61C && code != 0x1680 &&
                           !(code >= 0x17B4 && code <= 0x17B5) && code != 0x180E;
  const bool is_index =
      code >= 0x2080 && code <= 0x209C && code != 0x208A && code != 0x208B && code != 0x208C;
  const bool is_other = (code >= 0x3041 && code <= 0x318E) || (code >= 0x3400 && code <= 0x9FFF) ||
                        (code >= 0xAC00 && code <= 0xD7A3) || (code >= 0x1D400 && code <= 0x1D7FF);
  const bool is_shortest = count == 2 ? code >= 0x80 : count == 3 ? code >= 0x800 : code >= 0x10000;
  return is_shortest && (is_latin || is_alphabet || is_index || is_other) ? count : 0;
}

/// Reads a text and passes its parts to a builder, operands before their operation:
///
/// - `number(digits, at)`, `name(word, at)`: an operand, which is at that byte of the text;
/// - `apply(operation, count, at)`: replaces the last `count` operands by their result; operations
///   are `+ - * / ^ < <= > >= == != && || ! negative []` and the names of functions;
/// - `component(i, at)`: the last operand's i-th number;
/// - `declare(kind, name, at)`, `assign(name, at)`, `output(name, at)`: ends of statements.
///
/// Both may throw; the text is read once from left to right. It can run in the compiler, where a
/// builder with a member `error(expected, at)` receives the first error instead.
template <class Builder>
class formula_grammar {
public:
  /// Text of more bytes is rejected.
  static constexpr std::size_t max_size = std::size_t(64) * 1024;
  /// Parentheses, functions, signs and exponents in one another.
  static constexpr int max_depth = 200;

  constexpr formula_grammar(std::string_view text, Builder& builder)
      : text_(text), builder_(builder) {}

  /// Reads statements and outputs.
  constexpr void read() {
    if (text_.size() > max_size) {
      duet::detail::raise(
          invalid_input(duet::detail::message("duet: read_formula: the text has ", text_.size(),
                                              " bytes (expected at most ", max_size, ")")));
    }
    skip_blanks();
    while (true) {
      const bool is_declaration = declaration();
      if (!is_declaration) {
        const std::string_view first = assignment();
        condition();
        if (peek() == ';' && !first.empty() && has_more()) {
          builder_.assign(first, name_at_);
        } else {
          return outputs(first);
        }
      }
      require(peek() == ';', "',' or ';'");
      advance(1);
    }
  }

private:
  /// Counts how deeply what is read is nested.
  class nested {
  public:
    constexpr explicit nested(formula_grammar& of) : of_(of) {
      if (++of_.depth_ > max_depth) {
        of_.fail("the formula is nested more than 200 deep", of_.at_);
      }
    }
    constexpr ~nested() { --of_.depth_; }
    nested(const nested&) = delete;
    nested& operator=(const nested&) = delete;

  private:
    formula_grammar& of_;
  };

  // Characters and words.

  [[nodiscard]] constexpr char peek(std::size_t k = 0) const {
    return at_ + k < text_.size() ? text_[at_ + k] : '\0';
  }
  [[nodiscard]] constexpr bool is_at_end() const { return at_ >= text_.size(); }
  constexpr void skip_blanks() {
    while (!is_at_end() && (peek() == ' ' || peek() == '\t' || peek() == '\n' || peek() == '\r')) {
      ++at_;
    }
  }
  constexpr void advance(std::size_t bytes) {
    at_ = std::min(at_ + bytes, text_.size());
    skip_blanks();
  }
  /// True if the text goes on with the sign, which is then passed.
  [[nodiscard]] constexpr bool accept(std::string_view sign) {
    if (text_.substr(at_, sign.size()) != sign) {
      return false;
    }
    advance(sign.size());
    return true;
  }
  /// True if something but `;` and blanks follows the `;` here.
  [[nodiscard]] constexpr bool has_more() const {
    return text_.find_first_not_of("; \t\r\n", at_) != std::string_view::npos;
  }
  /// The name that begins here, or an empty text.
  [[nodiscard]] constexpr std::string_view word() const {
    std::size_t end = at_;
    while (end < text_.size()) {
      const std::size_t bytes = letter_bytes(text_.substr(end));
      if (bytes == 0 && (end == at_ || !is_digit(text_[end]))) {
        break;
      }
      end += std::max<std::size_t>(bytes, 1);
    }
    return text_.substr(at_, end - at_);
  }
  /// The number that begins here, without a sign, or an empty text.
  [[nodiscard]] constexpr std::string_view digits() const {
    std::size_t k = 0;
    const auto pass_digits = [&] {
      const std::size_t first = k;
      while (is_digit(peek(k))) {
        ++k;
      }
      return k > first;
    };
    const bool has_whole = pass_digits();
    const bool has_point = peek(k) == '.' && (has_whole || is_digit(peek(k + 1)));
    if (has_point) {
      ++k;
      static_cast<void>(pass_digits());
    }
    if (k > 0 && (peek(k) == 'e' || peek(k) == 'E')) {
      const std::size_t before = k;
      k += peek(k + 1) == '+' || peek(k + 1) == '-' ? 2 : 1;
      if (!pass_digits()) {
        k = before;
      }
    }
    return text_.substr(at_, k);
  }

  // Errors.

  constexpr void fail(const char* problem, std::size_t at) {
    if constexpr (requires { builder_.error(problem, at); }) {
      builder_.error(problem, at);
      at_ = text_.size(); // what follows ends soon, and finds other errors
    } else {
      raise(problem, at);
    }
  }
  constexpr void expected(const char* what) {
    if constexpr (requires { builder_.error(what, at_); }) {
      fail(what, at_);
    } else {
      raise_expected(what);
    }
  }
  [[noreturn]] void raise(const char* problem, std::size_t at) const {
    duet::detail::raise(invalid_input(
        duet::detail::message("duet: read_formula: column ", column_of(text_, at), ": ", problem)));
  }
  [[noreturn]] void raise_expected(const char* what) const {
    duet::detail::raise(
        invalid_input(duet::detail::message("duet: read_formula: column ", column_of(text_, at_),
                                            ": expected ", what, ", got ", current())));
  }
  constexpr void require(bool condition, const char* what) {
    if (!condition) {
      expected(what);
    }
  }
  /// The next word or sign, for messages.
  [[nodiscard]] std::string current() const {
    if (is_at_end()) {
      return "the end";
    }
    std::string_view token = word();
    if (token.empty()) {
      token = digits();
    }
    if (token.empty()) {
      token = text_.substr(
          at_, std::max<std::size_t>(duet::detail::escaped_bytes(text_.substr(at_)), 1));
    }
    constexpr std::size_t max_shown = 40;
    return "'" + duet::printable(token.substr(0, max_shown)) +
           (token.size() > max_shown ? "...'" : "'");
  }

  // Statements.

  [[nodiscard]] constexpr bool declaration() {
    const std::string_view kind = word();
    if (kind != "scalar" && kind != "vector" && kind != "rotation") {
      return false;
    }
    const std::size_t before = at_;
    advance(kind.size());
    if (word().empty()) { // a variable of that name
      at_ = before;
      return false;
    }
    do {
      const std::string_view name = word();
      require(!name.empty(), "a name");
      builder_.declare(kind, name, at_);
      advance(name.size());
    } while (accept(","));
    return true;
  }
  /// The name of `name = ...`, which is passed, or an empty text.
  [[nodiscard]] constexpr std::string_view assignment() {
    const std::string_view name = word();
    const std::size_t before = at_;
    advance(name.size());
    if (!name.empty() && peek() == '=' && peek(1) != '=') {
      name_at_ = before;
      advance(1);
      return name;
    }
    at_ = before;
    return {};
  }
  constexpr void outputs(std::string_view name) {
    output(name);
    while (accept(",")) {
      name = assignment();
      condition();
      output(name);
    }
  }
  constexpr void output(std::string_view name) {
    require(is_at_end() || peek() == ',' || (peek() == ';' && !has_more()),
            "an operator or the end of the formula");
    builder_.output(name, name_at_);
  }

  // Expressions.

  constexpr void condition() {
    const nested guard(*this);
    both();
    infix({"||"}, [&] { both(); });
  }
  constexpr void both() {
    comparison();
    infix({"&&"}, [&] { comparison(); });
  }
  constexpr void comparison() {
    sum();
    for (const std::string_view sign : {"<=", ">=", "==", "!=", "<", ">"}) {
      const std::size_t at = at_;
      if (accept(sign)) {
        sum();
        return builder_.apply(sign, 2, at);
      }
    }
  }
  constexpr void sum() {
    product();
    infix({"+", "-"}, [&] { product(); });
  }
  constexpr void product() {
    signed_factor(true);
    while ((peek() == '*' && peek(1) != '*') || peek() == '/') {
      const std::size_t at = at_;
      const bool is_quotient = peek() == '/';
      advance(1);
      signed_factor(!is_quotient); // 1/2x might be meant as (1/2) x or as 1/(2 x)
      builder_.apply(is_quotient ? "/" : "*", 2, at);
    }
  }
  struct signs {
    std::string_view first, second = {};
  };
  /// Operations of equal precedence, from the left to the right.
  template <class F>
  constexpr void infix(const signs& of, const F& operand) {
    while (true) {
      const std::size_t at = at_;
      const bool is_first = accept(of.first);
      if (!is_first && (of.second.empty() || !accept(of.second))) {
        return;
      }
      operand();
      builder_.apply(is_first ? of.first : of.second, 2, at);
    }
  }
  /// \param has_implicit  true if 2x is a product here
  constexpr void signed_factor(bool has_implicit) {
    const std::size_t at = at_;
    const bool is_not = peek() == '!' && peek(1) != '=';
    if (!is_not && peek() != '-' && peek() != '+') {
      return implicit_product(has_implicit);
    }
    const nested guard(*this);
    const bool is_plus = peek() == '+';
    advance(1);
    signed_factor(has_implicit);
    if (!is_plus) {
      builder_.apply(is_not ? "!" : "negative", 1, at);
    }
  }
  constexpr void implicit_product(bool has_implicit) {
    const bool is_number = !digits().empty();
    power();
    if (is_number && has_implicit && last_is_number_ && (peek() == '(' || !word().empty())) {
      const std::size_t at = at_;
      power();
      builder_.apply("*", 2, at);
    }
  }
  constexpr void power() {
    primary();
    const std::size_t at = at_;
    if (accept("^") || accept("**")) {
      const nested guard(*this);
      signed_factor(false);
      builder_.apply("^", 2, at);
      last_is_number_ = false;
    }
  }
  constexpr void primary() {
    const std::size_t at = at_;
    if (const std::string_view number = digits(); !number.empty()) {
      advance(number.size());
      builder_.number(number, at);
      last_is_number_ = true;
      return;
    }
    if (const std::string_view name = word(); !name.empty()) {
      advance(name.size());
      if (peek() == '(') {
        advance(1);
        builder_.apply(name, arguments(')', "',' or ')'"), at);
      } else {
        builder_.name(name, at);
      }
    } else if (accept("(")) {
      condition();
      require(peek() == ')', "an operator or ')'");
      advance(1);
    } else if (accept("[")) {
      builder_.apply("[]", arguments(']', "',' or ']'"), at);
    } else {
      expected("a number, name, function or '('");
    }
    while (accept("[")) {
      const std::string_view index = digits();
      require(index.size() == 1 && is_digit(index[0]), "an index from 0 to 3");
      builder_.component(index[0] - '0', at_);
      advance(1);
      require(peek() == ']', "']'");
      advance(1);
    }
    last_is_number_ = false;
  }
  /// The number of expressions up to `end`, which is passed.
  [[nodiscard]] constexpr int arguments(char end, const char* expected_there) {
    int count = 0;
    do {
      condition();
      ++count;
    } while (accept(","));
    require(peek() == end, expected_there);
    advance(1);
    return count;
  }

  std::string_view text_;
  Builder& builder_;
  std::size_t at_ = 0;
  std::size_t name_at_ = 0;
  int depth_ = 0;
  bool last_is_number_ = false;
};

} // namespace duet::expression::detail
