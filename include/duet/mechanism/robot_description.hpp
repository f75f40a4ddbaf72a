// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/mechanism/collision_shape.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/urdf_contents.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// \file
/// A robot as data: its links and the joints between them, from a file or written down in code.

namespace duet {

/// What a link weighs.
struct link_inertia {
  double mass = 0;                 ///< in units of mass
  placement<double> frame = {};    ///< its origin is the centre of mass, in the frame of the link
  std::array<double, 6> moments{}; ///< I_xx, I_xy, I_xz, I_yy, I_yz, I_zz about it, in its axes
};

/// A link of a robot.
struct tree_link {
  std::string name;                            ///< no other link's
  std::optional<link_inertia> inertia = {};    ///< nothing: it weighs nothing
  std::size_t line = 0;                        ///< of the file that it is from; 0: of none
  std::vector<collision_shape> collision = {}; ///< of what it consists for collisions
};

/// A coordinate that is a multiple of another joint's: multiplier × its coordinate + offset.
struct joint_mimic {
  std::string joint;     ///< the name of that joint
  double multiplier = 1; ///< without dimension, or units of length per radian and the reverse
  double offset = 0;     ///< radians or units of length
};

/// A joint of a robot, between two links.
struct tree_joint {
  std::string name;          ///< no other joint's
  std::string parent;        ///< the link that it hangs on
  std::string child;         ///< the link that it moves, whose frame is the joint's
  joint<double> motion = {}; ///< its origin in the frame of the parent, and how it moves
  std::optional<joint_mimic> mimic = {}; ///< nothing: its coordinates are its own
  std::size_t line = 0;                  ///< of the file that it is from; 0: of none
};

/// Links and the joints between them.
///
/// Example: `kinematic_tree tree({.links = {{"base"}, {"arm"}}, .joints = {{"shoulder", "base",
/// "arm", {joint_kind::revolute}}}});`
struct robot_description {
  std::vector<tree_link> links = {};              ///< in any order
  std::vector<tree_joint> joints = {};            ///< in the order of their coordinates
  std::vector<urdf_unknown_element> unknown = {}; ///< of its file, as `urdf_names` has them
  std::string file = {};                          ///< that it is from; empty: none
};

} // namespace duet

namespace duet::detail {

/// The description in a file.
/// \throws file_error as `read_urdf_tree`, of links and joints by themselves
template <class Xml>
[[nodiscard]] robot_description read_urdf_description(const std::string& path);

/// Says what is wrong with a link or a joint, and where in the file it is.
template <class Part>
[[noreturn]] void bad_part(const robot_description& robot, const char* tag, const Part& part,
                           const std::string& what) {
  const std::string text = std::string("<") + tag + " name=\"" + part.name + "\">: " + what;
  if (robot.file.empty()) {
    raise(invalid_input(printable("duet: kinematic_tree: " + text)));
  }
  raise(file_error(robot.file, part.line, text));
}
[[noreturn]] inline void bad_part(const robot_description& robot, const tree_joint& part,
                                  const std::string& what) {
  bad_part(robot, "joint", part, what);
}
[[noreturn]] inline void bad_part(const robot_description& robot, const tree_link& part,
                                  const std::string& what) {
  bad_part(robot, "link", part, what);
}
[[noreturn]] inline void bad_robot(const robot_description& robot, const std::string& what) {
  if (robot.file.empty()) {
    raise(invalid_input(printable("duet: kinematic_tree: " + what)));
  }
  raise(file_error(robot.file, what));
}

} // namespace duet::detail
