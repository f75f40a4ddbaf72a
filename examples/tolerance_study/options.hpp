// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../support/command_line.hpp"
#include "../support/numbers.hpp"

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

/// \file
/// The command line.

namespace tolerance_study {

struct options {
  int samples = 10000;
  double tolerance = 5e-4;
  double lowest = -0.1, highest = 0.1;
  int rows = 9;
  std::uint64_t seed = 1;
  std::optional<unsigned> threads;
  bool summary_only = false;
  std::optional<std::string> hardpoints;
  std::string out = "tolerance_study_out";
};

/// Nothing where only help was asked for.
/// \throws std::exception with a one-line message
inline std::optional<options> parse_options(int argc, char** argv) {
  example::option_list description(
      "How errors of a wheel carrier's ten hardpoints move toe-in and camber: to first order by "
      "exact\nsensitivities, and by samples that are solved anew. Samples are kept in blocks of "
      "256; what was\ncomputed before, by any number of processes (mpirun) or threads, is not "
      "computed again.\nOptions");
  description.flag("help", "print this and stop")
      .value<int>("samples", "N", "how many (default: 10000)")
      .value<double>(
          "tolerance", "M",
          "standard deviation of every coordinate of every hardpoint, metres, normally distributed "
          "and independent (default: 0.0005)")
      .value<std::string>("travel", "LOW,HIGH",
                          "lowest and highest wheel height, metres (default: -0.1,0.1)")
      .value<int>("rows", "N", "heights from LOW to HIGH (default: 9)")
      .value<std::string>("hardpoints", "FILE",
                          "another carrier: five lines `name, ax, ay, az, px, py, pz` (chassis and "
                          "carrier end of a "
                          "rod) and one `wheel centre, x, y, z`")
      .value<long long>("seed", "N", "of the random numbers (default: 1)")
      .value<int>("threads", "N", "in every process; 0: one per core (default: 0, under mpirun 1)")
      .flag("summary", "compute no samples: say which are missing, or summarise them")
      .value<std::string>(
          "out", "DIR",
          "folder for samples, tables and the picture (default: tolerance_study_out)");
  const auto given = example::command_line::parse(argc, argv, description);
  if (!given) {
    return std::nullopt;
  }
  options result;
  result.samples = given->get<int>("samples").value_or(result.samples);
  result.tolerance = given->get<double>("tolerance").value_or(result.tolerance);
  result.rows = given->get<int>("rows").value_or(result.rows);
  result.hardpoints = given->text("hardpoints");
  result.summary_only = given->has("summary");
  result.out = given->text("out").value_or(result.out);
  if (result.samples < 2 || result.samples > 10000000) {
    throw std::runtime_error("--samples: from 2 to 10000000");
  }
  if (!(result.tolerance > 0 && result.tolerance <= 0.05)) {
    throw std::runtime_error("--tolerance: more than 0, at most 0.05 m");
  }
  if (const auto travel = given->text("travel")) {
    const auto ends = example::parse_numbers("--travel", *travel);
    if (ends.size() != 2 || !(ends[0] < ends[1])) {
      throw std::runtime_error("--travel: two heights expected, the lower first");
    }
    result.lowest = ends[0];
    result.highest = ends[1];
  }
  if (result.rows < 2 || result.rows > 1000) {
    throw std::runtime_error("--rows: from 2 to 1000");
  }
  if (const auto seed = given->get<long long>("seed")) {
    if (*seed < 0) {
      throw std::runtime_error("--seed: 0 or more");
    }
    result.seed = std::uint64_t(*seed);
  }
  if (const auto threads = given->get<int>("threads")) {
    if (*threads < 0 || *threads > 1024) {
      throw std::runtime_error("--threads: from 0 to 1024");
    }
    result.threads = unsigned(*threads);
  }
  return result;
}

} // namespace tolerance_study
