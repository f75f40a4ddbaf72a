// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/kinematics/collision_shape.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Contents of a robot description.

namespace duet {

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

} // namespace duet

namespace duet::detail {

/// The chain from one link to another.
struct urdf_contents {
  std::vector<joint<double>> joints;    ///< joints, including fixed ones
  std::vector<std::string> joint_names; ///< names of the moving joints
  std::vector<urdf_link> links;         ///< links from the base on
  std::vector<urdf_unknown_element> unknown;
};

} // namespace duet::detail
