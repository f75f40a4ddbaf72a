// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The tip of an arm draws a helix with constant orientation: follow_path along a function. Writes
// the joint path as a table and draws it. The arm is built in or read from a URDF file.

#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/program.hpp"
#include "options.hpp"
#include "tables.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/robotics/follow_path.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>

namespace path_following {
namespace {

void run(const options& settings) {
  example::require_folder(settings.out);
  const auto first = settings.arm.pose(settings.start);
  const auto helix = [&](double u) {
    const double angle = 2 * duet::constant::pi<double>() * u;
    const Eigen::Vector3d shift(settings.radius * (std::cos(angle) - 1),
                                settings.radius * std::sin(angle), settings.pitch * u);
    return duet::pose(duet::quaternion<double>(1), shift) * first;
  };
  const auto plan = duet::follow_path(settings.arm, settings.start, helix, 0, settings.turns);

  std::filesystem::create_directories(settings.out);
  duet::write_file(settings.out + "/path.csv", path_csv(plan));
  const example::drawing drawing = drawing_of(settings.arm, plan, helix, settings.turns);
  duet::write_file(settings.out + "/path_shapes.csv", drawing.csv());
  const bool drawn = example::draw(settings.out, "path", 480, picture_script(drawing, plan));
  std::cout << "Table" << (drawn ? " and picture (SVG, PNG)" : "") << " are in "
            << duet::printable(settings.out) << "\n";
  if (!drawn) {
    std::cout << "No picture: gnuplot is not installed\n";
  }
  duet::pose_error largest;
  for (const duet::pose_error& d : plan.deviations) {
    largest = {std::max(largest.translation, d.translation),
               std::max(largest.rotation, d.rotation)};
  }
  std::printf("path following: reason=%s turns=%.4g waypoints=%zu length=%.1e angle=%.1e "
              "limit_margin=%.4g singular_value=%.4g\n",
              to_text(plan.reason), plan.tau.back(), plan.tau.size(), largest.translation,
              largest.rotation, plan.smallest_limit_margin, plan.smallest_singular_value);
  if (plan.reason != duet::stop_reason::reached) {
    std::cout << "The arm cannot draw all of it: it stops after " << plan.tau.back() << " of "
              << settings.turns << " turns\n";
  }
}

} // namespace
} // namespace path_following

int main(int argc, char** argv) {
  return example::run_program("path_following", [&] {
    if (const auto settings = path_following::parse_options(argc, argv)) {
      path_following::run(*settings);
    }
    return 0;
  });
}
