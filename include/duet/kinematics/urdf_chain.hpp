// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/robot_description.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

/// \file
/// Serial chains with names of joints and links, along the path from one link of a robot to
/// another.

namespace duet {

/// A chain from a robot description, with the names of its joints and links.
///
/// \tparam Capacity  maximum number of moving joints
template <int Capacity>
class urdf_chain : public serial_chain<-Capacity> {
public:
  urdf_chain(const serial_chain<-Capacity>& chain, std::vector<std::string> joint_names,
             std::vector<urdf_link> links, std::vector<urdf_unknown_element> unknown = {})
      : serial_chain<-Capacity>(chain), joint_names_(std::move(joint_names)),
        links_(std::move(links)), unknown_(std::move(unknown)) {}

  /// For those who extend duet: the chain of the contents of a file.
  explicit urdf_chain(detail::urdf_contents read)
      : urdf_chain(serial_chain<-Capacity>(std::span<const joint<double>>(read.joints)),
                   std::move(read.joint_names), std::move(read.links), std::move(read.unknown)) {}
  /// For those who extend duet: another chain without joint i, whose link stays at `locked`.
  urdf_chain(const urdf_chain& other, int i, const placement<double>& locked)
      : serial_chain<-Capacity>(other, i, locked), joint_names_(other.joint_names_),
        links_(other.links_), unknown_(other.unknown_) {
    joint_names_.erase(joint_names_.begin() + i);
    for (urdf_link& each : links_) {
      if (each.frame.link == i + 1) {
        each.frame.offset = locked * each.frame.offset;
      }
      each.frame.link -= each.frame.link > i ? 1 : 0;
    }
  }

  using serial_chain<-Capacity>::link;
  /// The frame of a link by its name, including links that are fixed to another one.
  ///
  /// \throws invalid_input if the chain has no link of that name
  [[nodiscard]] attached_frame<double> link(std::string_view name) const {
    const auto found = std::find_if(links_.begin(), links_.end(),
                                    [&](const urdf_link& each) { return each.name == name; });
    if (found == links_.end()) {
      detail::unknown_name("urdf_chain", "link", name, detail::names_of(links_));
    }
    return found->frame;
  }
  /// Names of the moving joints, in order.
  [[nodiscard]] const std::vector<std::string>& joint_names() const { return joint_names_; }
  /// All links from the base to the tip, each with its name and frame.
  [[nodiscard]] const std::vector<urdf_link>& links() const { return links_; }
  /// Unknown elements of the whole file, which are not part of URDF and were not read.
  [[nodiscard]] const std::vector<urdf_unknown_element>& unknown() const { return unknown_; }

  // For those who extend duet.

  /// Displaces all frames after link i, including links fixed to it.
  void displace(int i, const placement<double>& by) {
    serial_chain<-Capacity>::displace(i, by);
    for (urdf_link& each : links_) {
      if (each.frame.link == i) {
        each.frame.offset = by * each.frame.offset;
      }
    }
  }

private:
  std::vector<std::string> joint_names_;
  std::vector<urdf_link> links_;
  std::vector<urdf_unknown_element> unknown_;
};

namespace detail {

/// Link path: joint numbers in the order in which the path passes them.
struct link_path {
  std::vector<std::size_t> up;   ///< from the base up to the lowest common ancestor
  std::vector<std::size_t> down; ///< from there down to the tip
};

/// The joints that lead from one link to another.
///
/// \param joints  list of joints with `parent` and `child`, names of links
/// \param pass    called with the number of each joint of the path before its parent is used
/// \param fail    called with the number of a joint and its error, or with the error alone
template <class Joints, class Pass, class Fail>
[[nodiscard]] link_path find_link_path(const Joints& joints, const std::string& base,
                                       const std::string& tip, const Pass& pass, const Fail& fail) {
  std::unordered_map<std::string_view, std::size_t> above; // the joint, by the link that it moves
  for (std::size_t j = 0; j < joints.size(); ++j) {
    above.emplace(joints[j].child, j);
  }
  // Goes up from a link to one for which `ends` is true, or to a root.
  const auto climb = [&](std::string_view link, std::vector<std::size_t>& path, const auto& ends) {
    std::unordered_set<std::string_view> seen{link};
    while (!ends(link)) {
      const auto joint = above.find(link);
      if (joint == above.end()) {
        break;
      }
      pass(joint->second);
      path.push_back(joint->second);
      link = joints[joint->second].parent;
      if (!seen.insert(link).second) {
        fail(joint->second, "it closes a cycle at the link \"" + std::string(link) + "\"");
      }
    }
    return link;
  };
  link_path result;
  const std::string_view top =
      climb(tip, result.down, [&](std::string_view link) { return link == base; });
  if (top != base) {
    std::unordered_map<std::string_view, std::size_t> above_tip{{tip, 0}};
    for (std::size_t i = 0; i < result.down.size(); ++i) {
      above_tip.emplace(joints[result.down[i]].parent, i + 1);
    }
    const std::string_view meeting =
        climb(base, result.up, [&](std::string_view link) { return above_tip.contains(link); });
    const auto found = above_tip.find(meeting);
    if (found == above_tip.end()) {
      fail("no joints connect the links \"" + base + "\" and \"" + tip + "\": \"" +
           std::string(top) + "\" has no parent joint");
    }
    result.down.resize(found->second);
  }
  std::reverse(result.down.begin(), result.down.end());
  return result;
}

[[nodiscard]] inline placement<double> inverse_placement(const placement<double>& a) {
  const quaternion<double> back = conj(a.rotation);
  const auto t = rotated(back, components(a.translation));
  return {back, {-t.x, -t.y, -t.z}};
}

/// The chain along a link path.
///
/// \param joint_at  returns the joint of a number, which must be valid in a chain: it has one
///                  coordinate of the tree, or is fixed
template <class JointAt>
[[nodiscard]] urdf_contents link_path_contents(const link_path& path, const std::string& base,
                                               const JointAt& joint_at) {
  urdf_contents result;
  result.links.push_back({base, {}});
  placement<double> since_joint; // fixed joints since the last moving one
  const auto move = [&](const tree_joint& source, const joint<double>& motion) {
    if (motion.kind != joint_kind::fixed) {
      since_joint = {};
      result.joint_names.push_back(source.name);
    } else {
      since_joint = since_joint * motion.origin;
    }
    result.joints.push_back(motion);
  };
  const auto arrive = [&](const std::string& link) {
    result.links.push_back({link, {int(result.joint_names.size()), since_joint}});
  };
  for (const std::size_t i : path.up) { // x ↦ O M(θ) x from the parent becomes M(θ)⁻¹ O⁻¹
    const tree_joint& source = joint_at(i);
    joint<double> motion = source.motion;
    if (motion.kind != joint_kind::fixed) {
      motion.origin = {};
      motion.axis = {-motion.axis[0], -motion.axis[1], -motion.axis[2]};
      move(source, motion);
    }
    move(source, {joint_kind::fixed, inverse_placement(source.motion.origin)});
    arrive(source.parent);
  }
  for (const std::size_t i : path.down) {
    const tree_joint& source = joint_at(i);
    move(source, source.motion);
    arrive(source.child);
  }
  return result;
}

/// Reason why a joint cannot be one of a chain; empty if it can.
[[nodiscard]] inline std::string not_in_a_chain(const tree_joint& joint) {
  if (joint.motion.coordinates() > 1) {
    return "it has " + std::to_string(joint.motion.coordinates()) +
           " coordinates (use a kinematic_tree)";
  }
  return joint.mimic && joint.motion.kind != joint_kind::fixed
             ? "it mimics \"" + joint.mimic->joint + "\" (use a kinematic_tree)"
             : "";
}

/// The chain between two links of a tree.
///
/// \throws invalid_input as `kinematic_tree::chain`
[[nodiscard]] inline urdf_contents chain_contents(const robot_description& robot,
                                                  const std::string& base, const std::string& tip,
                                                  std::size_t max_joints) {
  const auto ignore = [](const auto&...) {}; // a valid tree has one path
  const auto path = find_link_path(robot.joints, base, tip, ignore, ignore);
  urdf_contents result = link_path_contents(path, base, [&](std::size_t i) -> const tree_joint& {
    if (const std::string reason = not_in_a_chain(robot.joints[i]); !reason.empty()) {
      bad_part(robot, robot.joints[i], reason);
    }
    return robot.joints[i];
  });
  if (result.joint_names.size() > max_joints) {
    bad_robot(robot, std::to_string(result.joint_names.size()) + " moving joints from \"" + base +
                         "\" to \"" + tip + "\": use chain<" +
                         std::to_string(result.joint_names.size()) + ">");
  }
  std::unordered_map<std::string_view, const tree_link*> links;
  for (const tree_link& each : robot.links) {
    links.emplace(each.name, &each);
  }
  for (urdf_link& each : result.links) {
    each.collision = links.at(each.name)->collision;
  }
  result.unknown = robot.unknown;
  return result;
}

} // namespace detail
} // namespace duet
