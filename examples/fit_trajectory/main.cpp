// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Recorded motion, smoothed: a cumulative B-spline of poses near the rows of a file, by robust
// least squares. Velocities and accelerations are the curve's own, exact derivatives, not
// differences.

#include "options.hpp"
#include "smoothing.hpp"
#include "trajectory.hpp"

#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"
#include <duet/core/text/file.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/spline/recording.hpp>

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>

namespace fit_trajectory {
namespace {

void print_faults(const recording& r, const std::string& path) {
  if (!r.remark.empty()) {
    std::cerr << duet::printable(path) << ": " << r.remark << "\n";
  }
  constexpr std::size_t most = 20;
  for (std::size_t i = 0; i < r.faults.size() && i < most; ++i) {
    const duet::recording_issue& each = r.faults[i];
    std::cerr << duet::printable(path + ":" + std::to_string(each.line) + ": " + each.reason)
              << "\n";
  }
  if (r.faults.size() > most) {
    std::cerr << duet::printable(path) << ": and " << r.faults.size() - most << " more\n";
  }
}

void run(const options& given) {
  example::require_folder(given.out);
  const recording r = given.file
                          ? duet::load_recording<duet::screw_dual<double>>(*given.file, given.times)
                          : made_up_recording();
  if (given.file) {
    print_faults(r, *given.file);
  }
  const auto rows_per_knot = std::size_t(given.rows_per_knot);
  const std::size_t rows = r.lines.size();
  if (rows < rows_per_knot + 4) {
    throw std::runtime_error(given.file.value_or("the made-up recording") + ": " +
                             std::to_string(rows) + " usable rows are too few for one knot in " +
                             std::to_string(rows_per_knot));
  }
  const double duration = r.table.parameters.back();
  const double rate = rate_for(duration, given.rate);
  std::cout << rows << " rows over " << duration << " s: fitting\n" << std::flush;
  const smoothed s = smooth(r, rows_per_knot, given.length, given.outlier);

  std::filesystem::create_directories(given.out);
  duet::write_file(given.out + "/trajectory.csv", trajectory_csv(r, s.fit.curve, rate));
  duet::write_file(given.out + "/rows.csv", rows_csv(r, s));
  const bool drawn =
      example::draw(given.out, "fit", 520,
                    picture_script(r.start, duration, s, rows, std::size_t(duration * rate)));
  std::cout << "Tables" << (drawn ? " and picture (SVG, PNG)" : "") << " are in "
            << duet::printable(given.out) << "\n";
  if (!drawn) {
    std::cout << "No picture: gnuplot is not installed\n";
  }
  std::printf("fit trajectory: rows=%zu left_out=%zu controls=%zu outliers=%zu "
              "median_residual=%.3g rms=%.3g\n",
              rows, r.left_out, s.fit.curve.control_points().size(), outliers(s),
              median(s.fit.residuals), s.fit.rms);
}

} // namespace
} // namespace fit_trajectory

int main(int argc, char** argv) {
  return example::run_program("fit_trajectory", [&] {
    if (const auto given = fit_trajectory::parse_options(argc, argv)) {
      fit_trajectory::run(*given);
    }
    return 0;
  });
}
