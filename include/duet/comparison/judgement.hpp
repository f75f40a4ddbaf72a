// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/comparison.hpp>
#include <duet/comparison/measure.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// \file
/// Verdict from the differences in several precisions, also if a function has fewer digits than its
/// arguments.

namespace duet::detail {

/// The error of a component that may be a slip.
struct suspect {
  std::size_t component = 0;
  double error = 0;             ///< error in the last precision
  double allowed = 0;           ///< allowed error there
  bool is_short = false;        ///< a function has fewer digits than that: round-off stays, too
  bool may_be_rounding = false; ///< the error leaves half of those digits
};

/// The component, if any, that is wrong in every precision, by an error that is the same in the
/// first and the last of them; the one with the largest error if there are several.
[[nodiscard]] inline std::optional<suspect> suspected(std::span<const difference> differences) {
  const difference& last = differences.back();
  std::optional<suspect> result;
  for (std::size_t i = 0; i < last.errors.size(); ++i) {
    const double error = last.errors[i];
    const bool fails =
        std::all_of(differences.begin(), differences.end(), [&](const difference& d) {
          return i < d.errors.size() && d.errors[i] > d.allowed;
        });
    if (fails && error >= differences.front().errors[i] / 2 && (!result || error > result->error)) {
      result = {i, error, last.allowed, differences.size() > 1 && last.ulps_in_shorter > 1};
    }
  }
  if (result && result->is_short) {
    result->may_be_rounding =
        last.common_ulps() < std::pow(10.0, std::min(last.digits[0], last.digits[1]) / 2.0);
  }
  return result;
}

/// True if all components are finite in both results or in neither, in every precision.
[[nodiscard]] inline bool all_finite(std::span<const difference> differences) {
  return std::all_of(differences.begin(), differences.end(),
                     [](const difference& d) { return d.is_finite; });
}

/// Verdict on the finite components, from the differences in several precisions, the least precise
/// first.
///
/// Round-off shrinks with ε. A slip is visible in every scalar, and stays constant.
[[nodiscard]] inline verdict judged(std::span<const difference> differences, double tolerance) {
  return suspected(differences) ? verdict::disagrees
         : std::any_of(differences.begin(), differences.end(),
                       [&](const difference& d) { return d.common_ulps() > tolerance; })
             ? verdict::loses_precision
             : verdict::agrees;
}

/// True if the error of a component at a point is a slip. It may be round-off that leaves no digit
/// in any precision, as that of 1 − cos x at 1e-12, or that is by chance the same in two.
///
/// Towards another point, at distances that grow from 2e-16 on, errors are the same in the first
/// and the last precision for a while. If the error is round-off, the last precision then begins to
/// have digits, and its error shrinks gradually. That of a slip vanishes at once, or stays to the
/// end.
///
/// \param pair  a formula_pair of several precisions
template <class Pair>
[[nodiscard]] bool is_slip(const Pair& pair, const coordinates& point, const suspect& at_point,
                           const coordinates& other) {
  double error = at_point.error, inside = 0, outside = 0x1p-52;
  const auto at = [&](double s) {
    coordinates between = point;
    for (std::size_t i = 0; i < point.size(); ++i) {
      between[i] += s * (other[i] - point[i]);
    }
    // Excluded points carry no information.
    return pair.contains(between) ? pair.errors_at(between, at_point.component)
                                  : std::array{error, error};
  };
  const auto stays = [&](double s) {
    const auto [first, last] = at(s);
    const bool same = first > 0 && last >= first / 2;
    error = same ? last : error;
    return same;
  };
  for (; outside < 1 && stays(outside); outside *= 8) {
    inside = outside;
  }
  if (outside >= 1) {
    return !at_point.may_be_rounding;
  }
  for (int i = 0; i < 5 && inside > 0; ++i) {
    const double middle = std::sqrt(inside * outside);
    (stays(middle) ? inside : outside) = middle;
  }
  double beyond = 0;
  for (int i = 0; i < 12; ++i) {
    beyond = std::max(beyond, at(std::min(1.0, outside * (1 + i / 11.0)))[1]);
    if (at_point.is_short) { // its round-off does not shrink, but occasionally vanishes
      beyond = std::max(beyond, at(std::min(1.0, outside * std::exp2(i / 2.0)))[1]);
    }
  }
  // An error at one point alone may be chance, unless the formula is right near it.
  return beyond < error / 8 && (inside > 0 || beyond <= 8 * at_point.allowed);
}

[[nodiscard]] inline std::string scalar_name(int digits) {
  return digits == std::numeric_limits<float>::digits10    ? "float"
         : digits == std::numeric_limits<double>::digits10 ? "double"
         : digits == std::numeric_limits<long double>::digits10
             ? "long double"
             : "numbers of " + std::to_string(digits) + " digits";
}

/// Names the function that returned fewer digits than its arguments have, and the remedy.
[[nodiscard]] inline std::string precision_note(int digits, const difference& d) {
  const bool first = d.digits[0] < digits, second = d.digits[1] < digits;
  return std::string(first && second ? "both functions"
                     : first         ? "the first function"
                                     : "the second function") +
         " returned " + scalar_name(std::min(d.digits[0], d.digits[1])) + " where " +
         (first && second ? "their" : "its") + " arguments were " + scalar_name(digits) +
         ": a constant made it so, as the 0.0 of derivative(f, 0.0): write T(0)";
}

/// Records in c that fewer digits were decisive, and counts errors in those.
///
/// \param shorter  for every precision, as measured for the points at which it was decisive;
///   unchanged if there are none
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
