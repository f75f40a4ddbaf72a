// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

/// \file
/// Numbers as text, the same under every locale, also if the standard library lacks `std::to_chars`
/// of floating-point numbers, as libc++ before 14, or `std::from_chars`, as libc++ before 20.

namespace duet::detail {

/// The number spelt by the text, rounded to nearest. The text has no decimal point, which would
/// have to be that of the locale.
template <std::floating_point T>
[[nodiscard]] T nearest_to(const std::string& text) {
  if constexpr (std::same_as<T, float>) {
    return std::strtof(text.c_str(), nullptr);
  } else if constexpr (std::same_as<T, double>) {
    return std::strtod(text.c_str(), nullptr);
  } else {
    return std::strtold(text.c_str(), nullptr);
  }
}

/// Digits without a point; the first is in units of 10^exponent.
struct decimal_digits {
  std::string digits;
  int exponent = 0;

  [[nodiscard]] int last_exponent() const { return exponent - int(digits.size()) + 1; }
  template <std::floating_point T>
  [[nodiscard]] bool spells(T x) const {
    return nearest_to<T>(digits + 'e' + std::to_string(last_exponent())) == x;
  }
};

/// x > 0 rounded to nearest with this number of digits.
template <std::floating_point T>
[[nodiscard]] decimal_digits rounded_digits(T x, int count) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*Le", count - 1, static_cast<long double>(x));
  decimal_digits result;
  const char* at = buffer;
  for (; *at != 'e'; ++at) { // skips the decimal point of any locale
    if (*at >= '0' && *at <= '9') {
      result.digits += *at;
    }
  }
  result.exponent = std::atoi(at + 1);
  return result;
}

/// The fewest digits whose nearest number is x > 0, and of these the nearest to x.
template <std::floating_point T>
[[nodiscard]] decimal_digits shortest_digits(T x) {
  for (int count = 1;; ++count) {
    decimal_digits result = rounded_digits(x, count);
    if (count >= std::numeric_limits<T>::max_digits10 || result.spells(x)) {
      return result;
    }
    // The spacing of numbers above a power of two is twice that below: a text farther from it may
    // be valid if a nearer one is not. (After a 9 it has fewer digits, and was checked.)
    if (result.digits.back() != '9') {
      ++result.digits.back();
      if (result.spells(x)) {
        return result;
      }
    }
  }
}

/// As `std::to_chars` of x, by `std::snprintf`: plain or scientific, whichever is shorter, plain if
/// neither is.
template <std::floating_point T>
[[nodiscard]] std::string shortest_text_by_printf(T x) {
  const std::string sign = std::signbit(x) ? "-" : "";
  if (!std::isfinite(x)) {
    return sign + (std::isnan(x) ? "nan" : "inf");
  }
  if (x == 0) {
    return sign + '0';
  }
  const auto [digits, exponent] = shortest_digits(std::abs(x));
  const int count = int(digits.size());

  std::string power = std::to_string(std::abs(exponent));
  power = (exponent < 0 ? "e-" : "e+") + std::string(power.size() < 2 ? "0" : "") + power;
  const std::string scientific =
      digits.substr(0, 1) + (count > 1 ? '.' + digits.substr(1) : "") + power;

  std::string plain;
  if (exponent < 0) {
    plain = "0." + std::string(std::size_t(-exponent - 1), '0') + digits;
  } else if (exponent + 1 < count) {
    plain = digits.substr(0, std::size_t(exponent) + 1) + '.' +
            digits.substr(std::size_t(exponent) + 1);
  } else {
    plain = digits + std::string(std::size_t(exponent + 1 - count), '0');
    if (plain.size() <= scientific.size()) { // all digits of the integer
      plain.resize(plain.size() + 1);
      std::snprintf(plain.data(), plain.size(), "%.0Lf", static_cast<long double>(std::abs(x)));
      plain.pop_back();
    }
  }
  return sign + (plain.size() <= scientific.size() ? plain : scientific);
}

/// True if the standard library has `std::to_chars` for the number.
template <class T>
concept HasToChars = requires(char* text, T value) {
  { std::to_chars(text, text, value) } -> std::same_as<std::to_chars_result>;
};

/// Text of `std::to_chars(first, last, x)`.
template <std::floating_point T>
[[nodiscard]] std::string shortest_text(T x) {
  if constexpr (HasToChars<T>) {
    char buffer[64];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, x);
    return error == std::errc() ? std::string(buffer, end) : std::string();
  } else {
    return shortest_text_by_printf(x);
  }
}

/// Number of leading decimal digits.
[[nodiscard]] inline std::size_t count_of_digits(std::string_view text) {
  return std::size_t(
      std::find_if(text.begin(), text.end(), [](char c) { return c < '0' || c > '9'; }) -
      text.begin());
}

/// True if the text begins with the word, ignoring case. The word is in lower case.
[[nodiscard]] inline bool begins_with(std::string_view text, std::string_view word) {
  return text.size() >= word.size() &&
         std::equal(word.begin(), word.end(), text.begin(),
                    [](char a, char b) { return a == b || a == b - 'A' + 'a'; });
}

/// Length of the infinity or NaN that the text begins with, 0 if there is neither.
[[nodiscard]] inline std::size_t read_not_finite(std::string_view text, double& value) {
  if (begins_with(text, "inf")) {
    value = std::numeric_limits<double>::infinity();
    return begins_with(text, "infinity") ? 8 : 3;
  }
  if (!begins_with(text, "nan")) {
    return 0;
  }
  value = std::numeric_limits<double>::quiet_NaN();
  if (begins_with(text, "nan(")) {
    const auto end = std::find_if(text.begin() + 4, text.end(), [](char c) {
      return c != '_' && !(c >= '0' && c <= '9') && !(c >= 'a' && c <= 'z') &&
             !(c >= 'A' && c <= 'Z');
    });
    if (end != text.end() && *end == ')') {
      return std::size_t(end - text.begin()) + 1;
    }
  }
  return 3;
}

/// As `std::from_chars(first, last, value)`, by `std::strtod`, which rounds as well and depends on
/// the locale for the decimal point alone. So the text passed has no point: 12.5e3 as 125e2.
[[nodiscard]] inline std::from_chars_result from_chars_by_strtod(const char* first,
                                                                 const char* last, double& value) {
  const std::string_view text(first, std::size_t(last - first));
  const bool is_negative = !text.empty() && text[0] == '-';
  const std::size_t start = is_negative ? 1 : 0;
  double size = 0;
  if (const std::size_t length = read_not_finite(text.substr(start), size); length > 0) {
    value = std::copysign(size, is_negative ? -1. : 1.);
    return {first + start + length, std::errc()};
  }

  const std::size_t integer_digits = count_of_digits(text.substr(start));
  std::string digits(text.substr(start, integer_digits));
  std::size_t end = start + integer_digits;
  long long exponent = 0;
  if (end < text.size() && text[end] == '.') {
    const std::size_t fraction_digits = count_of_digits(text.substr(end + 1));
    if (integer_digits + fraction_digits > 0) {
      digits += text.substr(end + 1, fraction_digits);
      exponent = -static_cast<long long>(fraction_digits);
      end += 1 + fraction_digits;
    }
  }
  if (digits.empty()) {
    return {first, std::errc::invalid_argument};
  }
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    std::size_t begin = end + 1;
    const bool has_sign = begin < text.size() && (text[begin] == '-' || text[begin] == '+');
    const bool divides = has_sign && text[begin] == '-';
    begin += has_sign ? 1 : 0;
    const std::size_t length = count_of_digits(text.substr(begin));
    if (length > 0) {
      long long written = 0;
      for (const char digit : text.substr(begin, length)) { // beyond 10¹⁵ it makes no difference
        written = std::min(written * 10 + (digit - '0'), 1'000'000'000'000'000LL);
      }
      exponent += divides ? -written : written;
      end = begin + length;
    }
  }

  const bool is_zero = digits.find_first_not_of('0') == std::string::npos;
  size = std::strtod((digits + 'e' + std::to_string(exponent)).c_str(), nullptr);
  if (!std::isfinite(size) || (size == 0 && !is_zero)) {
    return {first + end, std::errc::result_out_of_range};
  }
  value = is_negative ? -size : size;
  return {first + end, std::errc()};
}

/// True if the standard library has `std::from_chars` for the number, and not only for integers.
template <class T>
concept HasFromChars = requires(const char* text, T& value) {
  { std::from_chars(text, text, value) } -> std::same_as<std::from_chars_result>;
};

/// `std::from_chars(first, last, value)`.
template <std::same_as<double> T>
[[nodiscard]] std::from_chars_result from_chars(const char* first, const char* last, T& value) {
  if constexpr (HasFromChars<T>) {
    return std::from_chars(first, last, value);
  } else {
    return from_chars_by_strtod(first, last, value);
  }
}

} // namespace duet::detail

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
