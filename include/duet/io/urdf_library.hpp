// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/io/srdf_reader.hpp>
#include <duet/io/urdf_reader.hpp>
#include <duet/io/xml_element.hpp>
#include <duet/io/xml_parser.hpp>
#include <duet/kinematics/robot_contents.hpp>
#include <duet/kinematics/robot_description.hpp>

#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Robot descriptions read with expat.

namespace duet::detail {

struct xml_library {
  [[nodiscard]] static xml_element read(const std::string& path) { return xml_parser(path).root(); }
};

template <class Xml>
urdf_contents read_urdf_contents(const std::string& path, const std::string& base,
                                 const std::string& tip, std::size_t max_joints) {
  return urdf_reader(path, Xml::read(path)).chain(base, tip, max_joints);
}

template <class Xml>
robot_description read_urdf_description(const std::string& path) {
  return urdf_reader(path, Xml::read(path)).description();
}

template <class Xml>
urdf_summary read_names_in_urdf(const std::string& path) {
  return urdf_reader(path, Xml::read(path)).names();
}

template <class Xml>
std::vector<link_pair> read_disabled_collisions_in_srdf(const std::string& path) {
  return disabled_collisions(path, Xml::read(path));
}

} // namespace duet::detail
