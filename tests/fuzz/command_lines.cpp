// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../examples/fit_trajectory/options.hpp"
#include "../../examples/path_following/options.hpp"
#include "../../examples/screw_motion/options.hpp"
#include "../../examples/tolerance_study/options.hpp"
#include "../../examples/wheel_carrier/options.hpp"
#include "fuzz/seeded_loop.hpp"

#include <exception>
#include <iostream>

// Command lines of the examples: accepted options are within the ranges that --help states.

namespace test_fuzz_command_lines {
namespace {

using duet_fuzz::require;

void try_fit_trajectory(int argc, char** argv) {
  if (const auto options = fit_trajectory::parse_options(argc, argv)) {
    require(options->samples_per_knot >= 1, "a sample for each knot");
    for (const double x : {options->characteristic_length, options->outlier_threshold}) {
      require(x >= 0 && std::isfinite(x), "positive numbers");
    }
  }
}
void try_screw_motion(int argc, char** argv) {
  if (auto options = screw_motion::parse_options(argc, argv)) {
    require(options->steps >= 1, "a step");
    options->file.reset(); // is read by others
    for (const auto& pose :
         {screw_motion::poses(*options).first, screw_motion::poses(*options).second}) {
      require(std::abs(norm(duet::rotation(pose)) - 1) < 1e-12, "rotations");
    }
  }
}
void try_tolerance_study(int argc, char** argv) {
  if (const auto options = tolerance_study::parse_options(argc, argv)) {
    require(options->samples >= 2 && options->samples <= 10'000'000, "samples");
    require(options->deviation > 0 && options->deviation <= .05, "standard deviation");
    require(options->lowest < options->highest, "travel");
    require(options->heights >= 2 && options->heights <= 1000, "heights");
    require(options->threads.value_or(0) <= 1024, "threads");
  }
}
void try_path_following(int argc, char** argv) {
  if (const auto options = path_following::parse_options(argc, argv)) {
    require(options->start.size() == options->arm.size() && options->start.allFinite(), "joints");
    require(options->radius >= 0 && options->turns > 0 && std::isfinite(options->pitch), "a helix");
  }
}
void try_wheel_carrier(int argc, char** argv) {
  if (const auto options = wheel_carrier::parse_options(argc, argv)) {
    require(options->rows.value_or(3) >= 3, "rows");
    require(!options->rates ||
                (options->rates->start.allFinite() && options->rates->end.allFinite()),
            "rates");
  }
}

} // namespace

/// The first character is the program, each line an argument.
std::vector<std::string> seeds() {
  return {"f\nrows.txt\n--samples-per-knot\n5\n--rate\n200\n--outlier-threshold=0.1\n--out\nx",
          "f\n--characteristic-length\n1e3\n--help",
          "s\n--from\n0,0,0,1,0,0,0\n--to=1,2,3,0.6,0,0,0.8\n--steps\n9\n--longer-arc",
          "s\n--from\n1,0,0,0,0,1,0,0,0,0,1,0\n--to\n0,-1,0,3,1,0,0,2,0,0,1,1,0,0,0,1",
          "s\n--file\nposes.csv",
          "t\n--samples\n500\n--std-dev\n1e-3\n--travel=-0.1,0.05\n--heights\n4\n--seed\n7\n--"
          "threads\n2",
          "t\n--summary\n--hardpoints\nx.csv",
          "p\n--robot\nur5e\n--radius\n.1\n--pitch\n-.02\n--turns\n3",
          "p\n--joints\n0,-0.8,0,-2.4,0,1.6,0.8",
          "p\n--urdf\nnone.urdf\n--base\na\n--tip\nb\n--joints\n0",
          "w\n--rows\n30\n--spline\nquintic\n--end-conditions\nboth\n--end-velocities\n0,0.1,0,1e-"
          "3,0,-0.2",
          "f\n--rate\n%value%", // once went on for ever
          "w\n--table\nt.csv\n--end-conditions=not-a-knot"};
}

void target(const std::string& input) {
  std::vector<std::string> words{"program"};
  for (std::size_t i = 1; i < input.size();) {
    const std::size_t end = std::min(input.find('\n', i), input.size());
    words.push_back(input.substr(i, end - i).c_str()); // as the shell, up to the first zero
    i = end + 1;
  }
  if (words.size() > 1 && words[1].empty()) {
    words.erase(words.begin() + 1); // after the first character
  }
  std::vector<char*> argv;
  for (std::string& word : words) {
    argv.push_back(word.data());
  }
  argv.push_back(nullptr);
  const int argc = int(words.size());
  std::streambuf* const screen = std::cout.rdbuf(nullptr); // --help
  try {
    switch (input.empty() ? 'f' : input[0]) {
    case 's':
      try_screw_motion(argc, argv.data());
      break;
    case 't':
      try_tolerance_study(argc, argv.data());
      break;
    case 'p':
      try_path_following(argc, argv.data());
      break;
    case 'w':
      try_wheel_carrier(argc, argv.data());
      break;
    default:
      try_fit_trajectory(argc, argv.data());
    }
  } catch (const duet_fuzz::finding&) {
    throw;
  } catch (const std::exception& error) {
    require(*error.what() != '\0', "a message");
  }
  std::cout.rdbuf(screen);
  std::cout.clear();
}

TEST_CASE(
    "command lines of examples: mutated ones are accepted correctly or rejected with a message") {
  duet_fuzz::run_seeded(seeds(), target, 1500);
}

} // namespace test_fuzz_command_lines
