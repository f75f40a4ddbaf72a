// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "comparison.hpp"
#include "tables.hpp"

#include "../support/curves.hpp"
#include "../support/style.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Pictures by gnuplot.

namespace wheel_carrier {

/// Errors oscillate since the curves interpolate the rows: the largest error of every curve between
/// two rows with a sample between them, and the midpoints of these intervals.
inline std::pair<std::vector<double>, std::vector<named_curve>>
largest_between_rows(const std::vector<double>& samples, const std::vector<named_curve>& curves,
                     const std::vector<double>& rows) {
  std::vector<double> heights;
  std::vector<named_curve> result;
  for (const auto& [name, curve] : curves) {
    result.push_back({name, {}});
  }
  for (std::size_t row = 1, first = 0; row < rows.size(); ++row) {
    std::size_t last = first;
    while (last < samples.size() && samples[last] <= rows[row]) {
      ++last;
    }
    if (last == first) {
      continue;
    }
    heights.push_back((rows[row - 1] + rows[row]) / 2);
    const auto largest = [&](const std::vector<double>& errors) {
      return *std::max_element(errors.begin() + std::ptrdiff_t(first),
                               errors.begin() + std::ptrdiff_t(last));
    };
    for (std::size_t i = 0; i < curves.size(); ++i) {
      result[i].second.delta.push_back(largest(curves[i].second.delta));
      result[i].second.delta_first.push_back(largest(curves[i].second.delta_first));
    }
    first = last;
  }
  return {heights, result};
}

/// Tics of errors in percent, two decades apart.
inline const char* percent_tics() {
  return "set logscale y\nset ytics ('10^{-10} %%' 1e-10, '10^{-8} %%' 1e-8, '10^{-6} %%' 1e-6, "
         "'0.0001 %%' 1e-4, '0.01 %%' 1e-2, '1 %%' 1, '100 %%' 100, '10 000 %%' 1e4, '10^6 %%' "
         "1e6)\n";
}

/// Columns of a curve, plotted only where it is more than 1.5 times another.
inline std::string columns_if_different(std::size_t column, std::size_t from) {
  const std::string a = "$" + std::to_string(column), b = "$" + std::to_string(from);
  return "1:(" + a + " > 1.5*" + b + " ? " + a + " : 1/0)";
}

/// Figure 1 of the paper, from `errors_between_rows.csv`: the printed formulas, in the reading with
/// smaller errors, and the corrected ones.
/// \param curves  result of `compare_methods`
/// \param heights, largest  contents of that table
/// \param other_ends  end conditions of the last curve, in a word
inline std::string errors_script(const std::vector<named_curve>& curves,
                                 const std::vector<double>& heights,
                                 const std::vector<named_curve>& largest,
                                 const std::string& other_ends) {
  const std::size_t printed = 2, other = curves.size() - 1;
  const auto column = [](std::size_t curve, std::size_t panel) { return 2 + 2 * curve + panel; };
  const auto columns = [&](std::size_t curve, std::size_t panel) {
    return "1:" + std::to_string(column(curve, panel));
  };
  const double wrong = summarise(curves[printed].second.delta_first).median;
  const double right = summarise(curves[0].second.delta_first).median;
  std::string text =
      "set multiplot layout 2,1 title " +
      example::title("The printed formula's acceleration errs by " + example::two_digits(wrong) +
                     " %, the true one's by " + example::two_digits(right) + " %") +
      "\nset lmargin 15\nset rmargin 3\nset xrange [*:*] noextend\n" + percent_tics();
  const std::size_t middle = 2 * heights.size() / 5;
  for (std::size_t panel = 0; panel < 2; ++panel) {
    text += panel == 0 ? "set ylabel \"error of\\nangular velocity\"\nset yrange [1e-7:1e1]\n"
                       : "set ylabel \"error of\\nangular acceleration\"\n"
                         "set yrange [1e-4:1e6]\nset xlabel 'wheel height u / m'\n";
    if (panel == 1) {
      text += example::gap(heights[middle], largest[0].second.delta_first[middle],
                           largest[printed].second.delta_first[middle],
                           example::two_digits(largest[printed].second.delta_first[middle] /
                                               largest[0].second.delta_first[middle]) +
                               " times the error");
    }
    text += example::plot_command(
        "errors_between_rows.csv",
        {{columns(0, panel), "blue", "true formula", 2 * heights.size() / 3,
          example::label_position::below_left, "lines lw 3"},
         {columns(printed, panel), "vermillion", "printed formula", 11 * heights.size() / 20,
          panel == 0 ? example::label_position::above_right : example::label_position::above,
          "lines lw 3"},
         {columns_if_different(column(other, panel), column(0, panel)), "grey",
          "true formula, " + other_ends + " ends", 2, example::label_position::right,
          "lines lw 2"}});
  }
  return text + "unset multiplot\n";
}

/// Splines with known end velocities, and the quintic without: `splines_between_rows.csv` over u
/// and `spline_convergence.csv` over the number of rows.
inline std::string splines_script(const std::vector<named_curve>& curves, std::size_t heights) {
  const auto number = [&](const std::string& name) {
    return std::size_t(std::find_if(curves.begin(), curves.end(),
                                    [&](const named_curve& c) { return c.first == name; }) -
                       curves.begin());
  };
  const auto over_height = [&](const char* name) { return 3 + 2 * number(name); };
  const auto over_rows = [&](const char* name) { return "1:" + std::to_string(2 + number(name)); };
  const auto columns = [](std::size_t column) { return "1:" + std::to_string(column); };
  const auto largest = [&](const char* name) {
    return summarise(curves[number(name)].second.delta_first).maximum;
  };
  using enum example::label_position;
  return "set multiplot layout 2,1 title " +
         example::title("Degree five is " +
                        example::two_digits(largest("rotation-vector, clamped") /
                                            largest("quintic, clamped")) +
                        " times as accurate as degree three, and natural ends spoil both") +
         "\nset lmargin 13\nset rmargin 3\nset xrange [*:*] noextend\n" + percent_tics() +
         "set xlabel 'wheel height u / m'\nset ylabel 'error of acceleration'\n"
         "set yrange [1e-9:1e3]\n" +
         example::plot_command("splines_between_rows.csv",
                               {{columns(over_height("cumulative, clamped")), "vermillion",
                                 "cumulative cubic", 3 * heights / 5, above},
                                {columns(over_height("rotation-vector, clamped")), "blue",
                                 "rotation-vector cubic", 3 * heights / 5, below},
                                {columns(over_height("quintic, clamped")), "green", "quintic",
                                 3 * heights / 5, above},
                                {columns_if_different(over_height("quintic, natural"),
                                                      over_height("quintic, clamped")),
                                 "grey", "quintic, natural ends", 4, above_right}}) +
         "set rmargin 25\nset xlabel 'rows of the table'\nset ylabel 'largest error'\nset logscale "
         "x\n"
         "set xrange [22:450]\nset yrange [1e-8:1e4]\nset xtics (25, 50, 100, 200, 400)\n" +
         example::plot_command(
             "spline_convergence.csv",
             {{over_rows("cumulative, clamped"), "vermillion", "cumulative cubic", 4, above,
               "linespoints pt 7 ps .6 lw 2"},
              {over_rows("rotation-vector, clamped"), "blue", "rotation-vector cubic", 4, right,
               "linespoints pt 7 ps .6 lw 2"},
              {over_rows("quintic, clamped"), "green", "quintic", 4, right,
               "linespoints pt 7 ps .6 lw 2"},
              {over_rows("quintic, not-a-knot"), "orange", "quintic, ends not known", 4, right,
               "linespoints pt 7 ps .6 lw 2"},
              {over_rows("quintic, natural"), "grey", "any of them, natural ends", 2, above,
               "linespoints pt 7 ps .6 lw 2"}}) +
         "unset multiplot\n";
}

/// Displacement of the wheel centre from the design position, toe-in and camber.
inline std::string path_script(const std::vector<state>& states) {
  const auto [lowest_camber, highest_camber] =
      std::minmax_element(states.begin(), states.end(),
                          [](const state& a, const state& b) { return camber(a.q) < camber(b.q); });
  const double range =
      (camber(highest_camber->q) - camber(lowest_camber->q)) * 180 / std::numbers::pi;
  const std::size_t high = 9 * states.size() / 10, low = states.size() / 10;
  using enum example::label_position;
  return "set multiplot layout 1,2 title " +
         example::title("Camber changes by " + example::two_digits(range) +
                        " degrees as the wheel goes up and down") +
         "\nset ylabel 'wheel height u / mm'\nset xlabel 'wheel centre from its design position / "
         "mm'\nset xtics 20\n" +
         example::plot_command("path.csv", {{"(1000*$11):(1000*$1)", "blue", "x, forward",
                                             7 * states.size() / 20, right, "lines lw 3"},
                                            {"(1000*$12):(1000*$1)", "vermillion", "y, left", high,
                                             above_right, "lines lw 3"}}) +
         "set xtics 5\nset xlabel 'angle / degrees'\n" +
         example::plot_command(
             "path.csv",
             {{"9:(1000*$1)", "blue", "toe-in", low, left, "lines lw 3"},
              {"10:(1000*$1)", "vermillion", "camber", high, above_right, "lines lw 3"}}) +
         "unset multiplot\n";
}

} // namespace wheel_carrier
