// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Smoothing of recorded motion: a cumulative B-spline of poses is fitted to the samples of a file
// by robust least squares. Velocities and accelerations are exact derivatives of the curve instead
// of finite differences.

#include "options.hpp"
#include "smoothing.hpp"
#include "trajectory.hpp"

#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"
#include <duet/core/text/file.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/io/recording.hpp>

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>

namespace fit_trajectory {
namespace {

void print_issues(const recording& r, const std::string& path) {
  if (!r.remark.empty()) {
    std::cerr << duet::printable(path) << ": " << r.remark << "\n";
  }
  constexpr std::size_t max_printed = 20;
  for (std::size_t i = 0; i < r.faults.size() && i < max_printed; ++i) {
    const duet::recording_issue& each = r.faults[i];
    std::cerr << duet::printable(path + ":" + std::to_string(each.line) + ": " + each.reason)
              << "\n";
  }
  if (r.faults.size() > max_printed) {
    std::cerr << duet::printable(path) << ": and " << r.faults.size() - max_printed << " more\n";
  }
}

void run(const options& settings) {
  example::require_folder(settings.out);
  const recording r =
      settings.file ? duet::load_recording<duet::screw_dual<double>>(*settings.file, settings.times)
                    : synthetic_recording();
  if (settings.file) {
    print_issues(r, *settings.file);
  }
  const auto samples_per_knot = std::size_t(settings.samples_per_knot);
  const std::size_t rows = r.lines.size();
  if (rows < samples_per_knot + 4) {
    throw std::runtime_error(settings.file.value_or("the synthetic recording") + ": " +
                             std::to_string(rows) + " usable rows (expected at least " +
                             std::to_string(samples_per_knot + 4) + " for --samples-per-knot " +
                             std::to_string(samples_per_knot) + ")");
  }
  const double duration = r.table.parameters.back();
  const double rate = rate_for(duration, settings.rate);
  std::cout << rows << " rows over " << duration << " s: fitting\n" << std::flush;
  const smoothed s =
      smooth(r, samples_per_knot, settings.characteristic_length, settings.outlier_threshold);

  if (!s.fit.remark.empty()) {
    std::cerr << s.fit.remark << " (--samples-per-knot)\n";
  }

  std::filesystem::create_directories(settings.out);
  duet::write_file(settings.out + "/trajectory.csv", trajectory_csv(r, s.fit, rate));
  duet::write_file(settings.out + "/rows.csv", rows_csv(r, s));
  const bool drawn =
      example::draw(settings.out, "fit", 520,
                    picture_script(r.start, duration, s, rows, std::size_t(duration * rate)));
  std::cout << "Tables" << (drawn ? " and picture (SVG, PNG)" : "") << " are in "
            << duet::printable(settings.out) << "\n";
  if (!drawn) {
    std::cout << "No picture: gnuplot is not installed\n";
  }
  std::printf("fit trajectory: rows=%zu left_out=%zu controls=%zu outliers=%zu "
              "median_residual=%.3g rms=%.3g inlier_rms=%.3g\n",
              rows, r.left_out, s.fit.curve.control_points().size(), outliers(s),
              median(s.fit.residuals), s.fit.rms, s.fit.inlier_rms);
}

} // namespace
} // namespace fit_trajectory

int main(int argc, char** argv) {
  return example::run_program("fit_trajectory", [&] {
    if (const auto settings = fit_trajectory::parse_options(argc, argv)) {
      fit_trajectory::run(*settings);
    }
    return 0;
  });
}
