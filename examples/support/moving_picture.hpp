// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "drawing.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Animated SVG of a point that moves along a curve, with two velocities.

namespace example {

/// Position of the point at one instant, and its velocity by both formulas.
struct moving_point {
  point position, velocity, printed;
  double angle; ///< between both, degrees
};

/// The picture: a ball with the curve and the point on it, and the angle over time.
class moving_picture {
public:
  moving_picture(const drawing& view, std::vector<moving_point> instants)
      : view_(view), instants_(std::move(instants)) {
    for (const moving_point& each : instants_) {
      largest_ = std::max(largest_, each.angle);
    }
  }

  /// \param circles  on the ball, drawn if on the visible side
  [[nodiscard]] std::string svg(const std::vector<std::vector<point>>& circles) const {
    std::string result = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 660 400\" "
                         "font-family=\"sans-serif\" font-size=\"20\">\n"
                         "<rect width=\"660\" height=\"400\" fill=\"#ffffff\"/>\n" +
                         element("circle", "cx=\"210\" cy=\"200\" r=\"185\" fill=\"#f3f6f9\" " +
                                               stroke("#c4ccd4", 1.5));
    std::string grid;
    for (const auto& circle : circles) {
      grid += near_side(circle);
    }
    std::vector<point> curve, angles;
    for (const moving_point& each : instants_) {
      curve.push_back(on_page(each.position));
      angles.push_back(in_plot(each));
    }
    result += path(grid, "#dbe3ea", 1) + path(line(curve), "#24292f", 3) +
              path("M440 220V350H650", "#6e7781", 1.5) + path(line(angles), "#d55e00", 2.5);
    const auto label = [&](const char* attributes, const char* style, const std::string& text) {
      result += "<text " + std::string(attributes) + " " + style + ">" + text + "</text>\n";
    };
    char angle[8];
    std::snprintf(angle, sizeof angle, "%.0f°", largest_);
    label("x=\"430\" y=\"50\"", "fill=\"#24292f\" font-weight=\"bold\"", "A point's velocity");
    label("x=\"430\" y=\"84\"", "fill=\"#0072b2\"", "by the true derivative");
    label("x=\"430\" y=\"112\"", "fill=\"#d55e00\"", "by the printed formula");
    label("x=\"430\" y=\"190\"", "fill=\"#24292f\"", "The angle between them");
    label("x=\"434\" y=\"232\"", "fill=\"#6e7781\" text-anchor=\"end\" font-size=\"16\"", angle);
    label("x=\"434\" y=\"355\"", "fill=\"#6e7781\" text-anchor=\"end\" font-size=\"16\"", "0°");
    label("x=\"650\" y=\"375\"", "fill=\"#6e7781\" text-anchor=\"end\" font-size=\"16\"", "time");
    result += arrow(&moving_point::printed, "#d55e00") + arrow(&moving_point::velocity, "#0072b2");
    return result + dot(curve, 8, "#24292f") + dot(angles, 7, "#d55e00") + "</svg>\n";
  }

private:
  [[nodiscard]] point on_page(const point& x) const {
    const point seen = view_.seen(x);
    return {210 + 185 * seen[0], 200 - 185 * seen[1], seen[2]};
  }

  [[nodiscard]] point in_plot(const moving_point& instant) const {
    const auto i = double(&instant - instants_.data());
    return {440 + 210 * i / double(instants_.size() - 1), 350 - 125 * instant.angle / largest_, 0};
  }

  static std::string number(double x) {
    char digits[16];
    std::snprintf(digits, sizeof digits, "%.1f", x);
    return digits;
  }
  static std::string pair(const point& x) { return number(x[0]) + " " + number(x[1]); }

  static std::string line(const std::vector<point>& points) {
    std::string result;
    for (const point& x : points) {
      result += (result.empty() ? "M" : "L") + pair(x);
    }
    return result;
  }

  [[nodiscard]] std::string near_side(const std::vector<point>& circle) const {
    std::string result;
    bool is_drawn = false;
    for (const point& x : circle) {
      const point x_on_page = on_page(x);
      const bool is_seen = x_on_page[2] >= 0;
      if (is_seen) {
        result += (is_drawn ? "L" : "M") + pair(x_on_page);
      }
      is_drawn = is_seen;
    }
    return result;
  }

  static std::string stroke(const std::string& colour, double width) {
    return "stroke=\"" + colour + "\" stroke-width=\"" + number(width) + "\"";
  }
  static std::string element(const std::string& name, const std::string& attributes,
                             const std::string& inner = "") {
    return "<" + name + " " + attributes +
           (inner.empty() ? "/>\n" : ">" + inner + "</" + name + ">\n");
  }
  static std::string path(const std::string& outline, const std::string& colour, double width,
                          const std::string& inner = "") {
    return element("path",
                   "d=\"" + outline +
                       "\" fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\" " +
                       stroke(colour, width),
                   inner);
  }

  /// An attribute that takes the values in turn, repeatedly.
  static std::string moving(const std::string& attribute, const std::vector<std::string>& values) {
    std::string joined;
    for (const std::string& value : values) {
      joined += (joined.empty() ? "" : ";") + value;
    }
    return element("animate", "attributeName=\"" + attribute + "\" dur=\"15s\" " +
                                  "repeatCount=\"indefinite\" values=\"" + joined + "\"");
  }

  [[nodiscard]] std::string arrow(point moving_point::*velocity, const std::string& colour) const {
    std::vector<std::string> outlines;
    for (const moving_point& each : instants_) {
      const point from = on_page(each.position), to = on_page(each.position + .6 * each.*velocity);
      Eigen::Vector2d along = (to - from).head<2>();
      along *= 14 / std::max(along.norm(), 14.);
      const point back(-along[0], -along[1], 0), aside(-along[1] / 2, along[0] / 2, 0);
      outlines.push_back("M" + pair(from) + "L" + pair(to) + "M" + pair(to + back + aside) + "L" +
                         pair(to) + "L" + pair(to + back - aside));
    }
    return path(outlines.front(), colour, 4.5, moving("d", outlines));
  }

  static std::string dot(const std::vector<point>& centres, double radius,
                         const std::string& colour) {
    std::array<std::vector<std::string>, 2> values;
    for (const point& x : centres) {
      values[0].push_back(number(x[0]));
      values[1].push_back(number(x[1]));
    }
    return element("circle",
                   "cx=\"" + values[0].front() + "\" cy=\"" + values[1].front() + "\" r=\"" +
                       number(radius) + "\" fill=\"" + colour + "\"",
                   moving("cx", values[0]) + moving("cy", values[1]));
  }

  drawing view_;
  std::vector<moving_point> instants_;
  double largest_ = 0;
};

} // namespace example
