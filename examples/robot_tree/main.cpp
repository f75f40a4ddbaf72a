// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A robot from its description: poses of all links in a configuration, Jacobian of the centre of
// mass, and a picture of links, axes and the centre of mass. The default robot has two arms on a
// mobile base; others are read from a URDF file.

#include "../support/command_line.hpp"
#include "../support/folder.hpp"
#include "../support/gnuplot.hpp"
#include "../support/numbers.hpp"
#include "../support/program.hpp"
#include "picture.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/duet.hpp>
#include <duet/io/urdf.hpp>
#include <duet/kinematics/tree_jacobian.hpp>

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace duet;

/// The coordinates of the command line; by default the midpoint of the limits, or 0 without limits.
[[nodiscard]] Eigen::VectorXd coordinates(const kinematic_tree& robot,
                                          const example::command_line& arguments) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(robot.size());
  const auto text = arguments.text("joints");
  if (text) {
    const std::vector<double> numbers = example::parse_numbers("--joints", *text);
    if (numbers.size() != std::size_t(robot.size())) {
      throw std::runtime_error("--joints: " + std::to_string(robot.size()) +
                               " numbers expected, got " + std::to_string(numbers.size()));
    }
    q = Eigen::Map<const Eigen::VectorXd>(numbers.data(), robot.size());
  } else if (!arguments.has("urdf")) { // a posture for the picture
    for (const auto& [name, x] : robot_tree_example::posture) {
      q[robot.coordinate(name)] = x;
    }
  } else {
    for (int i = 0; i < robot.size(); ++i) {
      const double middle = (robot.limits(i).lower + robot.limits(i).upper) / 2;
      q[i] = middle - middle == 0 ? middle : 0;
    }
  }
  return q;
}

/// A name without characters that would split it into cells.
[[nodiscard]] std::string cell(std::string name) {
  for (char& c : name) {
    c = c == ',' || c == ';' || c == '"' || c == '#' || c == '\n' || c == ' ' ? '_' : c;
  }
  return printable(name);
}

/// Name, position and unit quaternion of each link.
[[nodiscard]] std::string links_csv(const kinematic_tree& robot, const Eigen::VectorXd& q) {
  std::string text = "link,x,y,z,qw,qx,qy,qz\n";
  const auto poses = robot.poses(q);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto t = translation(poses[i]);
    const auto r = rotation(poses[i]);
    text += cell(robot.links()[i].name) + "," +
            csv_line({t[0], t[1], t[2], r.w(), r.x(), r.y(), r.z()});
  }
  return text;
}

/// Value and limits of each coordinate, and its column of the Jacobian of the centre of mass.
[[nodiscard]] std::string coordinates_csv(const kinematic_tree& robot, const Eigen::VectorXd& q,
                                          const Eigen::MatrixXd& of_centre) {
  std::string text = "coordinate,value,lower,upper,dcx,dcy,dcz\n";
  for (int i = 0; i < robot.size(); ++i) {
    text += cell(robot.coordinate_names()[std::size_t(i)]) + "," +
            csv_line({q[i], robot.limits(i).lower, robot.limits(i).upper, of_centre(0, i),
                      of_centre(1, i), of_centre(2, i)});
  }
  return text;
}

void run(const example::command_line& arguments) {
  const std::string folder = arguments.text("out").value_or("robot_tree_out");
  example::require_folder(folder);
  const kinematic_tree robot =
      read_urdf_tree(arguments.text("urdf").value_or(DUET_EXAMPLE_FOLDER "/porter.urdf"));
  const Eigen::VectorXd q = coordinates(robot, arguments);
  bool has_mass = false;
  for (const tree_link& link : robot.links()) {
    has_mass = has_mass || (link.inertia && link.inertia->mass > 0);
  }
  Eigen::MatrixXd of_centre = Eigen::MatrixXd::Zero(3, robot.size());
  if (has_mass) {
    of_centre = centre_of_mass_jacobian(robot, q);
  }
  std::filesystem::create_directories(folder);
  write_file(folder + "/links.csv", links_csv(robot, q));
  if (robot.size() > 0) {
    write_file(folder + "/coordinates.csv", coordinates_csv(robot, q, of_centre));
  }
  const robot_tree_example::picture picture(robot, q, has_mass);
  write_file(folder + "/robot_shapes.csv", picture.csv());
  const bool drawn = example::draw(folder, "robot", 560, picture.script("robot_shapes.csv"));
  std::cout << "Tables" << (drawn ? " and a picture (SVG, PNG)" : "") << " are in "
            << printable(folder) << "\n";
  if (!drawn) {
    std::cout << "No picture: gnuplot is not installed\n";
  }
  std::printf("robot tree: links=%zu joints=%zu coordinates=%d", robot.links().size(),
              robot.joints().size(), robot.size());
  if (has_mass) {
    const Eigen::Vector3d c = centre_of_mass(robot, q);
    std::printf(" centre_of_mass=%.6f,%.6f,%.6f", c[0], c[1], c[2]);
  }
  std::printf("\n");
}

} // namespace

int main(int argc, char** argv) {
  return example::run_program("robot_tree", [&] {
    example::option_list description(
        "Forward kinematics and centre of mass of a robot from its description. Options");
    description.value<std::string>(
        "urdf", "FILE", "robot description (default: a robot with two arms on a mobile base)");
    description.value<std::string>(
        "joints", "X,X,...",
        "all coordinates, as in coordinates.csv: radians or metres (default: the midpoint of "
        "the limits)");
    description.value<std::string>(
        "out", "FOLDER", "output folder for tables and the picture (default: robot_tree_out)");
    description.flag("help", "print this and stop");
    if (const auto line = example::command_line::parse(argc, argv, description)) {
      run(*line);
    }
    return 0;
  });
}
