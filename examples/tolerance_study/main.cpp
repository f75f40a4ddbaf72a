// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Tolerance analysis of the hardpoints of a suspension: sensitivities of toe-in and camber to each
// coordinate by automatic differentiation through the closed loop, and their predictions compared
// with random samples, which any number of processes and threads may share.

#include "blocks.hpp"
#include "options.hpp"
#include "processes.hpp"
#include "report.hpp"
#include "toleranced_carrier.hpp"

#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"
#include "../support/progress_line.hpp"
#include "../wheel_carrier/hardpoints_file.hpp"

#include <duet/core/parallel_for.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace tolerance_study {
namespace {

std::vector<double> heights(const options& settings) {
  std::vector<double> result;
  for (int i = 0; i < settings.heights; ++i) {
    result.push_back(
        std::lerp(settings.lowest, settings.highest, double(i) / (settings.heights - 1)));
  }
  return result;
}

/// Computes the share of this process: every size-th missing block.
void compute_share(const block_store& blocks, const toleranced_carrier& mechanism,
                   const std::vector<std::size_t>& missing, const processes& all,
                   unsigned threads) {
  std::vector<std::size_t> share;
  for (std::size_t i = all.rank(); i < missing.size(); i += all.size()) {
    share.push_back(missing[i]);
  }
  example::progress_line line("blocks");
  duet::execution execution{threads};
  if (all.rank() == 0) {
    execution.report = line;
  }
  duet::parallel_for_blocks(
      share.size(), [&](std::size_t i, std::size_t) { blocks.compute(mechanism, share[i]); },
      execution, 1);
}

void summarise(const options& settings, const hardpoints& points,
               const toleranced_carrier& mechanism, const block_store& blocks) {
  const auto missing = blocks.missing();
  if (!missing.empty()) {
    throw std::runtime_error("of blocks 0-" + std::to_string(blocks.count() - 1) + " in " +
                             blocks.folder() + ", these are missing: " + runs(missing) +
                             " (run again without --summary to compute them)");
  }
  const results r = results_of(mechanism, settings.deviation, blocks.columns(mechanism.rows()));
  std::printf("%d samples, every coordinate of the hardpoints off by %g mm (standard deviation), "
              "rods as designed\n\n",
              settings.samples, settings.deviation * 1000);
  print(r, points);
  duet::write_file(settings.out + "/summary.csv", summary_csv(r));
  duet::write_file(settings.out + "/sensitivities.csv", sensitivities_csv(r, points));
  const bool drawn = example::draw(settings.out, "tolerance_study", 600, picture_script(r, points));
  std::printf("Tables%s are in %s\n", drawn ? " and a picture (SVG, PNG)" : "",
              duet::printable(settings.out).c_str());
  if (!drawn) {
    std::printf("No picture: gnuplot is not installed\n");
  }
  // A standard deviation of N normal samples is itself uncertain by 1/sqrt(2 N).
  std::printf("tolerance study: samples=%d blocks=%zu sampled_against_linear=%.2g "
              "standard_error=%.2g\n",
              settings.samples, blocks.count(), largest_difference(r),
              1 / std::sqrt(2.0 * settings.samples));
}

int run(const options& settings, const processes& all) {
  const hardpoints points = settings.hardpoints
                                ? wheel_carrier::read_hardpoints(*settings.hardpoints)
                                : wheel_carrier::example_hardpoints();
  const toleranced_carrier mechanism(points, heights(settings));
  const block_store blocks(settings, points);
  const auto missing = all.from_first([&] {
    example::require_folder(settings.out);
    const auto result = blocks.missing();
    if (!settings.summary_only) {
      std::filesystem::create_directories(blocks.folder());
      std::cout << result.size() << " of " << blocks.count() << " blocks to compute\n"
                << std::flush;
    }
    return result;
  });
  if (!missing) {
    return 0; // the first process prints the error and fails
  }
  std::exception_ptr error;
  if (!settings.summary_only) {
    try {
      const unsigned threads = settings.threads.value_or(all.size() > 1 ? 1 : 0);
      compute_share(blocks, mechanism, *missing, all, threads);
    } catch (...) {
      error = std::current_exception();
    }
    all.wait();
  }
  if (error) {
    std::rethrow_exception(error);
  }
  if (all.rank() == 0) {
    summarise(settings, points, mechanism, blocks);
  }
  return 0;
}

} // namespace
} // namespace tolerance_study

int main(int argc, char** argv) {
  const auto guarded = [](const auto& body) {
    return example::run_program("tolerance_study", body);
  };
  std::optional<tolerance_study::options> settings;
  const int status = guarded([&] {
    settings = tolerance_study::parse_options(argc, argv);
    return 0;
  });
  if (!settings) {
    return status;
  }
  const tolerance_study::processes all(argc, argv);
  const int result = guarded([&] { return tolerance_study::run(*settings, all); });
  all.wait(); // mpirun ends all processes when one fails, even before they print their errors
  return result;
}
