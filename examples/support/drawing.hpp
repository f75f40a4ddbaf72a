// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "curves.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/number_text.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

/// \file
/// Orthographic drawings of solids: shapes on the page, sorted by depth.

namespace example {

using point = Eigen::Vector3d;

/// Linear interpolation between two colours `#rrggbb`.
[[nodiscard]] inline std::string mixed(const std::string& from, const std::string& to,
                                       double fraction) {
  std::string text = "#";
  for (std::size_t i = 1; i < 7; i += 2) {
    const auto part = [&](const std::string& c) { return std::stoi(c.substr(i, 2), nullptr, 16); };
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x",
                  unsigned(std::lround(std::lerp(part(from), part(to), fraction))) & 255U);
    text += digits;
  }
  return text;
}

/// An orthographic view, z up, from a direction that is not z.
class drawing {
public:
  explicit drawing(const point& from) {
    const point towards = from.normalized();
    const point right = point::UnitZ().cross(towards).normalized();
    axes_ << right.transpose(), towards.cross(right).transpose(), towards.transpose();
  }

  /// Coordinates to the right, upwards, and towards the viewer.
  [[nodiscard]] point seen(const point& x) const { return axes_ * x; }

  /// All points within a radius of a line segment, lit from above left.
  /// \param shift  added to the depth, towards the viewer
  void capsule(const point& from, const point& to, double radius, const std::string& colour,
               double shift = 0) {
    const point a = seen(from), b = seen(to);
    const double depth = (a[2] + b[2]) / 2 + shift;
    area(stadium(a, b, radius), depth, colour);
    constexpr int layers = 10;
    for (int i = 1; i < layers; ++i) {
      const double part = double(i) / layers;
      const point light(-.3 * part * radius, .3 * part * radius, 0);
      area(stadium(a + light, b + light, radius * (1 - part)), depth,
           mixed(colour, "#ffffff", .5 * part));
    }
    auto edge = stadium(a, b, radius);
    edge.push_back(edge.front());
    add(edge, depth, "with lines lw .7 lc rgb '" + mixed(colour, "#000000", .4) + "'");
  }
  void ball(const point& centre, double radius, const std::string& colour) {
    capsule(centre, centre, radius, colour);
  }

  /// A polygon in space.
  void face(const std::vector<point>& corners, const std::string& colour) {
    std::vector<point> outline;
    double depth = 0;
    for (const point& x : corners) {
      outline.push_back(seen(x));
      depth += outline.back()[2] / double(corners.size());
    }
    area(outline, depth, colour);
  }

  /// \param style  of gnuplot: `lw 2 dt 2`
  /// \param shift  added to the depth, towards the viewer
  void line(const std::vector<point>& points, const std::string& colour,
            const std::string& style = "lw 2", double shift = 0) {
    std::vector<point> on_page;
    double depth = shift;
    for (const point& x : points) {
      on_page.push_back(seen(x));
      depth += on_page.back()[2] / double(points.size());
    }
    add(on_page, depth, "with lines lc rgb '" + colour + "' " + style);
  }

  /// An arrow in front of all shapes.
  void arrow(const point& from, const point& to, const std::string& colour,
             const std::string& style = "lw 3") {
    const point a = seen(from), b = seen(to);
    arrows_ += "set arrow from " + page_position(a) + " to " + page_position(b) +
               " size screen .014,18 filled front lc rgb '" + colour + "' " + style + "\n";
    include(a);
    include(b);
  }

  /// A circle about a point, as the outline of a ball is seen.
  void circle(const point& centre, double radius, const std::string& colour,
              const std::string& style) {
    const point c = seen(centre);
    auto outline = stadium(c, c, radius);
    outline.push_back(outline.front());
    add(outline, c[2] + radius, "with lines lc rgb '" + colour + "' " + style);
  }

  /// The shapes as x, y on the page, the farthest first, separated by two empty lines.
  [[nodiscard]] std::string csv() const {
    std::string result = "x,y\n";
    for (const shape& s : in_order()) {
      for (const point& x : s.outline) {
        result += duet::csv_line({x[0], x[1]});
      }
      result += "\n\n";
    }
    return result;
  }

  /// The gnuplot script that shows the drawing.
  /// \param file  path of the output of `csv`
  [[nodiscard]] std::string script(const std::string& file) const {
    const auto range = [&](int i) {
      return " [" + duet::to_text(low_[i]) + ":" + duet::to_text(high_[i]) + "]\n";
    };
    std::string result = "unset border\nunset tics\nunset grid\nset size ratio -1\nset xrange" +
                         range(0) + "set yrange" + range(1) + arrows_ + "plot ";
    std::size_t i = 0;
    for (const shape& s : in_order()) {
      result += (i > 0 ? ", \\\n     " : "") + in_quotes(file) + " index " + std::to_string(i) +
                " using 1:2 skip 1 " + s.style;
      ++i;
    }
    return result + "\nunset arrow\nunset label\n";
  }

  /// A point on the page in the syntax of gnuplot.
  [[nodiscard]] std::string at(const point& x) const { return page_position(seen(x)); }

private:
  struct shape {
    std::vector<point> outline; ///< as seen
    double depth;
    std::string style;
  };

  static std::string page_position(const point& x) {
    return duet::to_text(x[0]) + "," + duet::to_text(x[1]);
  }

  static std::vector<point> stadium(const point& a, const point& b, double radius) {
    const double along = std::atan2(b[1] - a[1], b[0] - a[0]);
    std::vector<point> result;
    constexpr int steps = 32;
    for (int end = 0; end < 2; ++end) {
      for (int i = 0; i <= steps; ++i) {
        const double angle = along + std::numbers::pi * (.5 + end + double(i) / steps);
        result.push_back((end == 0 ? a : b) + radius * point(std::cos(angle), std::sin(angle), 0));
      }
    }
    return result;
  }

  void area(const std::vector<point>& outline, double depth, const std::string& colour) {
    add(outline, depth, "with filledcurves closed fc rgb '" + colour + "'");
  }

  void add(const std::vector<point>& outline, double depth, const std::string& style) {
    shapes_.push_back({outline, depth, style});
    for (const point& x : outline) {
      include(x);
    }
  }

  void include(const point& x) {
    low_ = low_.cwiseMin(x.head<2>());
    high_ = high_.cwiseMax(x.head<2>());
  }

  [[nodiscard]] std::vector<shape> in_order() const {
    std::vector<shape> result = shapes_;
    std::stable_sort(result.begin(), result.end(),
                     [](const shape& a, const shape& b) { return a.depth < b.depth; });
    return result;
  }

  Eigen::Matrix3d axes_;
  std::vector<shape> shapes_;
  std::string arrows_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high_ = -low_;
};

} // namespace example
