// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/domain.hpp>
#include <duet/core/text/number_text.hpp>

#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <tuple>

/// \file
/// Simplification of an input at which two formulas differ.

namespace duet::detail {

/// Length of numbers as text: their digits, points and signs, without the zero before a point and
/// without zeros. Among those of equal length the simplest are nearest to 1 in size, as a ratio,
/// and then positive: 0, 1, 2, 3 … 9, −1, ½, −2, …
struct complexity {
  std::size_t characters = 0;
  double ratios = 0;
  std::size_t negative = 0;

  void add(double x) {
    if (x != 0) {
      const std::size_t all = to_text(x).size();
      characters += std::abs(x) < 1 && std::abs(x) >= 1e-3 ? all - 1 : all;
      ratios += std::abs(std::log(std::abs(x)));
      negative += x < 0 ? 1U : 0U;
    }
  }

  [[nodiscard]] bool operator<(const complexity& other) const {
    return std::tie(characters, ratios, negative) <
           std::tie(other.characters, other.ratios, other.negative);
  }
};

[[nodiscard]] inline complexity complexity_of(const coordinates& point) {
  complexity sum;
  for (const double x : point) {
    sum.add(x);
  }
  return sum;
}

/// x rounded to a number of significant decimal digits.
///
/// \param round  to an integer: to the nearest one, or towards zero
[[nodiscard]] inline double rounded_to_digits(double x, int digits,
                                              double (*round)(double) = std::round) {
  if (x == 0 || !std::isfinite(x)) {
    return x;
  }
  // Uses an exact power of ten, on either side of 1.
  const int shift = digits - 1 - int(std::floor(std::log10(std::abs(x))));
  const double power = std::pow(10.0, std::abs(shift));
  return shift >= 0 ? round(x * power) / power : round(x / power) * power;
}

/// Replaces coordinates by simpler numbers while `fails(point)` stays true: one after the other, or
/// all that are equal, or all that are nearly equal, which keep their differences.
///
/// Every replacement shortens the text, so this ends; points are tried in a fixed order, so it ends
/// at the same one every time.
template <class Contains, class Fails>
[[nodiscard]] coordinates simplified(coordinates point, const Contains& contains,
                                     const Fails& fails) {
  const auto is_simpler = [&](const coordinates& other) {
    return complexity_of(other) < complexity_of(point) && contains(other) && fails(other);
  };
  const auto simplify_from = [&](std::size_t i) {
    const double old = point[i];
    const double shorter = rounded_to_digits(old, 1, std::trunc);
    for (const double candidate :
         {0.0, 1.0, 2.0, 3.0, -1.0, 0.5, -0.5, std::round(old), std::abs(rounded_to_digits(old, 1)),
          rounded_to_digits(old, 1), std::abs(shorter), shorter, rounded_to_digits(old, 2),
          rounded_to_digits(old, 2, std::trunc), rounded_to_digits(old, 4)}) {
      for (const double nearness : {-1.0, 0.0, 1e-2}) {
        coordinates other = point;
        std::size_t changed = 0;
        for (std::size_t j = 0; j < point.size(); ++j) {
          if (j == i || std::abs(point[j] - old) <= nearness * std::abs(old)) {
            other[j] = j == i || point[j] == old ? candidate : candidate + (point[j] - old);
            ++changed;
          }
        }
        if ((nearness < 0 || changed > 1) && is_simpler(other)) {
          point = other;
          return true;
        }
      }
    }
    return false;
  };
  bool changed = true;
  while (changed) {
    changed = false;
    for (std::size_t i = 0; i < point.size(); ++i) {
      changed = simplify_from(i) || changed;
    }
  }
  return point;
}

} // namespace duet::detail
