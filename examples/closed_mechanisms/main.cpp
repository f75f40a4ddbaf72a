// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Closed-chain mechanisms from files, a robot description and a list of loop constraints each:
// their mobility, assembly configurations, driven motion and its derivatives compared with closed
// forms, and dead points.

#include "formulas.hpp"
#include "pictures.hpp"

#include "../support/command_line.hpp"
#include "../support/folder.hpp"
#include "../support/program.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/io/loop_file.hpp>
#include <duet/io/urdf.hpp>
#include <duet/robotics/closed_tree.hpp>
#include <duet/robotics/loop_motion.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace closed_mechanisms {
namespace {

struct options {
  std::string mechanism = "four_bar";
  std::string files = DUET_EXAMPLE_FILES;
  std::string out = "closed_mechanisms_out";
  int starts = 100;
  int samples = 101;
};

std::optional<options> parse_options(int argc, char** argv) {
  example::option_list description("Closed-chain mechanisms from files: assembly configurations, "
                                   "mobility and motion. Metres and "
                                   "radians. Options");
  description.flag("help", "print this and stop");
  description.value<std::string>(
      "mechanism", "NAME",
      "four_bar, five_bar, delta, stewart or wheel_carrier (default: four_bar)");
  description.value<std::string>(
      "files", "DIR", "folder of NAME.urdf and NAME.loops (default: files of this example)");
  description.value<int>("random-starts", "N",
                         "random initial guesses of assembly configurations (default: 100)");
  description.value<int>("samples", "N", "positions along the motion (default: 101)");
  description.value<std::string>(
      "out", "DIR", "folder for the table and the picture (default: closed_mechanisms_out)");
  const auto arguments = example::command_line::parse(argc, argv, description, "mechanism");
  if (!arguments) {
    return std::nullopt;
  }
  options result;
  result.mechanism = arguments->text("mechanism").value_or(result.mechanism);
  result.files = arguments->text("files").value_or(result.files);
  result.out = arguments->text("out").value_or(result.out);
  result.starts = arguments->get<int>("random-starts").value_or(result.starts);
  result.samples = arguments->get<int>("samples").value_or(result.samples);
  if (result.starts < 1) {
    throw std::runtime_error("--random-starts is " + std::to_string(result.starts) +
                             " (expected at least 1)");
  }
  if (result.samples < 2) {
    throw std::runtime_error("--samples is " + std::to_string(result.samples) +
                             " (expected at least 2)");
  }
  return result;
}

const std::array colours{"#0072b2", "#d55e00", "#00805d", "#a8497c",
                         "#b37700", "#56b4e9", "#6e7781", "#24292f"};

std::string names(const duet::closed_chain_mechanism& mechanism,
                  const std::vector<int>& coordinates) {
  std::string result;
  for (const int i : coordinates) {
    result += " " + mechanism.tree().coordinate_names()[std::size_t(i)];
  }
  return result;
}

void print(const duet::assembly_search_result& result) {
  std::printf(
      "%zu assembly configurations from %d starts, of which %d closed; missing probability %.2g:\n",
      result.positions.size(), result.starts, result.converged, result.missing_probability());
  for (const duet::assembly_configuration& each : result.positions) {
    for (const double x : each.coordinates) {
      std::printf(" %9.5f", std::abs(x) < 5e-6 ? 0 : x);
    }
    std::printf("   smallest singular value %.2g\n", each.smallest_singular_value);
  }
}

/// Moves the driven coordinates and compares the motion with the closed form.
void follow(const options& settings, const mechanism& known, duet::driven_motion motion,
            example::drawing& picture) {
  const duet::closed_chain_mechanism mechanism = motion.mechanism();
  const auto at = mechanism.tree().link(known.link).at_point(known.point);
  const VectorXd direction = known.to - known.from;
  std::string table = "part,x,y,z,dx,dy,dz,ddx,ddy,ddz\n";
  std::array<double, 3> differences{};
  std::vector<example::point> curve;
  for (int i = 0; i < settings.samples; ++i) {
    const double part = double(i) / (settings.samples - 1);
    motion = motion.warm_started_at(known.from + part * direction);
    const path x =
        along_line([&](const auto& u) { return translation(mechanism.tree().pose(motion(u), at)); },
                   known.from, direction, part);
    const path expected = known.by_hand(known.from, direction, part);
    std::vector<double> row{part};
    for (std::size_t k = 0; k < 3; ++k) {
      differences[k] = std::max(differences[k], (x[k] - expected[k]).norm());
      row.insert(row.end(), x[k].begin(), x[k].end());
    }
    table += duet::csv_line(row);
    curve.push_back(x[0]);
    const int drawn = direction.size() == 1 ? 4 : 2;
    if (i % ((settings.samples + drawn - 1) / drawn) == 0) {
      add(picture, mechanism, motion.start(),
          example::mixed(colours[0], "#ffffff", .7 * (1 - part)));
    }
  }
  picture.line(curve, colours[1], "lw 3", 10 * mechanism.length());
  duet::write_file(settings.out + "/" + known.name + "_motion.csv", table);
  std::printf("by hand: position_difference=%.2g first_derivative_difference=%.2g "
              "second_derivative_difference=%.2g\n",
              differences[0], differences[1], differences[2]);
}

/// Prints the complete motion of a mechanism with one driven coordinate, and its dead points.
void print(const duet::closed_chain_mechanism& mechanism, const duet::motion_trace& motion) {
  std::printf("complete motion: %zu positions, %s\n", motion.positions.size(),
              motion.is_closed       ? "closed"
              : motion.stopped_early ? "ends at a branch point"
                                     : "not closed");
  for (const duet::branch_point& each : motion.branch_points) {
    std::printf("  %zu tangents at the branch point", each.tangents.size());
    for (const double x : each.coordinates) {
      std::printf(" %.10f", std::abs(x) < 5e-11 ? 0 : x);
    }
    std::printf("\n");
  }
  const auto& joints = mechanism.tree().joints();
  for (const duet::dead_point& each : motion.dead_points) {
    const std::string& name = mechanism.tree().coordinate_names()[std::size_t(each.coordinate)];
    if (std::any_of(joints.begin(), joints.end(),
                    [&](const duet::tree_joint& joint) { return joint.name == name; })) {
      std::printf("  %s is dead at %.10f: %s move\n", name.c_str(),
                  each.coordinates[each.coordinate], each.moving.c_str());
    }
  }
}

void run(const options& settings) {
  const auto all = known_mechanisms();
  const auto known = std::find_if(all.begin(), all.end(), [&](const mechanism& each) {
    return each.name == settings.mechanism;
  });
  if (known == all.end()) {
    throw std::runtime_error("--mechanism is '" + settings.mechanism +
                             "' (expected four_bar, five_bar, delta, stewart or wheel_carrier)");
  }
  example::require_folder(settings.out);
  const std::string file = settings.files + "/" + known->name;
  const duet::closed_chain_mechanism mechanism(duet::read_urdf_tree(file + ".urdf"),
                                               duet::read_loops(file + ".loops"));
  std::vector<int> drives;
  for (const std::string& name : known->drives) {
    drives.push_back(mechanism.tree().coordinate(name));
  }
  std::printf("%s: %d coordinates, %d equations\n", known->name.c_str(), mechanism.size(),
              mechanism.equation_count());
  const auto result = duet::find_assembly_configurations(mechanism, drives, known->from,
                                                         {.random_starts = settings.starts});
  if (result.positions.empty()) {
    throw std::runtime_error("no assembly configuration found (increase --random-starts)");
  }
  const VectorXd q =
      drives.empty() ? result.positions[0].coordinates : mechanism.assemble(known->guess, drives);
  std::printf("%s\n", to_text(duet::mobility(mechanism, q)).c_str());
  const auto independent = mechanism.independent_coordinates(q);
  std::printf("driven:%s; best conditioned:%s\n", names(mechanism, drives).c_str(),
              names(mechanism, independent).c_str());
  print(result);
  std::filesystem::create_directories(settings.out);
  example::drawing picture(known->view);
  if (drives.empty()) {
    add(picture, mechanism, q, colours[0]);
    for (std::size_t i = 1; i < result.positions.size(); ++i) {
      add_lines(picture, mechanism, result.positions[i].coordinates, colours[i % colours.size()]);
    }
  } else {
    const duet::driven_motion motion(mechanism, q, drives);
    follow(settings, *known, motion, picture);
    if (drives.size() == 1) {
      print(mechanism, duet::trace(motion));
    }
  }
  if (!draw(settings.out, known->name, picture)) {
    std::printf("No picture: gnuplot is not installed\n");
  }
}

} // namespace
} // namespace closed_mechanisms

int main(int argc, char** argv) {
  return example::run_program("closed_mechanisms", [&] {
    if (const auto settings = closed_mechanisms::parse_options(argc, argv)) {
      closed_mechanisms::run(*settings);
    }
    return 0;
  });
}
