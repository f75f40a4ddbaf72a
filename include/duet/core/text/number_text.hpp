// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/from_chars.hpp>
#include <duet/core/text/to_chars.hpp>

#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

/// \file
/// Numbers as text, the same under every locale.

namespace duet {

/// The shortest text that reads back as exactly `x`, with a decimal point.
template <std::floating_point T>
[[nodiscard]] std::string to_text(T x) {
  return detail::shortest_text(x);
}

namespace detail {

/// The text without blanks at both ends.
[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// As `parse_number`, with the reason of failure: `result_out_of_range` for a number beyond the
/// range of a double, `invalid_argument` for text that is not a number.
[[nodiscard]] inline std::errc read_number(std::string_view text, double& value) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') {
    text.remove_prefix(1);
  }
  const auto [end, error] = from_chars(text.data(), text.data() + text.size(), value);
  return end == text.data() + text.size() ? error : std::errc::invalid_argument;
}

} // namespace detail

/// The number that the whole text spells, ignoring blanks around it and a leading plus sign; `inf`
/// and `nan` are numbers too. Empty if the text is anything else.
[[nodiscard]] inline std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  if (detail::read_number(text, value) != std::errc()) {
    return std::nullopt;
  }
  return value;
}

} // namespace duet
