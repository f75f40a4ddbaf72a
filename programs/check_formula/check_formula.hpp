// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// The judgement of the program duet-check-formula, apart from its command line.

namespace check_formula {

/// A formula that is claimed to be the derivative of another, or to equal it.
struct claim {
  std::string text;                        ///< the claimed formula
  std::string reference;                   ///< the other one
  std::optional<std::string> wrt;          ///< the input of the derivative; none for equality
  std::vector<std::string> vectors = {};   ///< names of vector inputs
  std::vector<std::string> rotations = {}; ///< names of quaternion inputs
  std::map<std::string, std::pair<double, double>> ranges = {}; ///< of inputs, by name
};

/// Names of inputs, and their values as text.
using input_texts = std::vector<std::pair<std::string, std::string>>;

enum class verdict { agrees, disagrees, no_value };

/// Values of both sides at an input.
struct values_at {
  input_texts input;             ///< names and texts of values
  std::string claimed, expected; ///< texts; empty where there is no value
};

/// The judgement of a claim.
struct judgement {
  verdict outcome = verdict::no_value;
  int agree = 0;     ///< number of inputs at which both sides have one value
  int disagree = 0;  ///< number of inputs at which the values differ
  int undecided = 0; ///< number of inputs at which round-off of 50 digits hides the values
  int one_sided = 0; ///< number of inputs at which one side alone has a value
  int neither = 0;   ///< number of inputs at which no side has a value
  std::optional<values_at> simplest;        ///< disagreement
  std::optional<values_at> first_one_sided; ///< likewise
  bool is_proved = false;                   ///< equal by algebra, with values at the same inputs
  input_texts loss;                         ///< input at which double loses digits
  std::string right, right_latex;           ///< the derivative; empty for equality
};

/// \throws std::exception with a message of one line for what is no claim
[[nodiscard]] judgement judge(const claim& c);

/// agrees, disagrees or no value.
[[nodiscard]] const char* outcome_text(const judgement& j);

/// A text as JSON.
[[nodiscard]] std::string json_text(std::string_view text);

/// The claim and its judgement as a line of JSON.
[[nodiscard]] std::string to_json(const claim& c, const judgement& j);

} // namespace check_formula
