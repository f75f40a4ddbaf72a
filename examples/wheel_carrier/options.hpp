// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "carrier.hpp"

#include "../support/command_line.hpp"

#include <duet/core/text/number_text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

/// \file
/// The command line.

namespace wheel_carrier {

struct end_rates {
  vector3 start, end;
};

struct options {
  std::optional<std::string> table, hardpoints, ends;
  std::optional<int> rows;
  std::optional<end_rates> rates;
  std::string spline = "cumulative";
  std::string out = "wheel_carrier_out";
};

/// Six numbers, comma-separated.
inline end_rates parse_end_rates(const std::string& text) {
  std::istringstream cells(text);
  std::string cell;
  std::array<double, 6> x{};
  std::size_t count = 0;
  for (; std::getline(cells, cell, ','); ++count) {
    const auto number = duet::parse_number(cell);
    if (!number || !std::isfinite(*number)) {
      throw std::runtime_error("--end-velocities: '" + cell + "' is not a finite number");
    }
    if (count < 6) {
      x[count] = *number;
    }
  }
  if (count != 6) {
    throw std::runtime_error("--end-velocities: six numbers expected, got " +
                             std::to_string(count));
  }
  return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
}

/// Returns nothing if only help was requested.
/// \throws std::exception with a one-line message
inline std::optional<options> parse_options(int argc, char** argv) {
  example::option_list description(
      "Interpolates the orientations of a car's wheel carrier by a cumulative B-spline and "
      "compares its\n"
      "angular velocity and acceleration per unit of wheel height u with the mechanism's.\n"
      "Metres, radians; quaternions scalar first; rates in fixed axes. Options");
  description.flag("help", "print this and stop")
      .value<std::string>("hardpoints", "FILE",
                          "another carrier: five lines `name, ax, ay, az, px, py, pz` (chassis and "
                          "carrier end of a "
                          "rod) "
                          "and one `wheel centre, x, y, z`")
      .value<std::string>("table", "FILE",
                          "a look-up table of your own: a CSV file under the header "
                          "`u,qw,qx,qy,qz`, u increasing. Compared with the "
                          "carrier only where --hardpoints is given, too")
      .value<int>(
          "rows", "N",
          "rows of the table computed from the carrier, at equal arcs (default: 0.003 rad apart)")
      .value<std::string>(
          "spline", "cumulative|rotation-vector|quintic",
          "the curve: that of the paper, or piecewise polynomial rotation vectors (default: "
          "cumulative)")
      .value<std::string>("end-conditions", "natural|clamped|acceleration|not-a-knot|both",
                          "end conditions (default: clamped if end velocities are known, else "
                          "natural); `both`, velocity and acceleration, requires the quintic")
      .value<std::string>(
          "end-velocities", "X,Y,Z,X,Y,Z",
          "angular velocity per unit of u at the first and the last row (default: the carrier's)")
      .value<std::string>("out", "DIR",
                          "folder for tables and pictures (default: wheel_carrier_out)");
  const auto arguments = example::command_line::parse(argc, argv, description);
  if (!arguments) {
    return std::nullopt;
  }
  options result;
  result.table = arguments->text("table");
  result.hardpoints = arguments->text("hardpoints");
  result.ends = arguments->text("end-conditions");
  result.out = arguments->text("out").value_or(result.out);
  result.rows = arguments->get<int>("rows");
  if (const auto rates = arguments->text("end-velocities")) {
    result.rates = parse_end_rates(*rates);
  }
  result.spline = arguments->text("spline").value_or(result.spline);
  const auto is_one_of = [](const std::string& name, std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (result.ends &&
      !is_one_of(*result.ends, {"natural", "clamped", "acceleration", "not-a-knot", "both"})) {
    throw std::runtime_error("--end-conditions: '" + *result.ends +
                             "' (expected natural, clamped, acceleration, not-a-knot or both)");
  }
  if (!is_one_of(result.spline, {"cumulative", "rotation-vector", "quintic"})) {
    throw std::runtime_error("--spline: '" + result.spline +
                             "' (expected cumulative, rotation-vector or quintic)");
  }
  if (result.ends == "both" && result.spline != "quintic") {
    throw std::runtime_error("--end-conditions both requires --spline quintic");
  }
  if (result.rows && *result.rows < 3) {
    throw std::runtime_error("--rows is " + std::to_string(*result.rows) +
                             " (expected at least 3)");
  }
  if (result.rows && result.table) {
    throw std::runtime_error("--rows and --table exclude each other");
  }
  if (result.rates && result.ends && *result.ends != "clamped" && *result.ends != "both") {
    throw std::runtime_error("--end-velocities and --end-conditions " + *result.ends +
                             " exclude each other");
  }
  return result;
}

} // namespace wheel_carrier
