// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "comparison.hpp"

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

/// \file
/// Tables for people, in Markdown: docs/case-studies/wheel_carrier.md holds them as they are.

namespace wheel_carrier {

/// Two digits; values that round-off decides are printed as a bound.
inline std::string error_text(double x, double smallest) {
  char text[32];
  if (x < smallest) {
    std::snprintf(text, sizeof text, "< %g", smallest);
  } else if (x >= 9.95) {
    const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
    std::snprintf(text, sizeof text, "%.0f", std::round(x / unit) * unit);
  } else {
    std::snprintf(text, sizeof text, "%.2g", x);
  }
  return text;
}

/// Smallest printed errors in percent: second derivatives have fewer accurate digits.
inline constexpr double min_delta = 1e-6, min_delta_first = 1e-4;

/// Index of the maximum: the first value within a millionth of it.
inline std::size_t index_of_maximum(const std::vector<double>& values) {
  const double threshold = summarise(values).maximum * (1 - 1e-6);
  std::size_t i = 0;
  while (values[i] < threshold) {
    ++i;
  }
  return i;
}

/// ` median | maximum | u of the maximum | at the lower end, at the upper end |`
inline std::string error_cells(const std::vector<double>& samples,
                               const std::vector<double>& values, double smallest) {
  const summary s = summarise(values);
  char u[32] = "";
  if (s.maximum >= smallest) {
    std::snprintf(u, sizeof u, "%.3f", samples[index_of_maximum(values)]);
  }
  return " " + error_text(s.median, smallest) + " | " + error_text(s.maximum, smallest) + " | " +
         u + " | " + error_text(values.front(), smallest) + ", " +
         error_text(values.back(), smallest) + " |";
}

inline void print_header_of_errors() {
  std::printf(
      "| | velocity: median | maximum | at u | at lower, upper end | acceleration: median | "
      "maximum | at u | "
      "at lower, upper end |\n|---|---|---|---|---|---|---|---|---|\n");
}

inline void print_error_row(const std::string& name, const std::vector<double>& samples,
                            const error_curve& curve) {
  std::printf("| %s |%s%s\n", name.c_str(), error_cells(samples, curve.delta, min_delta).c_str(),
              error_cells(samples, curve.delta_first, min_delta_first).c_str());
}

/// An error, with the observed order of convergence if there is a previous table with
/// `steps_before` steps.
inline std::string convergence_cell(double error, double before, double steps,
                                    double steps_before) {
  std::string text = error_text(error, min_delta);
  if (before > 0) {
    char order[32];
    const double observed = std::log(before / error) / std::log(steps / steps_before);
    std::snprintf(order, sizeof order, " (%.1f)", std::abs(observed) < .05 ? 0 : observed);
    text += order;
  }
  return text;
}

} // namespace wheel_carrier
