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
      throw std::runtime_error("--end-rates: '" + cell + "' is not a finite number");
    }
    if (count < 6) {
      x[count] = *number;
    }
  }
  if (count != 6) {
    throw std::runtime_error("--end-rates: six numbers expected, got " + std::to_string(count));
  }
  return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
}

/// Nothing where only help was asked for.
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
                          "carrier only where --hardpoints is given too")
      .value<int>(
          "rows", "N",
          "rows of the table made from the carrier, at equal arcs (default: 0.003 rad apart)")
      .value<std::string>(
          "spline", "cumulative|rotation-vector|quintic",
          "the curve: the paper's, or one of piecewise polynomial rotation vectors (default: "
          "cumulative)")
      .value<std::string>("ends", "natural|clamped|acceleration|not-a-knot|both",
                          "end conditions (default: clamped where end rates are known, else "
                          "natural); both velocity "
                          "and acceleration are for the quintic")
      .value<std::string>(
          "end-rates", "X,Y,Z,X,Y,Z",
          "angular velocity per unit of u at the first and the last row (default: the carrier's)")
      .value<std::string>("out", "DIR",
                          "folder for tables and pictures (default: wheel_carrier_out)");
  const auto given = example::command_line::parse(argc, argv, description);
  if (!given) {
    return std::nullopt;
  }
  options result;
  result.table = given->text("table");
  result.hardpoints = given->text("hardpoints");
  result.ends = given->text("ends");
  result.out = given->text("out").value_or(result.out);
  result.rows = given->get<int>("rows");
  if (const auto rates = given->text("end-rates")) {
    result.rates = parse_end_rates(*rates);
  }
  result.spline = given->text("spline").value_or(result.spline);
  const auto is_one_of = [](const std::string& name, std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (result.ends &&
      !is_one_of(*result.ends, {"natural", "clamped", "acceleration", "not-a-knot", "both"})) {
    throw std::runtime_error("--ends: '" + *result.ends +
                             "' is neither natural nor clamped, acceleration, not-a-knot, both");
  }
  if (!is_one_of(result.spline, {"cumulative", "rotation-vector", "quintic"})) {
    throw std::runtime_error("--spline: '" + result.spline +
                             "' is neither cumulative nor rotation-vector, quintic");
  }
  if (result.ends == "both" && result.spline != "quintic") {
    throw std::runtime_error("--ends both is for --spline quintic");
  }
  if (result.rows && *result.rows < 3) {
    throw std::runtime_error("--rows: 3 or more");
  }
  if (result.rows && result.table) {
    throw std::runtime_error("--rows and --table exclude each other");
  }
  if (result.rates && result.ends && *result.ends != "clamped" && *result.ends != "both") {
    throw std::runtime_error("--end-rates and --ends " + *result.ends + " exclude each other");
  }
  return result;
}

} // namespace wheel_carrier
