// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../support/command_line.hpp"
#include "../support/numbers.hpp"

#include <duet/core/text/number_text.hpp>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

/// \file
/// The command line.

namespace tolerance_study {

struct options {
  int samples = 10000;
  double deviation = 5e-4;
  double lowest = -0.1, highest = 0.1;
  int heights = 9;
  std::uint64_t seed = 1;
  std::optional<unsigned> threads;
  bool summary_only = false;
  std::optional<std::string> hardpoints;
  std::string out = "tolerance_study_out";
};

/// Returns nothing if only help was requested.
/// \throws std::exception with a one-line message
inline std::optional<options> parse_options(int argc, char** argv) {
  example::option_list description("Effect of errors of a wheel carrier's ten hardpoints on toe-in "
                                   "and camber: to first order, by "
                                   "exact\nsensitivities, and by solving the mechanism for random "
                                   "samples. Samples are stored in "
                                   "blocks of 256;\nblocks of an earlier run, by any number of "
                                   "processes (mpirun) or threads, are "
                                   "not computed again.\nOptions");
  description.flag("help", "print this and stop")
      .value<int>("samples", "N", "number of samples (default: 10000)")
      .value<double>(
          "std-dev", "M",
          "standard deviation of every coordinate of every hardpoint, metres, normally distributed "
          "and independent (default: 0.0005)")
      .value<std::string>("travel", "LOW,HIGH",
                          "lowest and highest wheel height, metres (default: -0.1,0.1)")
      .value<int>("heights", "N", "number of wheel heights from LOW to HIGH (default: 9)")
      .value<std::string>("hardpoints", "FILE",
                          "another carrier: five lines `name, ax, ay, az, px, py, pz` (chassis and "
                          "carrier end of a "
                          "rod) and one `wheel centre, x, y, z`")
      .value<long long>("seed", "N", "seed of the random numbers (default: 1)")
      .value<int>("threads", "N",
                  "threads in every process; 0: one per core (default: 0, under mpirun 1)")
      .flag("summary", "compute no samples: summarise them, or name the missing ones")
      .value<std::string>(
          "out", "DIR",
          "folder for samples, tables and the picture (default: tolerance_study_out)");
  const auto arguments = example::command_line::parse(argc, argv, description);
  if (!arguments) {
    return std::nullopt;
  }
  options result;
  result.samples = arguments->get<int>("samples").value_or(result.samples);
  result.deviation = arguments->get<double>("std-dev").value_or(result.deviation);
  result.heights = arguments->get<int>("heights").value_or(result.heights);
  result.hardpoints = arguments->text("hardpoints");
  result.summary_only = arguments->has("summary");
  result.out = arguments->text("out").value_or(result.out);
  if (result.samples < 2 || result.samples > 10000000) {
    throw std::runtime_error("--samples is " + std::to_string(result.samples) +
                             " (expected 2 to 10000000)");
  }
  if (!(result.deviation > 0 && result.deviation <= 0.05)) {
    throw std::runtime_error("--std-dev is " + duet::to_text(result.deviation) +
                             " (expected more than 0, at most 0.05 m)");
  }
  if (const auto travel = arguments->text("travel")) {
    const auto ends = example::parse_numbers("--travel", *travel);
    if (ends.size() != 2 || !(ends[0] < ends[1])) {
      throw std::runtime_error("--travel is " + *travel +
                               " (expected two heights, the lower first)");
    }
    result.lowest = ends[0];
    result.highest = ends[1];
  }
  if (result.heights < 2 || result.heights > 1000) {
    throw std::runtime_error("--heights is " + std::to_string(result.heights) +
                             " (expected 2 to 1000)");
  }
  if (const auto seed = arguments->get<long long>("seed")) {
    if (*seed < 0) {
      throw std::runtime_error("--seed is " + std::to_string(*seed) + " (expected at least 0)");
    }
    result.seed = std::uint64_t(*seed);
  }
  if (const auto threads = arguments->get<int>("threads")) {
    if (*threads < 0 || *threads > 1024) {
      throw std::runtime_error("--threads is " + std::to_string(*threads) +
                               " (expected 0 to 1024)");
    }
    result.threads = unsigned(*threads);
  }
  return result;
}

} // namespace tolerance_study
