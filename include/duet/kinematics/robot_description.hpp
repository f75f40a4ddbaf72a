// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/file_error.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/kinematics/joint.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// \file
/// A robot as data, from a file or written in code: its links with their collision shapes, the
/// joints between them, and summaries of files.

namespace duet {

/// A box centred at the origin, with edges along the axes.
struct collision_box {
  std::array<double, 3> size = {}; ///< lengths of the edges, in units of length
};

/// A cylinder centred at the origin, along z.
struct collision_cylinder {
  double radius = 0; ///< radius, in units of length
  double length = 0; ///< total length, in units of length
};

/// A capsule centred at the origin, along z: a cylinder with a hemisphere on each end.
struct collision_capsule {
  double radius = 0; ///< radius of cylinder and hemispheres, in units of length
  double length = 0; ///< length of the cylinder alone, in units of length
};

/// A sphere centred at the origin.
struct collision_sphere {
  double radius = 0; ///< radius, in units of length
};

/// A triangle mesh in a file.
struct collision_mesh {
  std::string file;                        ///< name as written, including `package://…`
  std::array<double, 3> scale = {1, 1, 1}; ///< scale factors of its coordinates; default: 1
};

/// One of the collision shapes of a link.
struct collision_shape {
  placement<double> frame = {}; ///< pose of the shape in the frame of the link
  std::variant<collision_box, collision_cylinder, collision_capsule, collision_sphere,
               collision_mesh>
      geometry;         ///< shape at the origin of the frame, along its axes
  std::size_t line = 0; ///< line in its file; 0: not from a file
};

/// A joint of a robot description.
struct urdf_joint {
  std::string name;   ///< name of the joint
  std::string type;   ///< `revolute`, `continuous`, `prismatic`, `fixed` or another type
  std::string parent; ///< name of the parent link
  std::string child;  ///< name of the link that it moves
};

/// An element of a robot description that is not part of URDF, perhaps misspelt; nothing
/// in it is read.
struct urdf_unknown_element {
  std::string name;     ///< tag, `tool` of `<tool>`
  std::string within;   ///< parent element: `<robot>`, a link or a joint with its name
  std::size_t line = 0; ///< line where it begins
};

/// Links and joints of a robot description, in the order of the file.
struct urdf_summary {
  std::vector<std::string> links;            ///< names of the links
  std::vector<urdf_joint> joints;            ///< joints, including fixed ones
  std::vector<urdf_unknown_element> unknown; ///< elements that are not URDF and are not read
};

/// A pair of links, by their names.
struct link_pair {
  std::string first;  ///< name of one link
  std::string second; ///< name of the other link
};

/// A link of a chain from a robot description.
struct urdf_link {
  std::string name;             ///< name in the file
  attached_frame<double> frame; ///< its frame on the chain, for `pose` and `jacobian`
  std::vector<collision_shape> collision = {}; ///< collision shapes, in the frame of the link
};

/// Text with one link or joint a line, `shoulder_pan_joint: revolute, base_link -> shoulder_link`,
/// and the unknown elements, if there are any: `line 12: <tool> in <link name="hand">`.
[[nodiscard]] inline std::string to_text(const urdf_summary& robot) {
  std::string text = "links:\n";
  for (const std::string& link : robot.links) {
    text += "  " + link + "\n";
  }
  text += "joints:\n";
  for (const urdf_joint& each : robot.joints) {
    text += "  " + each.name + ": " + each.type + ", " + each.parent + " -> " + each.child + "\n";
  }
  if (!robot.unknown.empty()) {
    text += "unknown elements:\n";
  }
  for (const urdf_unknown_element& each : robot.unknown) {
    text +=
        "  line " + std::to_string(each.line) + ": <" + each.name + "> in " + each.within + "\n";
  }
  return text;
}

namespace detail {

/// The chain from one link to another.
struct urdf_contents {
  std::vector<joint<double>> joints;    ///< joints, including fixed ones
  std::vector<std::string> joint_names; ///< names of the moving joints
  std::vector<urdf_link> links;         ///< links from the base on
  std::vector<urdf_unknown_element> unknown;
};

} // namespace detail

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

namespace detail {

/// Names of links or joints.
template <class Parts>
[[nodiscard]] std::vector<std::string> names_of(const Parts& parts) {
  std::vector<std::string> names;
  for (const auto& each : parts) {
    names.push_back(each.name);
  }
  return names;
}

/// Throws the error of a robot, with its file and its line in it if it is from a file.
template <class... Line>
[[noreturn]] void bad_robot(const robot_description& robot, const std::string& what, Line... line) {
  if (robot.file.empty()) {
    raise(invalid_input(printable("duet: kinematic_tree: " + what)));
  }
  raise(file_error(robot.file, line..., what));
}
/// Throws the error of a link or a joint; its message is joined from `what`.
template <class Part, class... What>
[[noreturn]] void bad_part(const robot_description& robot, const Part& part, const What&... what) {
  const char* const tag = requires { part.motion; }
  ? "joint" : "link";
  bad_robot(robot, message("<", tag, " name=\"", part.name, "\">: ", what...), part.line);
}
template <class Part, class... What>
void require_part(bool condition, const robot_description& robot, const Part& part,
                  const What&... what) {
  if (!condition) {
    bad_part(robot, part, what...);
  }
}

} // namespace detail
} // namespace duet
