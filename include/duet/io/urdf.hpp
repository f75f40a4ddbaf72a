// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file_error.hpp>
#include <duet/kinematics/kinematic_tree.hpp>
#include <duet/kinematics/robot_description.hpp>
#include <duet/kinematics/urdf_chain.hpp>

#include <cstddef>
#include <string>

/// \file
/// Chains and trees from robot descriptions in URDF, the XML format of the robot operating system.

namespace duet::detail {
DUET_ABI_BEGIN

/// The contents of the chain between two links.
///
/// \param max_joints  maximum number of moving joints
/// \throws file_error as `read_urdf`
[[nodiscard]] urdf_contents read_urdf_contents(const std::string& path, const std::string& base,
                                               const std::string& tip, std::size_t max_joints);

DUET_ABI_END
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

/// The chain from one link of a robot description to another, both by their names, in metres and
/// radians. Joint limits are those of `limit`, narrowed by the soft limits of `safety_controller`;
/// a bound beyond ±1e6 means unlimited. XML is read by expat, without which duet::io may be built.
///
/// \tparam Capacity  maximum number of moving joints; their number is known at run time
/// \throws file_error with line and element for errors anywhere in the file: XML that is not well
/// formed, nested more than 100 deep or has a document type; unknown attributes of links and
/// joints; missing and repeated elements and attributes; repeated names; links with two parent
/// joints; and in the chain for links that do not exist, invalid numbers, axes that are not unit
/// vectors, cycles, joints that mimic others, are planar, floating or of an unknown type; for too
/// many joints; and for all files if duet::io was built without expat
template <int Capacity = 16>
[[nodiscard]] urdf_chain<Capacity> read_urdf(const std::string& path, const std::string& base,
                                             const std::string& tip) {
  return urdf_chain<Capacity>(detail::read_urdf_contents(path, base, tip, Capacity));
}

/// The kinematic tree of all links and joints of a robot description, including planar and floating
/// joints, joints that mimic others, several tips and masses, and collision shapes as data. All
/// else as `read_urdf`.
///
/// Example: `const auto robot = read_urdf_tree("robot.urdf"); robot.pose(q, robot.link("hand"));`
///
/// \throws file_error as `read_urdf`, for errors anywhere in the file, and as `kinematic_tree`
[[nodiscard]] kinematic_tree read_urdf_tree(const std::string& path);

/// The links and joints of a robot description, to choose a base and a tip from.
///
/// Example: `std::cout << to_text(read_urdf_summary("robot.urdf"));`
///
/// \throws file_error for a file that cannot be read, as `read_urdf`
[[nodiscard]] urdf_summary read_urdf_summary(const std::string& path);

DUET_ABI_END
} // namespace duet
