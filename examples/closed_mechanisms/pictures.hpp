// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../support/drawing.hpp"
#include "../support/gnuplot.hpp"

#include <duet/core/text/file.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/robotics/closed_tree.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Drawings of closed-chain mechanisms.

namespace closed_mechanisms {

/// Calls bar(from, to) for all links, between their joints and loop constraints, rod(from, to) for
/// rods, and fixed(point) for their points on the root.
template <class Bar, class Rod, class Fixed>
void for_each_part(const duet::closed_chain_mechanism& mechanism, const Eigen::VectorXd& q,
                   const Bar& bar, const Rod& rod, const Fixed& fixed) {
  const duet::kinematic_tree& tree = mechanism.tree();
  const auto poses = tree.poses(q);
  const auto number = [&](const std::string& link) { return std::size_t(tree.link(link).link); };
  const auto at = [&](const std::string& link, const duet::placement<double>& offset) {
    return example::point(translation(poses[number(link)] * offset.pose()));
  };
  std::vector<bool> is_moved(poses.size(), false);
  for (const duet::tree_joint& each : tree.joints()) {
    is_moved[number(each.child)] = true;
  }
  const auto part = [&](const std::string& link, const duet::placement<double>& to) {
    if (is_moved[number(link)]) {
      bar(at(link, {}), at(link, to));
    } else {
      fixed(at(link, to));
    }
  };
  for (const duet::tree_joint& each : tree.joints()) {
    if (each.motion.kind != duet::joint_kind::floating) {
      part(each.parent, each.motion.origin);
    }
  }
  for (const duet::loop_constraint& each : mechanism.loops()) {
    part(each.first.link, each.first.offset);
    part(each.second.link, each.second.offset);
    if (each.kind == duet::constraint_kind::distance) {
      rod(at(each.first.link, each.first.offset), at(each.second.link, each.second.offset));
    }
  }
}

/// Draws a mechanism as solids.
inline void add(example::drawing& picture, const duet::closed_chain_mechanism& mechanism,
                const Eigen::VectorXd& q, const std::string& colour) {
  using example::point;
  const double radius = .012 * mechanism.length();
  for_each_part(
      mechanism, q,
      [&](const point& from, const point& to) { picture.capsule(from, to, radius, colour); },
      [&](const point& from, const point& to) { picture.capsule(from, to, radius / 2, "#b37700"); },
      [&](const point& x) { picture.ball(x, 2 * radius, "#6e7781"); });
}

/// Draws the links as lines.
inline void add_lines(example::drawing& picture, const duet::closed_chain_mechanism& mechanism,
                      const Eigen::VectorXd& q, const std::string& colour) {
  using example::point;
  for_each_part(
      mechanism, q,
      [&](const point& from, const point& to) {
        picture.line({from, to}, colour, "lw 1.5");
      },
      [](const point&, const point&) {}, [](const point&) {});
}

/// Writes the drawing; false if gnuplot is not installed.
inline bool draw(const std::string& folder, const std::string& name,
                 const example::drawing& picture) {
  duet::write_file(folder + "/" + name + ".csv", picture.csv());
  return example::draw(folder, name, 560, picture.script(name + ".csv"));
}

} // namespace closed_mechanisms
