// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// XML files, read by expat: everything that the standard calls an error is one.

namespace duet::detail {
DUET_ABI_BEGIN

/// An XML element.
struct xml_element {
  std::string name;
  std::size_t line = 0; ///< line where it begins
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text; ///< text directly in the element, if kept
  std::vector<xml_element> children;
  const xml_element* owner = nullptr; ///< for readers; null if they do not set it

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

/// Treatment of text between elements.
enum class xml_text { skipped, kept };

/// The root element of a file with all its contents.
///
/// \throws file_error for XML that is not well formed, has a document type (and with it
/// entities), is nested more than 100 deep or too large; and for all files if the library was built
/// without expat
[[nodiscard]] xml_element read_xml(const std::string& path, std::size_t max_megabytes = 16,
                                   xml_text text = xml_text::skipped);

DUET_ABI_END
} // namespace duet::detail
