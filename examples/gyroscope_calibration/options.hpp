// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../support/command_line.hpp"

#include <duet/core/text/number_text.hpp>

#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

/// \file
/// The command line.

namespace gyroscope_calibration {

struct options {
  std::optional<std::string> file;
  double rate = 200;
  double noise = 1e-4;
  std::uint64_t seed = 1;
  std::string out = "gyroscope_calibration_out";
};

/// Returns nothing if only help was requested.
/// \throws std::exception with a one-line message
inline std::optional<options> parse_options(int argc, char** argv) {
  example::option_list description(
      "Calibrates a gyroscope whose motion is recorded: offset of its clock, bias and mounting "
      "rotation, with\nconfidence bounds. The readings are simulated, so that errors are known; "
      "the same problem is solved by\nCeres and by duet alone. Writes tables (readings.csv, "
      "errors.csv) and a picture.\n\n  gyroscope_calibration [FILE] [options]\n\nFILE is a "
      "recording of rotations or poses in CSV or in the formats of TUM, EuRoC and KITTI. Without "
      "FILE the\nmotion is synthetic: a minute by hand.\nOptions");
  description.flag("help", "print this and stop")
      .value<std::string>("file", "FILE", "the recording")
      .value<double>("rate", "HZ", "readings per second (default: 200)")
      .value<double>("noise", "W", "their standard deviation in rad/s (default: 1e-4)")
      .value<std::uint64_t>("seed", "N", "seed of the noise (default: 1)")
      .value<std::string>("out", "DIR", "folder for results (default: gyroscope_calibration_out)");
  const auto arguments = example::command_line::parse(argc, argv, description, "file");
  if (!arguments) {
    return std::nullopt;
  }
  options result;
  result.file = arguments->text("file");
  result.rate = arguments->get<double>("rate").value_or(result.rate);
  result.noise = arguments->get<double>("noise").value_or(result.noise);
  result.seed = arguments->get<std::uint64_t>("seed").value_or(result.seed);
  result.out = arguments->text("out").value_or(result.out);
  const auto require_positive = [](const std::string& name, double value) {
    if (!(value > 0) || !std::isfinite(value)) {
      throw std::runtime_error(name + " is " + duet::to_text(value) +
                               " (expected a positive number)");
    }
  };
  require_positive("--rate", result.rate);
  require_positive("--noise", result.noise);
  return result;
}

} // namespace gyroscope_calibration
