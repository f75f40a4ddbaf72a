// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// XML elements, independent of the parser.

namespace duet::detail {

struct xml_element {
  std::string name;
  std::size_t line = 0; ///< line where it begins
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text; ///< text directly in the element, if kept
  std::vector<xml_element> children;

  /// The value of an attribute, or `nullptr`.
  [[nodiscard]] const std::string* attribute(std::string_view key) const {
    for (const auto& [name_of_it, value] : attributes) {
      if (name_of_it == key) {
        return &value;
      }
    }
    return nullptr;
  }
  /// The first child with a tag, or `nullptr`.
  [[nodiscard]] const xml_element* child(std::string_view tag) const {
    for (const xml_element& each : children) {
      if (each.name == tag) {
        return &each;
      }
    }
    return nullptr;
  }
};

} // namespace duet::detail
