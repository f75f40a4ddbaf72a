// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A wheel carrier runs over a bump, simulated four times: with the constraints of its five rods
// solved in every step, and with a lookup table of poses interpolated by two splines and by screw
// motions from row to row.

#include "models.hpp"
#include "ride.hpp"

#include "../support/command_line.hpp"
#include "../support/curves.hpp"
#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"
#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>

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
  example::option_list description(
      "A wheel carrier with one degree of freedom runs over a bump: constraints solved in every "
      "step,\ncompared with a lookup table of poses (ride.csv, pictures). Options");
  description.flag("help", "print this and stop")
      .value<int>("rows", "N", "rows of the lookup table (default: 105)")
      .value<double>("duration", "S", "duration of the ride (default: 0.6)")
      .value<double>("step", "S", "step of the integration (default: 0.0002)")
      .value<double>("bump", "M", "height of the bump (default: 0.05)")
      .value<std::string>("out", "DIR",
                          "folder for the table and the pictures (default: bump_ride_out)");
  const auto arguments = example::command_line::parse(argc, argv, description);
  if (!arguments) {
    return std::nullopt;
  }
  options result;
  result.rows = arguments->get<int>("rows").value_or(result.rows);
  result.duration = arguments->get<double>("duration").value_or(result.duration);
  result.step = arguments->get<double>("step").value_or(result.step);
  result.bump = arguments->get<double>("bump").value_or(result.bump);
  result.out = arguments->text("out").value_or(result.out);
  if (result.rows < 4) {
    throw std::runtime_error("--rows is " + std::to_string(result.rows) + " (expected at least 4)");
  }
  if (!(result.step > 0) || !(result.duration >= result.step) || !std::isfinite(result.duration)) {
    throw std::runtime_error("--step is " + duet::to_text(result.step) + ", --duration is " +
                             duet::to_text(result.duration) + " (expected 0 < step <= duration)");
  }
  if (!(result.bump >= 0 && result.bump <= 0.1)) {
    throw std::runtime_error("--bump is " + duet::to_text(result.bump) +
                             " (expected 0 to 0.1 m, the range of the carrier)");
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

/// Top: the ride. Bottom: differences between tables and mechanism, and of the energy from its
/// start.
std::string picture_script(const std::vector<result>& results) {
  const char* const colours[] = {"ink", "vermillion", "blue", "purple"};
  using enum example::label_position;
  const std::size_t rows = results.front().samples.size();
  const auto column = [](std::size_t result, std::size_t of_result) {
    return "$" + std::to_string(3 + 3 * result + of_result);
  };
  std::string names;
  std::vector<example::named_line> differences, energies;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const auto position = k == 2 || k == 0 ? below : above;
    if (k > 0) {
      differences.push_back(
          {"1:(1000*abs(" + column(k, 0) + "-$3))", colours[k], "", 0, right, "lines lw 1.5"});
      const char* const positions[] = {"", ".02,.06 left", ".98,.13 right", ".98,.94 right"};
      names += "set label " + example::in_quotes(results[k].name) + " at graph " + positions[k] +
               " front tc rgb " + colours[k] + "\n";
    }
    // The ride without a table is as good as by the rotation-vector spline.
    energies.push_back({"1:(abs(" + column(k, 2) + "))", colours[k],
                        k == 0 ? "" : results[k].name + (k == 2 ? ", constraints" : ""),
                        3 * rows / 5, position});
  }
  return "set multiplot layout 2,2 title " +
         example::title("Splines of a table ride within " +
                        example::two_digits(1e9 * height_difference(results[1], results[0])) +
                        " nm of the mechanism, screws within " +
                        example::two_digits(1e3 * height_difference(results[3], results[0])) +
                        " mm") +
         "\nset lmargin 9\nset rmargin 3\nset xrange [*:*] noextend\nset xtics .2\n"
         "set ylabel 'height / mm'\nset ytics 20\n" +
         example::plot_command(
             "ride.csv",
             {{"1:(1000*$3)", "blue", "wheel centre", rows / 5, above_right, "lines lw 3"},
              {"1:(1000*$2)", "ink", "road", rows / 8, above_left, "lines lw 2 dt 2"}}) +
         "set ylabel 'toe-in / degrees'\nset ytics .05\n" +
         example::plot_command("ride.csv",
                               {{"1:4", "blue", "carrier", rows / 5, above_right, "lines lw 3"}}) +
         "set xlabel 'time / s'\nset logscale y\nset format y '10^{%T}'\nset ytics 1e3\n"
         "set ylabel 'height, difference / mm'\nset yrange [1e-16:1e2]\n" +
         names + example::plot_command("ride.csv", differences) +
         "unset label\nset ylabel 'energy, difference / J'\nset yrange [1e-10:1e3]\n" +
         example::plot_command("ride.csv", energies) + "unset multiplot\n";
}

void run(const options& settings) {
  example::require_folder(settings.out);
  const wheel_carrier::carrier mechanism(wheel_carrier::example_hardpoints());
  vehicle v;
  v.bump_height = settings.bump;
  const pose_table table = make_table(mechanism, settings.rows);
  std::cout << "Table of " << settings.rows << " rows; simulating\n" << std::flush;
  std::vector<result> results;
  const auto ride_with = [&](const char* name, const auto& model) {
    results.push_back(run_over_bump(name, model, v, settings.duration, settings.step));
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
  std::filesystem::create_directories(settings.out);
  duet::write_file(settings.out + "/ride.csv", ride_csv(v, results));
  const bool drawn = example::draw(settings.out, "ride", 520, picture_script(results));
  std::cout << "Table" << (drawn ? " and picture (SVG, PNG)" : "") << " are in "
            << duet::printable(settings.out) << "\n";
  if (!drawn) {
    std::cout << "No picture: gnuplot is not installed\n";
  }
  std::printf("bump ride: rows=%d steps=%zu height_difference=%.3g energy_error=%.3g "
              "speed_up=%.3g\n",
              settings.rows, results[0].samples.size() - 1,
              height_difference(results[2], results[0]), energy_error(results[2]),
              results[0].seconds_per_step / results[2].seconds_per_step);
}

} // namespace
} // namespace bump_ride

int main(int argc, char** argv) {
  return example::run_program("bump_ride", [&] {
    if (const auto settings = bump_ride::parse_options(argc, argv)) {
      bump_ride::run(*settings);
    }
    return 0;
  });
}
