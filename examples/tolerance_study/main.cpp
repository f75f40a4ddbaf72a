// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// How accurately must the hardpoints of a suspension be made? Sensitivities of toe-in and camber to
// each coordinate by automatic differentiation through the closed loop, and what they predict
// against samples, which any number of processes and threads may share.

#include "blocks.hpp"
#include "options.hpp"
#include "processes.hpp"
#include "report.hpp"
#include "toleranced_carrier.hpp"

#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"
#include "../wheel_carrier/hardpoints_file.hpp"

#include <duet/core/parallel_for.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/core/text/progress_line.hpp>

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

std::vector<double> heights(const options& given) {
  std::vector<double> result;
  for (int i = 0; i < given.rows; ++i) {
    result.push_back(std::lerp(given.lowest, given.highest, double(i) / (given.rows - 1)));
  }
  return result;
}

/// Of the missing blocks, every size-th is this process's.
void compute_share(const block_store& blocks, const toleranced_carrier& mechanism,
                   const std::vector<std::size_t>& missing, const processes& all,
                   unsigned threads) {
  std::vector<std::size_t> share;
  for (std::size_t i = all.rank(); i < missing.size(); i += all.size()) {
    share.push_back(missing[i]);
  }
  duet::progress_line line("blocks");
  duet::execution how{threads};
  if (all.rank() == 0) {
    how.report = line;
  }
  duet::parallel_for_blocks(
      share.size(), [&](std::size_t i, std::size_t) { blocks.compute(mechanism, share[i]); }, how,
      1);
}

void summarise(const options& given, const hardpoints& points, const toleranced_carrier& mechanism,
               const block_store& blocks) {
  const auto missing = blocks.missing();
  if (!missing.empty()) {
    throw std::runtime_error("of blocks 0-" + std::to_string(blocks.count() - 1) + " in " +
                             blocks.folder() + " are missing: " + runs(missing) +
                             "; run again, without --summary, to complete them");
  }
  const results r = results_of(mechanism, given.tolerance, blocks.columns(mechanism.rows()));
  std::printf("%d samples, every coordinate of the hardpoints off by %g mm (standard deviation), "
              "rods as designed\n\n",
              given.samples, given.tolerance * 1000);
  print(r, points);
  duet::write_file(given.out + "/summary.csv", summary_csv(r));
  duet::write_file(given.out + "/sensitivities.csv", sensitivities_csv(r, points));
  const bool drawn = example::draw(given.out, "tolerance_study", 600, picture_script(r, points));
  std::printf("Tables%s are in %s\n", drawn ? " and a picture (SVG, PNG)" : "",
              duet::printable(given.out).c_str());
  if (!drawn) {
    std::printf("No picture: gnuplot is not installed\n");
  }
  // A standard deviation of N normal samples is itself uncertain by 1/sqrt(2 N).
  std::printf("tolerance study: samples=%d blocks=%zu sampled_against_linear=%.2g "
              "standard_error=%.2g\n",
              given.samples, blocks.count(), largest_difference(r),
              1 / std::sqrt(2.0 * given.samples));
}

int run(const options& given, const processes& all) {
  const hardpoints points = given.hardpoints ? wheel_carrier::read_hardpoints(*given.hardpoints)
                                             : wheel_carrier::example_hardpoints();
  const toleranced_carrier mechanism(points, heights(given));
  const block_store blocks(given, points);
  const auto missing = all.from_first([&] {
    example::require_folder(given.out);
    const auto result = blocks.missing();
    if (!given.summary_only) {
      std::filesystem::create_directories(blocks.folder());
      std::cout << result.size() << " of " << blocks.count() << " blocks to compute\n"
                << std::flush;
    }
    return result;
  });
  if (!missing) {
    return 0; // the first process says why, and fails
  }
  std::exception_ptr error;
  if (!given.summary_only) {
    try {
      const unsigned threads = given.threads.value_or(all.size() > 1 ? 1 : 0);
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
    summarise(given, points, mechanism, blocks);
  }
  return 0;
}

} // namespace
} // namespace tolerance_study

int main(int argc, char** argv) {
  const auto guarded = [](const auto& body) {
    return example::run_program("tolerance_study", body);
  };
  std::optional<tolerance_study::options> given;
  const int status = guarded([&] {
    given = tolerance_study::parse_options(argc, argv);
    return 0;
  });
  if (!given) {
    return status;
  }
  const tolerance_study::processes all(argc, argv);
  const int result = guarded([&] { return tolerance_study::run(*given, all); });
  all.wait(); // mpirun ends all once one has failed, also those that have not yet said why
  return result;
}
