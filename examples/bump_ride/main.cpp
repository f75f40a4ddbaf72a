// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A wheel carrier runs over a bump, four times: with the constraints of its five rods solved in
// every step, and from a look-up table of poses, by two splines and by screw motions from row to
// row.

#include "models.hpp"
#include "ride.hpp"

#include "../support/command_line.hpp"
#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"
#include <duet/core/text/csv.hpp>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace bump_ride {
namespace {

struct options {
  int rows = 105;
  double duration = 0.6;
  double step = 2e-4;
  double bump = 0.05;
  std::string out = "bump_ride_out";
};

std::optional<options> parse_options(int argc, char** argv) {
  namespace po = example::po;
  po::options_description description(
      "A wheel carrier with one degree of freedom runs over a bump: constraints solved in every "
      "step\nagainst a look-up table of poses (ride.csv, pictures). Options");
  description.add_options()("help", "print this and stop")(
      "rows", po::value<int>()->value_name("N"), "rows of the table (default: 105)")(
      "duration", po::value<double>()->value_name("S"), "of the ride (default: 0.6)")(
      "step", po::value<double>()->value_name("S"), "of the integration (default: 0.0002)")(
      "bump", po::value<double>()->value_name("M"), "height of the bump (default: 0.05)")(
      "out", po::value<std::string>()->value_name("DIR"),
      "folder for the table and the pictures (default: bump_ride_out)");
  const auto given = example::command_line::parse(argc, argv, description);
  if (!given) {
    return std::nullopt;
  }
  options result;
  result.rows = given->get<int>("rows").value_or(result.rows);
  result.duration = given->get<double>("duration").value_or(result.duration);
  result.step = given->get<double>("step").value_or(result.step);
  result.bump = given->get<double>("bump").value_or(result.bump);
  result.out = given->text("out").value_or(result.out);
  if (result.rows < 4) {
    throw std::runtime_error("--rows: 4 or more");
  }
  if (!(result.step > 0) || !(result.duration >= result.step) || !std::isfinite(result.duration)) {
    throw std::runtime_error("--step and --duration: 0 < step <= duration expected");
  }
  if (!(result.bump >= 0 && result.bump <= 0.1)) {
    throw std::runtime_error("--bump: from 0 to 0.1 m, or the carrier leaves its range");
  }
  return result;
}

std::string ride_csv(const vehicle& v, const std::vector<result>& results) {
  std::vector<std::string> names{"t", "road"};
  for (const result& r : results) {
    for (const char* column : {"height ", "toe_in_deg ", "energy "}) {
      names.push_back(column + r.name);
    }
  }
  std::string text = duet::csv_header(names);
  for (std::size_t i = 0; i < results.front().samples.size(); ++i) {
    std::vector<double> numbers{results.front().samples[i].t,
                                road(v, results.front().samples[i].t)};
    for (const result& r : results) {
      const sample& s = r.samples[i];
      numbers.insert(numbers.end(), {s.height, s.toe_in, s.energy - r.samples.front().energy});
    }
    text += duet::csv_line(numbers);
  }
  return text;
}

std::string picture_script(const std::vector<result>& results) {
  const char* const colours[] = {"black", "#1f77b4", "#2ca02c", "#d62728"};
  std::string text =
      "set datafile separator ','\nset grid\nunset logscale\nset format y\n"
      "unset xlabel\nset multiplot layout 4,1\nset lmargin 12\nset rmargin 30\n"
      "set key outside right\nset ylabel 'height / m'\n"
      "plot 'ride.csv' using 1:2 skip 1 with lines lw 1.5 dt 2 lc rgb '#888888' title "
      "'road', 'ride.csv' using 1:3 skip 1 with lines lw 1.5 lc rgb 'black' title "
      "'wheel centre'\nset ylabel 'toe-in / degrees'\n"
      "plot 'ride.csv' using 1:4 skip 1 with lines lw 1.5 lc rgb 'black' title "
      "'carrier'\nset logscale y\nset format y '10^{%T}'\n"
      "set ylabel 'difference / m'\nplot ";
  for (std::size_t k = 1; k < results.size(); ++k) {
    const std::string column = std::to_string(3 * k + 3);
    text += "'ride.csv' using 1:(abs($" + column + "-$3)) skip 1 with lines lw 1.2 lc rgb '" +
            colours[k] + "' title '" + results[k].name + (k + 1 < results.size() ? "', " : "'\n");
  }
  text += "set ylabel 'energy error / J'\nset xlabel 'time / s'\nplot ";
  for (std::size_t k = 0; k < results.size(); ++k) {
    const std::string column = std::to_string(3 * k + 5);
    text += "'ride.csv' using 1:(abs($" + column + ")) skip 1 with lines lw 1.2 lc rgb '" +
            colours[k] + "' title '" + results[k].name + (k + 1 < results.size() ? "', " : "'\n");
  }
  return text + "unset multiplot\n";
}

void run(const options& given) {
  example::require_folder(given.out);
  const wheel_carrier::carrier mechanism(wheel_carrier::example_hardpoints());
  vehicle v;
  v.bump_height = given.bump;
  const pose_table table = make_table(mechanism, given.rows);
  std::cout << "Table of " << given.rows << " rows; riding\n" << std::flush;
  std::vector<result> results;
  const auto ride_with = [&](const char* name, const auto& model) {
    results.push_back(run_over_bump(name, model, v, given.duration, given.step));
  };
  ride_with("constraints", exact_model(mechanism));
  ride_with("cumulative B-spline", cumulative_model(table));
  ride_with("rotation-vector spline", rotation_vector_model(table));
  ride_with("screw by screw", screw_model(table));

  std::printf("%-24s %14s %20s %16s\n", "", "us per step", "height difference/m", "energy error");
  for (const result& r : results) {
    std::printf("%-24s %14.2f %20.2e %16.2e\n", r.name.c_str(), r.seconds_per_step * 1e6,
                height_difference(r, results.front()), energy_error(r));
  }
  std::filesystem::create_directories(given.out);
  duet::write_file(given.out + "/ride.csv", ride_csv(v, results));
  const bool drawn = example::draw(given.out, "ride", "1000,900", picture_script(results));
  std::cout << "Table" << (drawn ? " and picture (SVG, PNG)" : "") << " are in "
            << duet::printable(given.out) << "\n";
  if (!drawn) {
    std::cout << "No picture: gnuplot is not installed\n";
  }
  std::printf("bump ride: rows=%d steps=%zu height_difference=%.3g energy_error=%.3g "
              "speed_up=%.3g\n",
              given.rows, results[0].samples.size() - 1, height_difference(results[2], results[0]),
              energy_error(results[2]), results[0].seconds_per_step / results[2].seconds_per_step);
}

} // namespace
} // namespace bump_ride

int main(int argc, char** argv) {
  return example::run_program("bump_ride", [&] {
    if (const auto given = bump_ride::parse_options(argc, argv)) {
      bump_ride::run(*given);
    }
    return 0;
  });
}
