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
#include <string>
#include <string_view>
#include <system_error>

/// \file
/// `std::from_chars` of `double`, also if the standard library lacks it, as libc++ before 20.

namespace duet::detail {

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
