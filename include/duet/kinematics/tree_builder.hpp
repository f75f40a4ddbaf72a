// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/joint_checks.hpp>
#include <duet/kinematics/robot_description.hpp>
#include <duet/kinematics/tree_table.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

/// \file
/// Construction of the table of a kinematic tree from a description. For those who extend duet.

namespace duet::detail {

/// Builds a table, in time proportional to the number of links.
class tree_builder {
public:
  /// \throws file_error, or invalid_input if the description is not from a file, if it does not
  /// describe a tree
  explicit tree_builder(const robot_description& robot) : robot_(robot) {
    find_links();
    find_joints();
    find_order();
    add_coordinates();
    follow_leaders();
    add_nodes();
    add_masses();
  }

  [[nodiscard]] tree_table table() && { return std::move(table_); }

private:
  [[nodiscard]] const tree_joint& joint_at(int j) const { return robot_.joints[std::size_t(j)]; }

  void find_links() {
    for (const tree_link& link : robot_.links) {
      if (!table_.link_numbers.emplace(link.name, int(table_.link_numbers.size())).second) {
        bad_part(robot_, link, "another link has this name");
      }
    }
    if (robot_.links.empty()) {
      bad_robot(robot_, "the description has no links");
    }
  }

  [[nodiscard]] std::size_t link_of(const tree_joint& joint, const std::string& name) const {
    const auto found = table_.link_numbers.find(name);
    if (found == table_.link_numbers.end()) {
      std::vector<std::string> names;
      for (const tree_link& link : robot_.links) {
        names.push_back(link.name);
      }
      bad_part(robot_, joint, "no link \"" + name + "\": " + closest_names(name, names));
    }
    return std::size_t(found->second);
  }

  void find_joints() {
    above_.assign(robot_.links.size(), -1);
    below_.resize(robot_.links.size());
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      const tree_joint& joint = robot_.joints[j];
      if (!joint_numbers_.emplace(joint.name, int(j)).second) {
        bad_part(robot_, joint, "another joint has this name");
      }
      require_joint(joint.motion, j, "kinematic_tree", joint.name);
      below_[link_of(joint, joint.parent)].push_back(int(j));
      int& above = above_[link_of(joint, joint.child)];
      if (above >= 0) {
        bad_part(robot_, joint,
                 "the link \"" + joint.child + "\" already has the parent joint \"" +
                     joint_at(above).name + "\"");
      }
      above = int(j);
    }
  }

  /// Order of the joints from the root on, parents first.
  void find_order() {
    std::vector<std::size_t> links; // links reached so far
    for (std::size_t i = 0; i < above_.size(); ++i) {
      if (above_[i] < 0 && !links.empty()) {
        bad_part(robot_, robot_.links[i],
                 "it is a second root, the first is \"" + robot_.links[links[0]].name + "\"");
      }
      if (above_[i] < 0) {
        links.push_back(i);
      }
    }
    for (std::size_t i = 0; i < links.size(); ++i) {
      for (const int j : below_[links[i]]) {
        order_.push_back(j);
        links.push_back(std::size_t(table_.link_numbers.at(joint_at(j).child)));
      }
    }
    if (links.size() < robot_.links.size()) {
      std::vector<char> is_reached(robot_.links.size(), 0);
      for (const std::size_t i : links) {
        is_reached[i] = 1;
      }
      auto i = std::size_t(std::find(is_reached.begin(), is_reached.end(), 0) - is_reached.begin());
      while (is_reached[i] == 0) { // up until the cycle is closed
        is_reached[i] = 1;
        i = std::size_t(table_.link_numbers.at(joint_at(above_[i]).parent));
      }
      bad_part(robot_, joint_at(above_[i]),
               "it closes a cycle at the link \"" + robot_.links[i].name + "\"");
    }
  }

  /// Numbers of the joint coordinates, and those of the tree for joints that mimic none.
  void add_coordinates() {
    constexpr std::array<const char*, 6> free = {".x", ".y", ".z", ".rx", ".ry", ".rz"};
    constexpr std::array<const char*, 3> in_plane = {".x", ".y", ".angle"};
    for (const tree_joint& joint : robot_.joints) {
      const int count = joint.motion.coordinates();
      first_.push_back(int(table_.sources.size()));
      for (int k = 0; k < count; ++k) {
        if (joint.mimic) {
          table_.sources.push_back({});
          continue;
        }
        const auto at = std::size_t(k);
        table_.sources.push_back({int(table_.names.size())});
        table_.names.push_back(joint.name + (count == 1 ? ""
                                             : joint.motion.kind == joint_kind::planar
                                                 ? in_plane[at]
                                                 : free[count == 3 ? at + 3 : at]));
        table_.limits.push_back(count == 1 ? joint.motion.effective_limits()
                                           : joint_limits<double>{});
      }
    }
  }

  /// Expresses each joint that mimics another, possibly one that mimics a third, by a coordinate of
  /// the tree.
  void follow_leaders() {
    std::vector<char> is_open(robot_.joints.size(), 0);
    std::vector<int> open;
    for (std::size_t start = 0; start < robot_.joints.size(); ++start) {
      auto j = int(start);
      while (joint_at(j).mimic && joint_at(j).motion.kind != joint_kind::fixed &&
             source_of(j).own < 0) {
        if (is_open[std::size_t(j)] != 0) {
          bad_part(robot_, joint_at(j), "it mimics itself");
        }
        is_open[std::size_t(j)] = 1;
        open.push_back(j);
        j = leader_of(j);
      }
      for (; !open.empty(); open.pop_back()) {
        follow(open.back(), source_of(j));
        j = open.back();
      }
    }
  }
  [[nodiscard]] coordinate_source& source_of(int j) {
    return table_.sources[std::size_t(first_[std::size_t(j)])];
  }
  [[nodiscard]] int leader_of(int j) const {
    const tree_joint& joint = joint_at(j);
    const auto found = joint_numbers_.find(joint.mimic->joint);
    if (found == joint_numbers_.end()) {
      std::vector<std::string> names;
      for (const tree_joint& each : robot_.joints) {
        names.push_back(each.name);
      }
      bad_part(robot_, joint,
               "it mimics no joint \"" + joint.mimic->joint +
                   "\": " + closest_names(joint.mimic->joint, names));
    }
    for (const tree_joint* each : {&joint, &joint_at(found->second)}) {
      if (each->motion.coordinates() != 1) {
        bad_part(robot_, joint,
                 "it mimics \"" + joint.mimic->joint + "\", but \"" + each->name + "\" has " +
                     std::to_string(each->motion.coordinates()) + " coordinates (expected 1)");
      }
    }
    if (!std::isfinite(joint.mimic->multiplier) || !std::isfinite(joint.mimic->offset)) {
      bad_part(robot_, joint, "the multiplier or the offset of its mimic is not finite");
    }
    return found->second;
  }
  void follow(int j, const coordinate_source& leader) {
    const tree_joint& joint = joint_at(j);
    const joint_mimic& by = *joint.mimic;
    const coordinate_source source{leader.own, by.multiplier * leader.multiplier,
                                   by.multiplier * leader.offset + by.offset};
    source_of(j) = source;
    const joint_limits<double> range = joint.motion.effective_limits();
    joint_limits<double>& limits = table_.limits[std::size_t(source.own)];
    bool is_possible = range.lower <= source.offset && source.offset <= range.upper;
    if (source.multiplier != 0) {
      const double a = (range.lower - source.offset) / source.multiplier;
      const double b = (range.upper - source.offset) / source.multiplier;
      limits.lower = std::max(limits.lower, std::min(a, b));
      limits.upper = std::min(limits.upper, std::max(a, b));
      limits.velocity = std::min(limits.velocity, range.velocity / std::abs(source.multiplier));
      is_possible = limits.lower <= limits.upper;
    }
    if (!is_possible) {
      bad_part(robot_, joint,
               "no coordinate of \"" + by.joint + "\" satisfies its limits " +
                   to_text(range.lower) + " to " + to_text(range.upper));
    }
  }

  void add_nodes() {
    table_.links.resize(robot_.links.size());
    for (const int j : order_) {
      const tree_joint& joint = joint_at(j);
      const auto number = [&](const std::string& name) {
        return std::size_t(table_.link_numbers.at(name));
      };
      frame_on_node frame = table_.links[number(joint.parent)];
      frame.offset = frame.offset * joint.motion.origin;
      if (joint.motion.kind != joint_kind::fixed) {
        add_nodes_of_joint(table_.nodes, joint.motion, first_[std::size_t(j)], frame);
        frame = {int(table_.nodes.size()) - 1, {}};
      }
      table_.links[number(joint.child)] = frame;
    }
  }
  void add_masses() {
    table_.masses.resize(table_.nodes.size() + 1);
    for (std::size_t i = 0; i < robot_.links.size(); ++i) {
      if (const auto& inertia = robot_.links[i].inertia) {
        if (!(inertia->mass >= 0 && std::isfinite(inertia->mass))) {
          bad_part(robot_, robot_.links[i],
                   "the mass is " + to_text(inertia->mass) + " (expected >= 0)");
        }
        const frame_on_node& frame = table_.links[i];
        mass_on_node& sum = table_.masses[std::size_t(frame.node + 1)];
        const auto centre = (frame.offset * inertia->frame).translation;
        sum.mass += inertia->mass;
        sum.moment = sum.moment + inertia->mass * components(centre);
      }
    }
  }

  const robot_description& robot_;
  tree_table table_;
  std::unordered_map<std::string_view, int> joint_numbers_;
  std::vector<int> above_;              ///< the joint above each link; −1: none
  std::vector<std::vector<int>> below_; ///< the joints below each link
  std::vector<int> order_;              ///< joint numbers, parents first
  std::vector<int> first_;              ///< number of the first coordinate of each joint
};

/// The table of a description.
///
/// \throws as `tree_builder`
[[nodiscard]] inline tree_table table_of(const robot_description& robot) {
  return tree_builder(robot).table();
}

} // namespace duet::detail
