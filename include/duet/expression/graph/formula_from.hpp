// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/expression/arithmetic.hpp>
#include <duet/expression/condition.hpp>
#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/functions_of_many.hpp>
#include <duet/expression/graph/formula_grammar.hpp>
#include <duet/expression/graph/functions_of_one.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/special_functions.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/tree/function.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/vector.hpp>

#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <utility>

/// \file
/// Typed formulas from text, by the compiler and the grammar of `read_formula`.

namespace duet::expression {

namespace detail {

/// Something that the grammar read: a number, a name, an operation of some operands, or a
/// declaration. Its word is a part of the text, or the name of an operation.
struct read_event {
  enum class role { number, name, apply, component, declare, assign, output };
  role what = role::number;
  std::string_view word = {}, kind = {};
  int operands = 0;
};

/// Keeps what the grammar reads, in the compiler.
template <std::size_t Size>
struct event_list {
  std::array<read_event, 2 * Size + 2> events = {};
  std::size_t count = 0;
  std::size_t error_at = 0; ///< behind the first error; 0 for none

  constexpr void number(std::string_view word, std::size_t) {
    add({.what = read_event::role::number, .word = word});
  }
  constexpr void name(std::string_view word, std::size_t) {
    add({.what = read_event::role::name, .word = word});
  }
  constexpr void apply(std::string_view word, int operands, std::size_t) {
    add({.what = read_event::role::apply, .word = word, .operands = operands});
  }
  constexpr void component(int i, std::size_t) {
    add({.what = read_event::role::component, .operands = i});
  }
  constexpr void declare(std::string_view kind, std::string_view word, std::size_t) {
    add({.what = read_event::role::declare, .word = word, .kind = kind});
  }
  constexpr void assign(std::string_view word, std::size_t) {
    add({.what = read_event::role::assign, .word = word});
  }
  constexpr void output(std::string_view word, std::size_t at) {
    add({.what = read_event::role::output, .word = word});
    outputs += 1;
    if (outputs > 1) {
      error("one output", at);
    }
  }
  constexpr void error(const char*, std::size_t at) {
    error_at = error_at == 0 ? at + 1 : error_at;
  }

private:
  constexpr void add(const read_event& e) {
    if (error_at == 0 && count < events.size()) {
      events[count++] = e;
    }
  }
  int outputs = 0;
};

/// The text of a formula in a type, as it was read.
template <name Text>
struct formula_reading {
  static constexpr std::string_view text{Text.letters, sizeof(Text.letters) - 1};
  static constexpr auto read() {
    event_list<sizeof(Text.letters)> events;
    formula_grammar<decltype(events)>(text, events).read();
    return events;
  }
  static constexpr auto result = read();
  static constexpr std::size_t error_column =
      result.error_at == 0 ? 0 : column_of(text, result.error_at - 1);
};

/// Compile-time message for a text that formula_from cannot read.
template <std::size_t Column>
struct syntax_error_at_column {
  static_assert(Column == 0, "duet: formula_from: the text is no formula: the column of what is "
                             "wrong is the number in syntax_error_at_column; read_formula says "
                             "what was expected there");
};

/// The value of a number of at most 15 digits.
[[nodiscard]] constexpr double number_value(std::string_view word) {
  constexpr double max_exact = 1e15, max_scale = 1e22;
  double digits = 0, scale = 1;
  int exponent = 0, written = 0;
  bool is_fraction = false, has_exponent = false, is_negative = false;
  for (const char c : word) {
    if (c == '.') {
      is_fraction = true;
    } else if (c == 'e' || c == 'E') {
      has_exponent = true;
    } else if (c == '-' || c == '+') {
      is_negative = c == '-';
    } else if (has_exponent) {
      written = 10 * written + (c - '0');
    } else {
      digits = 10 * digits + (c - '0');
      exponent -= is_fraction;
    }
  }
  exponent += is_negative ? -written : written;
  for (int k = 0; k < (exponent < 0 ? -exponent : exponent) && scale <= max_scale; ++k) {
    scale *= 10;
  }
  return digits >= max_exact || scale > max_scale ? -1
         : exponent < 0                           ? digits / scale
                                                  : digits * scale;
}

/// A name of a part of a text, as a template argument.
template <class Reading, std::size_t I>
[[nodiscard]] constexpr auto name_of_event() {
  constexpr std::string_view word = Reading::result.events[I].word;
  char letters[word.size() + 1] = {};
  for (std::size_t k = 0; k < word.size(); ++k) {
    letters[k] = word[k];
  }
  return name<word.size() + 1>(letters);
}

/// Puts a typed formula together from what was read, from event to event.
template <class Reading>
struct typed_builder {
  static constexpr const auto& events = Reading::result.events;
  using role = read_event::role;

  /// \param named  how parts that have names are called: tuples of an event's index and a formula
  template <std::size_t I, class... Stack, class... Named>
  static constexpr auto from(const std::tuple<Stack...>& stack, const std::tuple<Named...>& named) {
    constexpr read_event e = events[I];
    if constexpr (e.what == role::output) {
      return std::get<sizeof...(Stack) - 1>(stack);
    } else if constexpr (e.what == role::number) {
      constexpr double value = number_value(e.word);
      static_assert(value >= 0, "duet: formula_from: a number has at most 15 digits and a decimal "
                                "exponent of at most 22");
      return from<I + 1>(pushed(stack, formula<number_node<bits_of(value)>, held<>>{}), named);
    } else if constexpr (e.what == role::declare) {
      constexpr kind k = e.kind == "vector"     ? kind::vector
                         : e.kind == "rotation" ? kind::quaternion
                                                : kind::scalar;
      return from<I + 1>(stack, given<I>(named, symbol_of_kind<k, name_of_event<Reading, I>()>{}));
    } else if constexpr (e.what == role::assign) {
      return from<I + 1>(first<sizeof...(Stack) - 1>(stack),
                         given<I>(named, std::get<sizeof...(Stack) - 1>(stack)));
    } else if constexpr (e.what == role::component) {
      constexpr std::size_t last = sizeof...(Stack) - 1;
      return from<I + 1>(pushed(first<last>(stack),
                                duet::expression::component<e.operands>(std::get<last>(stack))),
                         named);
    } else if constexpr (e.what == role::name) {
      return from<I + 1>(pushed(stack, named_value<I>(named)), named);
    } else {
      constexpr std::size_t count = std::size_t(e.operands), rest = sizeof...(Stack) - count;
      return [&]<std::size_t... K>(std::index_sequence<K...>) {
        return from<I + 1>(pushed(first<rest>(stack), call<I>(std::get<rest + K>(stack)...)),
                           named);
      }
      (std::make_index_sequence<count>{});
    }
  }

private:
  template <std::size_t I, class F>
  struct binding {
    static constexpr std::string_view word = events[I].word;
    F value;
  };
  template <class... Stack, class F>
  static constexpr auto pushed(const std::tuple<Stack...>& stack, const F& f) {
    return std::tuple_cat(stack, std::tuple<F>(f));
  }
  template <std::size_t Count, class Stack>
  static constexpr auto first(const Stack& stack) {
    return [&]<std::size_t... K>(std::index_sequence<K...>) {
      return std::tuple<std::tuple_element_t<K, Stack>...>(std::get<K>(stack)...);
    }
    (std::make_index_sequence<Count>{});
  }
  template <std::size_t I, class... Named, class F>
  static constexpr auto given(const std::tuple<Named...>& named, const F& f) {
    return std::tuple_cat(named, std::tuple<binding<I, F>>(binding<I, F>{f}));
  }
  template <std::size_t I, std::size_t K = 0, class... Named>
  static constexpr auto named_value(const std::tuple<Named...>& named) {
    if constexpr (K < sizeof...(Named)) {
      if constexpr (std::tuple_element_t<K, std::tuple<Named...>>::word == events[I].word) {
        return std::get<K>(named).value;
      } else {
        return named_value<I, K + 1>(named);
      }
    } else if constexpr (events[I].word == "pi") {
      return pi;
    } else {
      return symbol<name_of_event<Reading, I>()>{};
    }
  }

  template <std::size_t I, class A>
  static constexpr auto call(const A& a) {
    constexpr std::string_view f = events[I].word;
#define DUET_CASE(name)                                                                            \
  else if constexpr (f == #name) {                                                                 \
    return name(a);                                                                                \
  }
    if constexpr (f == "negative") {
      return -a;
    } else if constexpr (f == "ln") {
      return log(a);
    }
    DUET_EACH_FUNCTION(DUET_CASE)
    DUET_CASE(norm)
    DUET_CASE(conj)
    DUET_CASE(vec)
    else {
      unknown<f.empty()>();
    }
#undef DUET_CASE
  }
  template <std::size_t I, class A, class B>
  static constexpr auto call(const A& a, const B& b) {
    constexpr std::string_view f = events[I].word;
    if constexpr (f == "+") {
      return a + b;
    } else if constexpr (f == "-") {
      return a - b;
    } else if constexpr (f == "*") {
      return a * b;
    } else if constexpr (f == "/") {
      return a / b;
    } else if constexpr (f == "^" || f == "pow") {
      return pow(a, b);
    } else if constexpr (f == "<") {
      return a < b;
    } else if constexpr (f == "<=") {
      return a <= b;
    } else if constexpr (f == ">") {
      return a > b;
    } else if constexpr (f == ">=") {
      return a >= b;
    } else if constexpr (f == "min") {
      return min(a, b);
    } else if constexpr (f == "max") {
      return max(a, b);
    } else if constexpr (f == "atan2") {
      return atan2(a, b);
    } else if constexpr (f == "hypot") {
      return hypot(a, b);
    } else if constexpr (f == "dot") {
      return dot(a, b);
    } else if constexpr (f == "cross") {
      return cross(a, b);
    } else if constexpr (f == "rotate") {
      return rotate(a, b);
    } else {
      unknown<f.empty()>();
    }
  }
  template <std::size_t I, class A, class B, class C>
  static constexpr auto call(const A& a, const B& b, const C& c) {
    constexpr std::string_view f = events[I].word;
    if constexpr (f == "select") {
      return select(a, b, c);
    } else if constexpr (f == "[]") {
      return make_vector(a, b, c);
    } else if constexpr (f == "hypot") {
      return hypot(a, b, c);
    } else if constexpr (f == "slerp") {
      return slerp(a, b, c);
    } else {
      unknown<f.empty()>();
    }
  }
  template <bool IsKnown>
  static constexpr void unknown() {
    static_assert(IsKnown, "duet: formula_from: an operation is not among those of typed formulas");
  }
};

template <name Text>
[[nodiscard]] constexpr auto typed_formula() {
  using reading = formula_reading<Text>;
  if constexpr (reading::error_column != 0) {
    return syntax_error_at_column<reading::error_column>{};
  } else {
    return typed_builder<reading>::template from<0>(std::tuple<>{}, std::tuple<>{});
  }
}

} // namespace detail

/// The typed formula that a text spells, the same as if it were written in C++:
/// `formula_from<"exp(-u)*sin(omega*u^2)">`. The language is that of `read_formula`, without
/// numbers of rotations, `== != && || !` and what rounds; numbers have at most 15 digits. What is
/// no formula does not compile, and the error names the column.
template <name Text>
inline constexpr auto formula_from = detail::typed_formula<Text>();

} // namespace duet::expression
