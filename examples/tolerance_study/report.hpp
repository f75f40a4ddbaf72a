// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "blocks.hpp"
#include "samples.hpp"
#include "toleranced_carrier.hpp"

#include "../support/curves.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/number_text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

/// \file
/// Comparison of first order and samples: tables and a picture. Degrees, metres.

namespace tolerance_study {

inline constexpr std::array<const char*, 2> angle_names{"toe-in", "camber"};

/// Toe-in or camber at one height.
struct spread {
  double design;
  double linear; ///< standard deviation to first order
  statistics sampled;
};

struct results {
  std::vector<double> heights;
  std::array<std::vector<spread>, 2> spreads; ///< of toe-in and camber
  std::vector<sensitivity> sensitivities;     ///< at the heights, degrees per metre
  std::array<std::array<double, coordinate_count>, 2> influence; ///< root mean square of these
};

/// First-order standard deviation √Σ (σ ∂/∂h_j)² and statistics of the samples.
[[nodiscard]] inline results results_of(const toleranced_carrier& mechanism, double deviation,
                                        const std::vector<std::vector<double>>& columns) {
  results r{};
  for (std::size_t row = 0; row < mechanism.rows(); ++row) {
    const vector2 design = mechanism.angles(row, errors::Zero()) * degrees;
    r.heights.push_back(mechanism.height(row));
    r.sensitivities.push_back(mechanism.sensitivities(row) * degrees);
    for (std::size_t angle = 0; angle < 2; ++angle) {
      const auto i = Eigen::Index(angle);
      r.spreads[angle].push_back({design[i], deviation * r.sensitivities[row].row(i).norm(),
                                  statistics_of(columns[2 * row + angle])});
      for (int j = 0; j < coordinate_count; ++j) {
        const double s = r.sensitivities[row](i, j);
        r.influence[angle][std::size_t(j)] += s * s / double(mechanism.rows());
      }
    }
  }
  for (auto& influence : r.influence) {
    for (double& x : influence) {
      x = std::sqrt(x);
    }
  }
  return r;
}

/// The five most influential coordinates, in descending order.
[[nodiscard]] inline std::array<int, 5> most_influential(const results& r, std::size_t angle) {
  std::array<int, coordinate_count> order{};
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return r.influence[angle][std::size_t(a)] > r.influence[angle][std::size_t(b)];
  });
  return {order[0], order[1], order[2], order[3], order[4]};
}

/// The largest |sampled / linear standard deviation − 1|.
[[nodiscard]] inline double largest_difference(const results& r) {
  double largest = 0;
  for (const auto& spreads : r.spreads) {
    for (const spread& s : spreads) {
      largest = std::max(largest, std::abs(s.sampled.deviation / s.linear - 1));
    }
  }
  return largest;
}

inline void print(const results& r, const hardpoints& points) {
  for (std::size_t angle = 0; angle < 2; ++angle) {
    std::printf("%s, degrees%*s standard deviation       samples less the design\n",
                angle_names[angle], 4, "");
    std::printf("  %7s %9s %9s %9s %9s %9s %9s\n", "u [m]", "design", "linear", "sampled", "mean",
                "2.5 %", "97.5 %");
    for (std::size_t row = 0; row < r.heights.size(); ++row) {
      const spread& s = r.spreads[angle][row];
      const double design = std::abs(s.design) < 5e-5 ? 0 : s.design; // no -0.0000
      std::printf("  %7.3f %9.4f %9.4f %9.4f %9.4f %9.4f %9.4f\n", r.heights[row], design, s.linear,
                  s.sampled.deviation, s.sampled.mean - s.design, s.sampled.low - s.design,
                  s.sampled.high - s.design);
    }
    std::printf("  most influential (root mean square over the travel, degrees per mm):\n");
    for (const int j : most_influential(r, angle)) {
      std::printf("    %-28s %7.4f\n", coordinate_name(points, j).c_str(),
                  r.influence[angle][std::size_t(j)] / 1000);
    }
    std::printf("\n");
  }
}

[[nodiscard]] inline std::string summary_csv(const results& r) {
  std::vector<std::string> names{"u"};
  for (const std::string name : angle_names) {
    for (const char* column : {"design", "linear sd", "sampled sd", "mean", "2.5 %", "97.5 %"}) {
      names.push_back(name + " " + column);
    }
  }
  std::string text = duet::csv_header(names);
  for (std::size_t row = 0; row < r.heights.size(); ++row) {
    std::vector<double> numbers{r.heights[row]};
    for (const auto& spreads : r.spreads) {
      const spread& s = spreads[row];
      numbers.insert(numbers.end(), {s.design, s.linear, s.sampled.deviation, s.sampled.mean,
                                     s.sampled.low, s.sampled.high});
    }
    text += duet::csv_line(numbers);
  }
  return text;
}

/// Degrees per metre: a line per coordinate, toe-in and camber at every height.
[[nodiscard]] inline std::string sensitivities_csv(const results& r, const hardpoints& points) {
  std::vector<std::string> names{"coordinate"};
  for (const double u : r.heights) {
    for (const std::string name : angle_names) {
      names.push_back(name + " at " + duet::to_text(u));
    }
  }
  std::string text = duet::csv_header(names);
  for (int j = 0; j < coordinate_count; ++j) {
    std::vector<double> numbers;
    for (const sensitivity& s : r.sensitivities) {
      numbers.insert(numbers.end(), {s(0, j), s(1, j)});
    }
    text += duet::csv_sanitized(coordinate_name(points, j)) + "," + duet::csv_line(numbers);
  }
  return text;
}

/// Top: toe-in and camber over the travel. Bottom: the most influential coordinates.
[[nodiscard]] inline std::string picture_script(const results& r, const hardpoints& points) {
  std::string text =
      "set multiplot layout 2,2 title " +
      example::title("Sensitivities foretell the spread of the samples to " +
                     example::two_digits(100 * largest_difference(r)) + " %") +
      "\nset lmargin 10\nset rmargin 3\nset xlabel 'wheel height u / m'\nset xtics .05\n"
      "set yrange [*:*]\nset xrange [" +
      duet::to_text(r.heights.front()) + ":" + duet::to_text(r.heights.back()) + "]\n";
  using enum example::label_position;
  const std::size_t middle = r.heights.size() / 2;
  for (std::size_t angle = 0; angle < 2; ++angle) {
    const auto column = [angle](std::size_t i) { return std::to_string(i + 6 * angle); };
    const auto bound = [&](const char* factor) {
      return "1:($" + column(2) + factor + "*$" + column(3) + ")";
    };
    const auto name = [&](const char* words) { return angle == 0 ? std::string(words) : ""; };
    text +=
        (angle == 0 ? "set label '95 % of the samples' at graph .5,.3 center front tc rgb blue\n"
                    : "unset label\n") +
        std::string("set ylabel '") + angle_names[angle] + " / degrees'\n" +
        "plot 'summary.csv' using 1:" + column(6) + ":" + column(7) +
        " skip 1 with filledcurves fc rgb '#cfe3f1', \\\n     " +
        example::plot_element(
            "summary.csv", {"1:" + column(2), "ink", name("design"), middle, above, "lines lw 3"}) +
        ", \\\n     " +
        example::plot_element("summary.csv", {bound("+1.96"), "vermillion", name("first order"),
                                              middle, above, "lines lw 2 dt 2"}) +
        ", \\\n     " +
        example::plot_element("summary.csv",
                              {bound("-1.96"), "vermillion", "", 0, above, "lines lw 2 dt 2"}) +
        "\n";
  }
  text += "unset ylabel\nset lmargin 20\nset yrange [5.6:0.4]\nset xtics .1\n"
          "set xlabel 'degrees per mm'\n";
  for (std::size_t angle = 0; angle < 2; ++angle) {
    std::string labels, boxes;
    int rank = 1;
    for (const int j : most_influential(r, angle)) {
      labels += (rank > 1 ? ", " : "") + example::in_quotes(coordinate_name(points, j)) + " " +
                std::to_string(rank);
      const std::string y = std::to_string(rank);
      boxes += "set object " + y + " rectangle from 0," + y + "-0.35 to " +
               duet::to_text(r.influence[angle][std::size_t(j)] / 1000) + "," + y +
               "+0.35 fc rgb blue fs solid noborder\n";
      ++rank;
    }
    const double largest = r.influence[angle][std::size_t(most_influential(r, angle)[0])] / 1000;
    text += boxes + "set ytics (" + labels +
            ") noenhanced\nset xrange [0:" + duet::to_text(1.1 * largest) +
            "]\nset title 'what moves " + angle_names[angle] + " most'\nplot 1/0\n";
  }
  return text + "unset multiplot\nunset object\n";
}

} // namespace tolerance_study
