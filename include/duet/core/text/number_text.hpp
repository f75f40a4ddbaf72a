// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <locale>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

/// \file
/// Numbers as text, the same under every locale, also if the standard library lacks
/// `std::from_chars` of floating-point numbers, as libc++ before 20.

namespace duet {
namespace detail {

/// True if the standard library has `std::to_chars` for the number.
template <class T>
concept HasToChars = requires(char* text, T value) {
  { std::to_chars(text, text, value) } -> std::same_as<std::to_chars_result>;
};

} // namespace detail

/// The shortest text that reads back as exactly `x`, with a decimal point. (With libc++ 13, which
/// has no `std::to_chars` of such numbers, it has all digits.)
template <std::floating_point T>
[[nodiscard]] std::string to_text(T x) {
  if constexpr (detail::HasToChars<T>) {
    char buffer[64];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, x);
    return error == std::errc() ? std::string(buffer, end) : std::string();
  } else {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(std::numeric_limits<T>::max_digits10);
    text << x;
    return text.str();
  }
}

namespace detail {

/// The number that the whole text spells, as for `std::from_chars`, by `std::strtod`, which rounds
/// as well and depends on the locale for the decimal point alone. So the text passed has no point:
/// 12.5e3 as 125e2.
[[nodiscard]] inline std::errc read_by_strtod(std::string_view text, double& value) {
  const bool is_negative = text.starts_with('-');
  const std::string_view size = text.substr(is_negative ? 1 : 0);
  if (!size.empty() && std::string_view("iInN").find(size[0]) != std::string_view::npos) {
    const std::string word(text); // an infinity or NaN
    char* end = nullptr;
    const double x = std::strtod(word.c_str(), &end);
    if (end != word.c_str() + word.size()) {
      return std::errc::invalid_argument;
    }
    value = x;
    return std::errc();
  }

  const std::size_t letter = std::min(size.find_first_of("eE"), size.size());
  std::string digits(size.substr(0, letter));
  long long exponent = 0;
  if (letter < size.size()) {
    std::string_view written = size.substr(letter + 1);
    if (written.starts_with('+') && !written.starts_with("+-")) {
      written.remove_prefix(1);
    }
    const char* const last = written.data() + written.size();
    const auto [end, error] = std::from_chars(written.data(), last, exponent);
    if (end != last || error == std::errc::invalid_argument) {
      return std::errc::invalid_argument;
    }
    constexpr long long limit = 1'000'000'000'000'000; // beyond it makes no difference
    if (error == std::errc::result_out_of_range) {
      exponent = written[0] == '-' ? -limit : limit;
    }
    exponent = std::clamp(exponent, -limit, limit);
  }
  if (const std::size_t point = digits.find('.'); point != std::string::npos) {
    digits.erase(point, 1);
    exponent -= static_cast<long long>(digits.size() - point);
  }
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos) {
    return std::errc::invalid_argument;
  }
  const double x = std::strtod((digits + 'e' + std::to_string(exponent)).c_str(), nullptr);
  const bool is_zero = digits.find_first_not_of('0') == std::string::npos;
  if (!std::isfinite(x) || (x == 0 && !is_zero)) {
    return std::errc::result_out_of_range;
  }
  value = is_negative ? -x : x;
  return std::errc();
}

/// True if the standard library has `std::from_chars` for the number, and not only for integers.
template <class T>
concept HasFromChars = requires(const char* text, T& value) {
  { std::from_chars(text, text, value) } -> std::same_as<std::from_chars_result>;
};

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
template <std::same_as<double> T>
[[nodiscard]] std::errc read_number(std::string_view text, T& value) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') {
    text.remove_prefix(1);
  }
  if constexpr (HasFromChars<T>) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return end == text.data() + text.size() ? error : std::errc::invalid_argument;
  } else {
    return read_by_strtod(text, value);
  }
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
