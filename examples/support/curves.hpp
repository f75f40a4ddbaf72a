// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/number_text.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

/// \file
/// Curves of a table with their names beside them, for scripts of gnuplot.

namespace example {

enum class beside { right, left, above, below, above_right, above_left, below_right, below_left };

/// A curve of a table, and at which of its rows, from 0, its name stands where.
struct named_line {
  std::string columns; ///< as gnuplot has them: `1:2`, `1:(abs($3))`
  std::string colour;  ///< a name of `picture_style`
  std::string name;
  std::size_t row = 0;
  beside place = beside::right;
  std::string style = "lines lw 2";
};

/// `text` within quotation marks of gnuplot, to the letter.
[[nodiscard]] inline std::string in_quotes(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    result += c == '\'' ? std::string("''") : std::string(1, c);
  }
  return result + "'";
}

/// 2600 for 2634, 460 000 for 457123, 0.0052 for 0.005177.
[[nodiscard]] inline std::string two_digits(double x) {
  const double unit = std::pow(10, std::floor(std::log10(std::max(x, 1.0))) - 1);
  char digits[40];
  std::snprintf(digits, sizeof digits, x < 100 ? "%.2g" : "%.0f",
                x < 100 ? x : std::round(x / unit) * unit);
  std::string text = digits;
  for (std::size_t i = text.size(); x >= 1e4 && i > 3; i -= 3) {
    text.insert(i - 3, " ");
  }
  return text;
}

/// What follows `title`: a sentence that says what the picture shows.
[[nodiscard]] inline std::string title(const std::string& sentence) {
  return in_quotes("{/:Bold " + sentence + "}");
}

/// What follows `plot`: a curve, then its name.
[[nodiscard]] inline std::string plot_element(const std::string& file, const named_line& line) {
  const char* const places[] = {"left offset 1,0",    "right offset -1,0",   "center offset 0,1",
                                "center offset 0,-1", "left offset .5,.6",   "right offset -.5,.6",
                                "left offset .5,-.6", "right offset -.5,-.6"};
  const std::string row = std::to_string(line.row);
  std::string text = in_quotes(file) + " using " + line.columns + " skip 1 with " + line.style +
                     " lc rgb " + line.colour;
  if (!line.name.empty()) {
    text += ", \\\n     '' using " + line.columns + ":(" + in_quotes(line.name) +
            ") skip 1 every ::" + row + "::" + row + " with labels noenhanced " +
            places[int(line.place)] + " tc rgb " + line.colour;
  }
  return text;
}

/// An arrow at x from one curve to another, and beside it what is between them.
[[nodiscard]] inline std::string gap(double x, double from, double to, const std::string& text) {
  const std::string at = duet::to_text(x) + ",";
  return "set arrow from " + at + duet::to_text(from) + " to " + at + duet::to_text(to) +
         " heads size screen .006,20 filled lc rgb ink front\nset label " + in_quotes(text) +
         " at " + at + duet::to_text(std::sqrt(from) * std::sqrt(to)) +
         " left offset .7,0 tc rgb ink front\n";
}

/// The command that plots them all, the first on top.
[[nodiscard]] inline std::string plot_command(const std::string& file,
                                              const std::vector<named_line>& lines) {
  std::string text;
  for (const named_line& line : lines) {
    text = plot_element(file, line) + (text.empty() ? "\n" : ", \\\n     " + text);
  }
  return "plot " + text;
}

} // namespace example
