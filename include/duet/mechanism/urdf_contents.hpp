// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/mechanism/collision_shape.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/serial_chain.hpp>

#include <cstddef>
#include <string>
#include <vector>

/// \file
/// What is read from a robot description.

namespace duet {

/// A joint as a robot description has it.
struct urdf_joint_name {
  std::string name;   ///< of the joint
  std::string type;   ///< `revolute`, `continuous`, `prismatic`, `fixed` or another
  std::string parent; ///< the link that it hangs on
  std::string child;  ///< the link that it moves
};

/// An element of a robot description that URDF has not, perhaps misspelt: nothing is read of it.
struct urdf_unknown_element {
  std::string name;     ///< `tool` of `<tool>`
  std::string within;   ///< the element that it is in: `<robot>`, a link or a joint with its name
  std::size_t line = 0; ///< where it begins
};

/// What a robot description has, in the order of the file.
struct urdf_names {
  std::vector<std::string> links;            ///< names of the links
  std::vector<urdf_joint_name> joints;       ///< fixed ones included
  std::vector<urdf_unknown_element> unknown; ///< elements that are not read, as URDF has them not
};

/// Two links by their names.
struct link_pair {
  std::string first;  ///< the name of one
  std::string second; ///< the name of the other
};

/// A link of a chain that was read.
struct urdf_link {
  std::string name;             ///< as in the file
  attached_frame<double> frame; ///< where it is attached: what `pose` and `jacobian` take
  std::vector<collision_shape> collision = {}; ///< of what it consists for collisions, in its frame
};

/// One link or joint a line, `shoulder_pan_joint: revolute, base_link -> shoulder_link`, and what
/// is not read, if there is something: `line 12: <tool> in <link name="hand">`.
[[nodiscard]] inline std::string to_text(const urdf_names& robot) {
  std::string text = "links:\n";
  for (const std::string& link : robot.links) {
    text += "  " + link + "\n";
  }
  text += "joints:\n";
  for (const urdf_joint_name& each : robot.joints) {
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

/// From one link to another.
struct urdf_contents {
  std::vector<joint<double>> joints;    ///< fixed ones included
  std::vector<std::string> joint_names; ///< of those that move
  std::vector<urdf_link> links;         ///< from the base on
  std::vector<urdf_unknown_element> unknown;
};

/// By which library XML is read: in `urdf_library.hpp`.
struct xml_library;

/// A template so that compilers make the parser for those alone who read a file.
/// \param most  how many joints may move
/// \throws file_error as `read_urdf`
template <class Xml>
[[nodiscard]] urdf_contents read_urdf_contents(const std::string& path, const std::string& base,
                                               const std::string& tip, std::size_t most);

/// \throws file_error as `read_disabled_collisions`
template <class Xml>
[[nodiscard]] std::vector<link_pair> read_disabled_collisions_in_srdf(const std::string& path);

/// \throws file_error as `read_urdf_names`
template <class Xml>
[[nodiscard]] urdf_names read_names_in_urdf(const std::string& path);

} // namespace duet::detail
