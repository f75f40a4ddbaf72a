// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The judgement of duet-check-formula, of texts that a reader types.

#include "../../../programs/check_formula/check_formula.hpp"
#include "live.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/expression/graph/formula_grammar.hpp>
#include <duet/expression/graph/formula_graph.hpp>
#include <duet/expression/graph/read_formula.hpp>

#include <boost/throw_exception.hpp>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace expression = duet::expression;
using duet::detail::require;

/// The field that is being read, for errors.
const char* field = "";

[[nodiscard]] std::string error_text(std::string message) {
  for (const std::string_view prefix : {"duet: ", "read_formula: "}) {
    if (message.starts_with(prefix)) {
      message.erase(0, prefix.size());
    }
  }
  return "{\"error\":" + check_formula::json_text(message) +
         ",\"field\":" + check_formula::json_text(field) + "}";
}

/// The names of a list with commas, spaces or both between them.
[[nodiscard]] std::vector<std::string> names_of(std::string_view list) {
  std::vector<std::string> names;
  while (true) {
    list.remove_prefix(std::min(list.find_first_not_of(", "), list.size()));
    if (list.empty()) {
      return names;
    }
    const std::string_view name = list.substr(0, list.find_first_of(", "));
    for (std::size_t i = 0; i < name.size();) {
      const std::size_t bytes = expression::detail::letter_bytes(name.substr(i));
      const bool is_digit = i > 0 && expression::detail::is_digit(name[i]);
      require(bytes > 0 || is_digit, "'", duet::printable(name),
              "' is not a name (expected letters, then letters and digits)");
      i += std::max<std::size_t>(bytes, 1);
    }
    names.emplace_back(name);
    list.remove_prefix(name.size());
  }
}

/// The variable that the derivative is with respect to: the one that is named, or the only one.
[[nodiscard]] std::string variable_of(const std::vector<expression::named_value>& inputs,
                                      const std::vector<std::string>& named) {
  require(named.size() <= 1, "expected one name");
  std::vector<std::string> all, scalars;
  std::string list;
  for (const expression::named_value& x : inputs) {
    all.push_back(x.name);
    if (x.kind == expression::shape::scalar) {
      scalars.push_back(x.name);
    }
    list += (list.empty() ? "" : ", ") + x.name;
  }
  if (named.size() == 1) {
    require(all.empty() || std::find(all.begin(), all.end(), named[0]) != all.end(),
            "the formula has no variable '", named[0], "' (it has ", list, ")");
    return named[0];
  }
  const std::vector<std::string>& candidates = scalars.empty() ? all : scalars;
  require(!candidates.empty(), "the formula has no variable: name one");
  require(candidates.size() == 1, "the formula has several variables: name one of ", list);
  return candidates[0];
}

[[nodiscard]] check_formula::claim claim_of(const char* formula, const char* claimed,
                                            const char* variable, const char* vectors,
                                            const char* rotations) {
  check_formula::claim c{.text = claimed, .reference = formula, .wrt = ""};
  field = "vectors";
  c.vectors = names_of(vectors);
  field = "rotations";
  c.rotations = names_of(rotations);
  field = "formula";
  const expression::read_options options{
      .vectors = c.vectors, .rotations = c.rotations, .exact_constants = true};
  const expression::formula_graph f = expression::read_formula(formula, options);
  field = "variable";
  c.wrt = variable_of(f.inputs(), names_of(variable));
  // In the order of the judgement, whose errors name no field.
  expression::detail::formula_builder both(options);
  field = "claimed";
  both.read(claimed);
  static_cast<void>(both.take_outputs());
  field = "formula";
  both.read(formula);
  field = "";
  return c;
}

} // namespace

#ifdef BOOST_NO_EXCEPTIONS
void boost::throw_exception(const std::exception& error, const boost::source_location& where) {
  static_cast<void>(where);
  duet::detail::raise(duet::invalid_input(error.what()));
}
#endif

/// The judgement of a derivative that a reader claims, or an error, as JSON.
/// \param variable   its name; empty for the only one
/// \param vectors    names of vector inputs
/// \param rotations  names of inputs that are unit quaternions
/// \return text that is valid until the next call
DUET_LIVE const char* judgement_of(const char* formula, const char* claimed, const char* variable,
                                   const char* vectors, const char* rotations) {
  static std::string text;
#ifdef __EMSCRIPTEN__
  duet::set_error_handler([](const char* message) { // which must not be unwound
    text = error_text(message);
    duet_live_error(text.c_str());
  });
#endif
  duet::detail::catching<std::exception>(
      [&] {
        const check_formula::claim c = claim_of(formula, claimed, variable, vectors, rotations);
        text = check_formula::to_json(c, check_formula::judge(c));
      },
      [&](const std::exception& error) { text = error_text(error.what()); });
  return text.c_str();
}
