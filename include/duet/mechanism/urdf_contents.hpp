// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/serial_chain.hpp>

#include <cstddef>
#include <string>
#include <vector>

/// \file
/// What is read from a robot description.

namespace duet::detail {

struct urdf_link {
  std::string name;
  attached_frame<double> frame;
};

/// From one link to another.
struct urdf_contents {
  std::vector<joint<double>> joints;    ///< fixed ones included
  std::vector<std::string> joint_names; ///< of those that move
  std::vector<urdf_link> links;         ///< from the base on
};

/// By which library XML is read: in `urdf_reader.hpp`.
struct xml_library;

/// A template so that compilers make the parser for those alone who read a file.
/// \param most  how many joints may move
/// \throws file_error as `read_urdf`
template <class Xml>
[[nodiscard]] urdf_contents read_urdf_contents(const std::string& path, const std::string& base,
                                               const std::string& tip, std::size_t most);

} // namespace duet::detail
