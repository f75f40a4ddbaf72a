// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/domain.hpp>
#include <duet/core/text/number_text.hpp>

#include <cmath>
#include <cstddef>
#include <initializer_list>

/// \file
/// From an input that fails to the simplest one that still does.

namespace duet::detail {

/// How much there is to read in a point: nothing for a zero, 1 for a 1, else digits and sign.
[[nodiscard]] inline std::size_t complexity(double x) { return x == 0 ? 0 : to_text(x).size(); }

/// x with so many significant decimal digits.
[[nodiscard]] inline double rounded_to_digits(double x, int digits) {
  if (x == 0 || !std::isfinite(x)) {
    return x;
  }
  // Through a power of ten that is exact, on whichever side of 1.
  const int shift = digits - 1 - int(std::floor(std::log10(std::abs(x))));
  const double power = std::pow(10.0, std::abs(shift));
  return shift >= 0 ? std::round(x * power) / power : std::round(x / power) * power;
}

/// Replaces coordinates by simpler numbers, one after the other, while `fails(point)` stays true.
///
/// Every replacement takes something away that there is to read, so this ends; points are tried in
/// a fixed order, so it ends at the same one every time.
template <class Contains, class Fails>
[[nodiscard]] coordinates simplified(coordinates point, const Contains& contains,
                                     const Fails& fails) {
  bool changed = true;
  while (changed) {
    changed = false;
    for (std::size_t i = 0; i < point.size(); ++i) {
      const double old = point[i];
      for (const double candidate :
           {0.0, 1.0, 2.0, -1.0, 0.5, std::round(old), std::abs(rounded_to_digits(old, 1)),
            rounded_to_digits(old, 1), rounded_to_digits(old, 2), rounded_to_digits(old, 4)}) {
        if (complexity(candidate) >= complexity(old)) {
          continue;
        }
        point[i] = candidate;
        if (contains(point) && fails(point)) {
          changed = true;
          break;
        }
        point[i] = old;
      }
    }
  }
  return point;
}

} // namespace duet::detail
