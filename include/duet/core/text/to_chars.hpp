// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <system_error>

/// \file
/// The shortest text of a number, also if the standard library has no `std::to_chars` for it, as
/// libc++ before 14.

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

} // namespace duet::detail
