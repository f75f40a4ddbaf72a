// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/kinematics/collision_shape.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/robot_contents.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// \file
/// A robot as data: its links and the joints between them, from a file or written in code.

namespace duet {

/// Inertia of a link.
struct link_inertia {
  double mass = 0;                 ///< mass, in units of mass
  placement<double> frame = {};    ///< frame at the centre of mass, in the frame of the link
  std::array<double, 6> moments{}; ///< I_xx, I_xy, I_xz, I_yy, I_yz, I_zz in that frame
};

/// A link of a robot.
struct tree_link {
  std::string name;                            ///< unique name
  std::optional<link_inertia> inertia = {};    ///< mass and moments of inertia; empty: massless
  std::size_t line = 0;                        ///< line in its file; 0: not from a file
  std::vector<collision_shape> collision = {}; ///< collision shapes
};

/// Coupling of a joint to another joint (mimic): multiplier × the coordinate of that
/// joint + offset.
struct joint_mimic {
  std::string joint;     ///< name of the other joint
  double multiplier = 1; ///< dimensionless, or units of length per radian and the reverse
  double offset = 0;     ///< in radians or units of length
};

/// A joint of a robot, between two links.
struct tree_joint {
  std::string name;          ///< unique name
  std::string parent;        ///< name of the parent link
  std::string child;         ///< name of the link that it moves, whose frame is that of the joint
  joint<double> motion = {}; ///< origin in the frame of the parent, type, axis and limits
  std::optional<joint_mimic> mimic = {}; ///< joint that it mimics; empty: independent
  std::size_t line = 0;                  ///< line in its file; 0: not from a file
};

/// Links and the joints between them.
///
/// Example: `kinematic_tree tree({.links = {{"base"}, {"arm"}}, .joints = {{"shoulder", "base",
/// "arm", {joint_kind::revolute}}}});`
struct robot_description {
  std::vector<tree_link> links = {};              ///< links in any order
  std::vector<tree_joint> joints = {};            ///< joints in the order of their coordinates
  std::vector<urdf_unknown_element> unknown = {}; ///< unknown elements, as in `urdf_summary`
  std::string file = {};                          ///< name of its file; empty: not from a file
};

} // namespace duet

namespace duet::detail {

/// The description in a file.
///
/// \throws file_error as `read_urdf_tree`, for errors of single links and joints
template <class Xml>
[[nodiscard]] robot_description read_urdf_description(const std::string& path);

/// Throws the error of a link or a joint, with its line if it is from a file.
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
