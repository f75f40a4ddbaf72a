// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Manipulability of a robot arm in many random configurations within its limits, as a histogram and
// over the distance of the tip from the vertical axis and its height. Samples are computed in SIMD
// batches on all cores and do not depend on the machine. Ctrl-C ends the sweep; the results are
// then those of the configurations computed so far.

#include "support/arms.hpp"
#include "support/command_line.hpp"
#include "support/curves.hpp"
#include "support/folder.hpp"
#include "support/gnuplot.hpp"
#include "support/program.hpp"
#include "support/progress_line.hpp"

#include <duet/core/parallel_for.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/kinematics/sweep.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace duet;

using chain = example::arm_chain;
using coordinates = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 16, 1>;
using matrix = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 16>;
using result = value_and_jacobian<dual_quaternion<double>, matrix>;

struct sample {
  double radius; ///< of the tip from the vertical axis
  double height;
  double manipulability;
};

/// The n-th number of a pseudo-random sequence in [0, 1) (splitmix64). It depends on n alone, so
/// that samples do not depend on the core that computes them.
double uniform(std::uint64_t n) {
  std::uint64_t x = (n + 1) * 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return double((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

coordinates configuration(const chain& arm, std::size_t number) {
  coordinates theta(arm.size());
  for (int j = 0; j < arm.size(); ++j) {
    const double lower = std::max(arm.limits(j).lower, -std::numbers::pi);
    const double upper = std::min(arm.limits(j).upper, std::numbers::pi);
    theta[j] = lower + (upper - lower) * uniform(16 * number + std::uint64_t(j));
  }
  return theta;
}

/// √det(J Jᵀ)
double manipulability_of(const matrix& m) {
  const Eigen::Matrix<double, 6, 6> square = m.lazyProduct(m.transpose());
  return std::sqrt(std::max(0.0, square.determinant()));
}

volatile std::sig_atomic_t is_interrupted = 0;

/// The requested number of samples, or fewer if Ctrl-C interrupts the sweep.
std::vector<sample> sweep(const chain& arm, std::size_t count) {
  std::vector<sample> samples(count);
  const auto sweep_block = [&](std::size_t first, std::size_t last) {
    std::vector<coordinates> theta;
    for (std::size_t i = first; i < last; ++i) {
      theta.push_back(configuration(arm, i));
    }
    std::vector<result> results(theta.size(), result{{}, matrix(6, arm.size())});
    poses_and_jacobians(arm, theta, frame::hybrid, results);
    for (std::size_t i = first; i < last; ++i) {
      const auto& [pose, jacobian] = results[i - first];
      const auto t = translation(pose);
      samples[i] = {std::hypot(t[0], t[1]), t[2], manipulability_of(jacobian)};
    }
  };
  example::progress_line line("configurations");
  const auto report = [&](const progress& p) {
    line(p);
    return is_interrupted == 0;
  };
  const auto previous_handler = std::signal(SIGINT, [](int) { is_interrupted = 1; });
  if (previous_handler == SIG_IGN) { // in the background: stays so
    std::signal(SIGINT, SIG_IGN);
  }
  try {
    parallel_for_blocks(count, sweep_block, {.threads = 0, .report = report}, 1024);
  } catch (const cancelled& early) {
    samples.resize(early.completed());
  }
  std::signal(SIGINT, previous_handler);
  return samples;
}

/// Fractions of the samples in bins of equal width from 0 to the largest manipulability.
std::string histogram(const std::vector<sample>& samples, double largest) {
  constexpr std::size_t bins = 40;
  std::vector<std::size_t> counts(bins);
  for (const sample& s : samples) {
    ++counts[std::min(bins - 1, std::size_t(s.manipulability / largest * double(bins)))];
  }
  std::string csv = "manipulability,share\n";
  for (std::size_t i = 0; i < bins; ++i) {
    csv += csv_line(
        {largest * (double(i) + 0.5) / double(bins), double(counts[i]) / double(samples.size())});
  }
  return csv;
}

/// Cells that the tip reached, with the largest manipulability in each.
std::string map(const std::vector<sample>& samples) {
  constexpr double cell = 0.02;
  double reach = 0;
  for (const sample& s : samples) {
    reach = std::max({reach, s.radius, std::abs(s.height)});
  }
  const std::size_t columns = std::size_t(reach / cell) + 1, rows = 2 * columns;
  std::vector<double> best(columns * rows, -1);
  for (const sample& s : samples) {
    const auto column = std::size_t(s.radius / cell);
    const auto row = std::size_t(s.height / cell + double(columns));
    double& value = best[std::min(rows - 1, row) * columns + column];
    value = std::max(value, s.manipulability);
  }
  std::string csv = "radius,height,largest manipulability\n";
  for (std::size_t i = 0; i < best.size(); ++i) {
    if (best[i] >= 0) {
      csv += csv_line({cell * (double(i % columns) + 0.5),
                       cell * (double(i / columns) + 0.5 - double(columns)), best[i]});
    }
  }
  return csv;
}

std::string picture_script() {
  return "set multiplot layout 1,2 title " +
         example::title("Where the arm moves well, and how often it does") +
         "\nset xtics .2\nset xlabel 'distance from the axis / m'\nset ylabel 'height / m'\n"
         "set size ratio -1\nset palette defined (0 '#f0f4f8', .5 '#56b4e9', 1 '#003a5c')\n"
         "set cblabel 'largest manipulability' textcolor rgb ink\n"
         "plot 'workspace_sweep_map.csv' skip 1 using 1:2:3 with points pt 5 ps .5 palette\n"
         "set size noratio\nset xtics .04\nset xlabel 'manipulability'\n"
         "set ylabel 'share of configurations / %'\nset boxwidth .9 relative\n"
         "plot 'workspace_sweep_histogram.csv' skip 1 using 1:(100*$2) with boxes lc rgb blue\n"
         "unset multiplot\n";
}

void run(const chain& arm, std::size_t requested, const std::string& folder) {
  example::require_folder(folder);
  const std::vector<sample> samples = sweep(arm, requested);
  const std::size_t count = samples.size();
  double sum = 0, largest = 0;
  std::size_t best = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sum += samples[i].manipulability;
    if (samples[i].manipulability > largest) {
      largest = samples[i].manipulability;
      best = i;
    }
  }
  std::filesystem::create_directories(folder);
  write_file(folder + "/workspace_sweep_histogram.csv", histogram(samples, largest));
  write_file(folder + "/workspace_sweep_map.csv", map(samples));
  std::printf("best joints");
  for (const double x : configuration(arm, best)) {
    std::printf(" %.4f", x);
  }
  std::printf("\nworkspace sweep: configurations=%zu mean_manipulability=%.6g "
              "largest_manipulability=%.6g\n",
              count, sum / double(count), largest);
  if (!example::draw(folder, "workspace_sweep", 430, picture_script())) {
    std::cout << "No picture: gnuplot is not installed\n";
  }
}

} // namespace

int main(int argc, char** argv) {
  return example::run_program("workspace_sweep", [&] {
    example::option_list description("Manipulability of a robot arm over its workspace. Options");
    description.flag("help", "print this and stop");
    description.value<int>("samples", "N", "random configurations, 1 to 10000000 (default: 20000)");
    description.value<std::string>("out", "FOLDER",
                                   "output folder for tables and the picture (default: .)");
    example::add_arm_options(description);
    const auto line = example::command_line::parse(argc, argv, description);
    if (!line) {
      return 0;
    }
    const int samples = line->get<int>("samples").value_or(20000);
    if (samples < 1 || samples > 10000000) {
      throw std::runtime_error("--samples is " + std::to_string(samples) +
                               " (expected 1 to 10000000)");
    }
    run(example::arm_of(*line), std::size_t(samples), line->text("out").value_or("."));
    return 0;
  });
}
