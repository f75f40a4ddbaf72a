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
/// Curves of a table, labelled with their names, for gnuplot scripts.

namespace example {

enum class label_position {
  right,
  left,
  above,
  below,
  above_right,
  above_left,
  below_right,
  below_left
};

/// A curve of a table with its label: text, row of the table (from 0), position next to the curve.
struct named_line {
  std::string columns; ///< as gnuplot has them: `1:2`, `1:(abs($3))`
  std::string colour;  ///< a name of `picture_style`
  std::string name;
  std::size_t row = 0;
  label_position position = label_position::right;
  std::string style = "lines lw 2";
};

/// `text` as a string literal of gnuplot.
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

/// Argument of `title`: a sentence that states what the picture shows.
[[nodiscard]] inline std::string title(const std::string& sentence) {
  return in_quotes("{/:Bold " + sentence + "}");
}

/// Argument of `plot`: a curve, then its label.
[[nodiscard]] inline std::string plot_element(const std::string& file, const named_line& line) {
  const char* const placements[] = {
      "left offset 1,0",   "right offset -1,0",   "center offset 0,1",  "center offset 0,-1",
      "left offset .5,.6", "right offset -.5,.6", "left offset .5,-.6", "right offset -.5,-.6"};
  const std::string row = std::to_string(line.row);
  std::string text = in_quotes(file) + " using " + line.columns + " skip 1 with " + line.style +
                     " lc rgb " + line.colour;
  if (!line.name.empty()) {
    text += ", \\\n     '' using " + line.columns + ":(" + in_quotes(line.name) +
            ") skip 1 every ::" + row + "::" + row + " with labels noenhanced " +
            placements[int(line.position)] + " tc rgb " + line.colour;
  }
  return text;
}

/// An arrow at x from one curve to another, labelled with a text.
[[nodiscard]] inline std::string gap(double x, double from, double to, const std::string& text) {
  const std::string at = duet::to_text(x) + ",";
  return "set arrow from " + at + duet::to_text(from) + " to " + at + duet::to_text(to) +
         " heads size screen .006,20 filled lc rgb ink front\nset label " + in_quotes(text) +
         " at " + at + duet::to_text(std::sqrt(from) * std::sqrt(to)) +
         " left offset .7,0 tc rgb ink front\n";
}

/// The command that plots all curves, the first one on top.
[[nodiscard]] inline std::string plot_command(const std::string& file,
                                              const std::vector<named_line>& lines) {
  std::string text;
  for (const named_line& line : lines) {
    text = plot_element(file, line) + (text.empty() ? "\n" : ", \\\n     " + text);
  }
  return "plot " + text;
}

} // namespace example
