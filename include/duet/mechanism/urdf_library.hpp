// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/mechanism/urdf_contents.hpp>
#include <duet/mechanism/urdf_reader.hpp>
#include <duet/mechanism/xml_element.hpp>
#include <duet/mechanism/xml_parser.hpp>

#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Robot descriptions read by expat.

namespace duet::detail {

struct xml_library {
  [[nodiscard]] static xml_element read(const std::string& path) { return xml_parser(path).root(); }
};

template <class Xml>
urdf_contents read_urdf_contents(const std::string& path, const std::string& base,
                                 const std::string& tip, std::size_t most) {
  const urdf_reader reader(path, Xml::read(path));
  urdf_contents result;
  std::vector<std::string>& names = result.joint_names;
  result.links.push_back({base, {}});
  result.unknown = reader.names().unknown;
  placement<double> since_joint; // fixed joints since the last one that moves
  for (const xml_element* element : reader.path(base, tip)) {
    result.joints.push_back(reader.read(*element));
    if (result.joints.back().kind == joint_kind::fixed) {
      since_joint = since_joint * result.joints.back().origin;
    } else {
      since_joint = {};
      names.push_back(reader.name(*element));
    }
    result.links.push_back({reader.child(*element), {int(names.size()), since_joint}});
  }
  if (names.size() > most) {
    reader.fail(std::to_string(names.size()) + " moving joints from \"" + base + "\" to \"" + tip +
                "\": use read_urdf<" + std::to_string(names.size()) + ">");
  }
  return result;
}

template <class Xml>
urdf_names read_names_in_urdf(const std::string& path) {
  return urdf_reader(path, Xml::read(path)).names();
}

} // namespace duet::detail
