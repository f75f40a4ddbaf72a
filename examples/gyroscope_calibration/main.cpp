// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Calibration of a gyroscope on a curve through recorded motion: offset of its clock, bias and
// mounting rotation, by Ceres and by nonlinear_least_squares. calibration.hpp is to be taken away.

#include "calibration.hpp"
#include "options.hpp"
#include "simulation.hpp"

#include "../support/curves.hpp"
#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/printable.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace gyroscope_calibration {
namespace {

constexpr double max_offset = .05;
constexpr double quantile = 1.96; // of 95 %

/// Errors of offset (s), bias (rad/s) and rotation (rad), component by component.
Eigen::Matrix<double, 7, 1> errors_of(const calibration& found, const calibration& truth) {
  Eigen::Matrix<double, 7, 1> result;
  result << found.offset - truth.offset, found.bias - truth.bias,
      rotation_vector(conj(truth.sensor) * found.sensor);
  return result;
}

Eigen::Matrix<double, 7, 1> bounds_of(const calibration& found) {
  return quantile * found.covariance.diagonal().cwiseSqrt();
}

/// Two seconds of readings about the third axis, with what the curve predicts for them.
std::string readings_csv(const curve& motion, const std::vector<reading>& readings,
                         const calibration& found) {
  std::string csv = duet::csv_header({"time", "reading", "before", "after"});
  for (std::size_t i = 0; i < readings.size() && readings[i].time < readings[0].time + 2; ++i) {
    const auto predicted = [&](const calibration& c) {
      const auto omega = motion.motion(readings[i].time + c.offset, duet::frame::body).velocity;
      return vector3(rotate(conj(c.sensor), omega) + c.bias)[2];
    };
    csv += duet::csv_line(
        {readings[i].time, readings[i].omega[2], predicted(calibration()), predicted(found)});
  }
  return csv;
}

std::string picture_script(double seconds, double error, double bound) {
  using enum example::label_position;
  char text[120];
  std::snprintf(text, sizeof text,
                "After %.0f s the clock is known to %.1f microseconds, with an error of %.1f",
                seconds, 1e6 * bound, 1e6 * std::abs(error));
  return "set multiplot layout 1,2 title " + example::title(text) +
         "\nset lmargin at screen .09\nset rmargin at screen .47\nset xlabel 'time / s'\n"
         "set ylabel 'angular velocity about z / (rad/s)'\n" +
         example::plot_command(
             "readings.csv",
             {{"1:4", "blue", "calibrated", 180, above_right, "lines lw 2"},
              {"1:3", "vermillion", "not calibrated", 200, below_left, "lines lw 2"},
              {"1:($0 - 8*int($0/8) == 0 ? $2 : NaN)", "ink", "", 0, right, "points pt 7 ps .5"}}) +
         "set lmargin at screen .6\nset rmargin at screen .97\nset logscale xy\n"
         "set xlabel 'seconds of readings'\nset ylabel 'offset of the clock / s'\n"
         "set format y '10^{%T}'\n" +
         example::plot_command(
             "errors.csv",
             {{"1:(abs($2))", "vermillion", "error", 1, below_left, "points pt 7 ps .9"},
              {"1:3", "blue", "bound, 95 %", 2, above_right, "lines lw 2"}}) +
         "unset multiplot\n";
}

void run(const options& settings) {
  example::require_folder(settings.out);
  const curve motion = recorded_motion(settings.file);
  const double begin = motion.breaks().front() + max_offset,
               end = motion.breaks().back() - max_offset;
  if (!(end - begin > 1)) {
    throw std::runtime_error(settings.file.value_or("") + ": shorter than a second");
  }
  calibration truth;
  truth.offset = .0123456;
  truth.bias = vector3(.01, -.02, .005);
  truth.sensor = duet::from_rotation_vector(vector3(.3, -.5, 1.2));
  const auto readings =
      simulated(motion, truth, begin, end, settings.rate, settings.noise, settings.seed);

  const calibration ceres = by_ceres(motion, readings, max_offset);
  const calibration duet = by_duet(motion, readings, max_offset);
  const auto errors = errors_of(ceres, truth), bounds = bounds_of(ceres);
  const std::array names{"offset / s",       "bias x / (rad/s)", "bias y / (rad/s)",
                         "bias z / (rad/s)", "rotation x / rad", "rotation y / rad",
                         "rotation z / rad"};
  std::printf("%zu readings over %.1f s\n%-18s %12s %10s %14s\n", readings.size(), end - begin, "",
              "error", "95 %", "Ceres - duet");
  for (int i = 0; i < 7; ++i) {
    std::printf("%-18s %12.1e %10.1e %14.1e\n", names[std::size_t(i)], errors[i], bounds[i],
                errors_of(ceres, duet)[i]);
  }

  std::string csv = duet::csv_header({"seconds", "error", "bound"});
  for (double seconds = 1; seconds < 1.5 * (end - begin); seconds *= 2) {
    const double until = std::min(begin + seconds, end);
    std::vector<reading> first;
    std::copy_if(readings.begin(), readings.end(), std::back_inserter(first),
                 [&](const reading& each) { return each.time <= until; });
    const calibration found = by_ceres(motion, first, max_offset);
    csv += duet::csv_line({until - begin, found.offset - truth.offset, bounds_of(found)[0]});
  }
  std::filesystem::create_directories(settings.out);
  duet::write_file(settings.out + "/errors.csv", csv);
  duet::write_file(settings.out + "/readings.csv", readings_csv(motion, readings, ceres));
  const bool drawn = example::draw(settings.out, "gyroscope_calibration", 420,
                                   picture_script(end - begin, errors[0], bounds[0]));
  std::cout << "Tables" << (drawn ? " and picture (SVG, PNG)" : "") << " are in "
            << duet::printable(settings.out) << "\n";
  if (!drawn) {
    std::cout << "No picture: gnuplot is not installed\n";
  }
  const Eigen::Matrix<double, 7, 1> in_bounds = errors.cwiseAbs().cwiseQuotient(bounds);
  std::printf("gyroscope calibration: offset_error=%.1e largest_error_in_bounds=%.2f "
              "difference=%.1e bounds_differ_by=%.1e\n",
              std::abs(errors[0]), in_bounds.maxCoeff(),
              errors_of(ceres, duet).cwiseAbs().cwiseQuotient(bounds).maxCoeff(),
              (bounds_of(duet).cwiseQuotient(bounds).array() - 1).abs().maxCoeff());
}

} // namespace
} // namespace gyroscope_calibration

int main(int argc, char** argv) {
  return example::run_program("gyroscope_calibration", [&] {
    if (const auto settings = gyroscope_calibration::parse_options(argc, argv)) {
      gyroscope_calibration::run(*settings);
    }
    return 0;
  });
}
