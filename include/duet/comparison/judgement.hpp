// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/comparison.hpp>
#include <duet/comparison/measure.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

/// \file
/// What differences in several precisions say together, also where a function has fewer digits than
/// its arguments.

namespace duet::detail {

/// What the differences in several precisions, the least precise first, say together.
///
/// Rounding errors shrink with ε. A slip is seen in every scalar, and stays what it is. A function
/// that returns fewer digits than its arguments have is as precise in every scalar: there, the same
/// error is a slip where it leaves less than half of these digits.
[[nodiscard]] inline verdict judged(std::span<const difference> differences, double tolerance) {
  std::size_t failures = 0;
  for (const difference& d : differences) {
    if (!d.is_finite) {
      return verdict::not_finite;
    }
    failures += d.common_ulps() > tolerance ? 1U : 0U;
  }
  if (failures == 0) {
    return verdict::agrees;
  }
  const difference& last = differences.back();
  const bool shrinks = differences.size() > 1 && last.absolute < differences.front().absolute / 2;
  const double half_of_digits = std::pow(10.0, std::min(last.digits[0], last.digits[1]) / 2.0);
  const bool may_be_rounding =
      differences.size() > 1 && last.ulps_in_shorter > 1 && last.common_ulps() < half_of_digits;
  return failures == differences.size() && !shrinks && !may_be_rounding ? verdict::disagrees
                                                                        : verdict::loses_digits;
}

[[nodiscard]] inline std::string scalar_name(int digits) {
  return digits == std::numeric_limits<float>::digits10    ? "float"
         : digits == std::numeric_limits<double>::digits10 ? "double"
         : digits == std::numeric_limits<long double>::digits10
             ? "long double"
             : "numbers of " + std::to_string(digits) + " digits";
}

/// Which function returned fewer digits than its arguments have, and how to repair it.
[[nodiscard]] inline std::string precision_note(int digits, const difference& d) {
  const bool first = d.digits[0] < digits, second = d.digits[1] < digits;
  return std::string(first && second ? "both functions"
                     : first         ? "the first function"
                                     : "the second function") +
         " returned " + scalar_name(std::min(d.digits[0], d.digits[1])) + " where " +
         (first && second ? "their" : "its") + " arguments were " + scalar_name(digits) +
         ": a constant made it so, as the 0.0 of derivative(f, 0.0): write T(0)";
}

/// Says in c where fewer digits were what counted, and counts errors in those.
/// \param shorter  of every precision, as measured where it did; untouched where it did nowhere
inline void count_in_shorter(comparison& c, std::span<const difference> shorter) {
  for (std::size_t k = 0; k < shorter.size(); ++k) {
    if (shorter[k].ulps_in_shorter > 1) {
      c.errors[k].ulps /= shorter[k].ulps_in_shorter;
      c.errors[k].compared_digits = std::min(shorter[k].digits[0], shorter[k].digits[1]);
      c.note = precision_note(c.errors[k].digits, shorter[k]);
    }
  }
}

[[nodiscard]] inline bool by_common_ulps(const difference& a, const difference& b) {
  return a.common_ulps() < b.common_ulps();
}

} // namespace duet::detail
