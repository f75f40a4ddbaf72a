// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "check_formula.hpp"

#include <string>
#include <string_view>

namespace check_formula {

std::string json_text(std::string_view text) {
  constexpr std::string_view hexadecimal = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20) {
      result += {'\\', 'u', '0', '0', hexadecimal[byte / 16], hexadecimal[byte % 16]};
    } else {
      result += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    }
  }
  return result + "\"";
}

namespace {

[[nodiscard]] std::string json(const input_texts& input) {
  std::string text = "{";
  for (const auto& [name, value] : input) {
    text += (text == "{" ? "" : ",") + json_text(name) + ":" + json_text(value);
  }
  return text + "}";
}
[[nodiscard]] std::string json(const values_at& values) {
  const auto or_none = [](const std::string& value) {
    return json_text(value.empty() ? "no value" : value);
  };
  return "{\"input\":" + json(values.input) + ",\"claimed\":" + or_none(values.claimed) +
         ",\"expected\":" + or_none(values.expected) + "}";
}

} // namespace

const char* outcome_text(const judgement& j) {
  return j.outcome == verdict::agrees      ? "agrees"
         : j.outcome == verdict::disagrees ? "disagrees"
                                           : "no value";
}

std::string to_json(const claim& c, const judgement& j) {
  std::string text = "{\"verdict\":" + json_text(outcome_text(j)) + ",\"claim\":" + json_text(c.text) +
                     (c.wrt ? ",\"derivative_of\":" : ",\"equals\":") + json_text(c.reference);
  if (c.wrt) {
    text += ",\"wrt\":" + json_text(*c.wrt) + ",\"derivative\":" + json_text(j.right) +
            ",\"latex\":" + json_text(j.right_latex);
  }
  const auto count = [](int n) { return std::to_string(n); };
  text += ",\"agree\":" + count(j.agree) + ",\"disagree\":" + count(j.disagree) +
          ",\"undecided\":" + count(j.undecided) + ",\"one_sided\":" + count(j.one_sided) +
          ",\"neither\":" + count(j.neither) + ",\"proved\":" + (j.is_proved ? "true" : "false");
  if (j.simplest) {
    text += ",\"simplest\":" + json(*j.simplest);
  }
  if (j.first_one_sided) {
    text += ",\"first_one_sided\":" + json(*j.first_one_sided);
  }
  if (!j.loss.empty()) {
    text += ",\"loses_digits_at\":" + json(j.loss);
  }
  return text + "}";
}

} // namespace check_formula
