// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The screw motion between two poses (N19): in words, as a table of poses and velocities along it,
// and as a picture. Velocities are computed by automatic differentiation and compared with the
// closed form, a constant twist.

#include "options.hpp"
#include "path.hpp"

#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"
#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>

#include <cstdio>
#include <filesystem>
#include <iostream>

namespace screw_motion {
namespace {

void run(const options& settings) {
  example::require_folder(settings.out);
  const auto [from, to] = poses(settings);
  const duet::slerp_arc arc =
      settings.is_longer_arc ? duet::slerp_arc::longest : duet::slerp_arc::shortest;
  const screw between = screw_between(from, to, settings.is_longer_arc);
  std::cout << in_words(between);
  if (differs_by_half_turn(from, to)) {
    std::cout << "The poses differ by half a turn: both arcs have the same length.\n";
  }
  const std::vector<sample> path = samples(from, to, arc, settings.steps);
  const double difference = largest_difference(path, between);

  std::filesystem::create_directories(settings.out);
  duet::write_file(settings.out + "/path.csv", path_csv(path));
  duet::write_file(settings.out + "/frames.csv", frames_csv(path, between));
  const bool drawn = example::draw(settings.out, "path", 520, path_script(between, path));
  std::cout << "Table" << (drawn ? " and picture (SVG, PNG)" : "") << " are in "
            << duet::printable(settings.out) << "\n";
  if (!drawn) {
    std::cout << "No picture: gnuplot is not installed\n";
  }
  std::printf("screw motion: kind=%s angle=%.6g translation=%.6g ad_vs_closed_form=%.2g\n",
              kind_text(between.kind), between.angle, between.translation, difference);
}

} // namespace
} // namespace screw_motion

int main(int argc, char** argv) {
  return example::run_program("screw_motion", [&] {
    if (const auto settings = screw_motion::parse_options(argc, argv)) {
      screw_motion::run(*settings);
    }
    return 0;
  });
}
