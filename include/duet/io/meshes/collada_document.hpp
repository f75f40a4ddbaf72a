// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/text_rows.hpp>
#include <duet/io/xml_element.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Elements, numbers and references of COLLADA as such, and what may be wrong with them.

namespace duet::detail {

class collada_document {
public:
  /// \throws file_error for another root than `<COLLADA>`, and for units of parts
  collada_document(std::string path, xml_element root)
      : path_(std::move(path)), root_(std::move(root)) {
    if (root_.name != "COLLADA") {
      raise(file_error(path_, root_.line, "the root is <" + root_.name + ">, not <COLLADA>"));
    }
    add(root_);
  }
  collada_document(const collada_document&) = delete;
  collada_document& operator=(const collada_document&) = delete;

  [[nodiscard]] const xml_element& root() const { return root_; }

  [[noreturn]] void fail(const xml_element& in, const std::string& what) const {
    const std::string* const id = in.attribute("id");
    raise(file_error(path_, in.line,
                     "<" + in.name + (id != nullptr ? " id=\"" + *id + "\"" : "") + ">: " + what));
  }

  [[nodiscard]] const std::string& attribute(const xml_element& in, std::string_view key) const {
    const std::string* const value = in.attribute(key);
    if (value == nullptr) {
      fail(in, "no attribute \"" + std::string(key) + "\"");
    }
    return *value;
  }
  /// A whole number from 0 up: so small that products of two are exact.
  [[nodiscard]] std::uint64_t count(const xml_element& in, std::string_view key) const {
    const std::string& text = attribute(in, key);
    const auto value = parse_number(text);
    if (!value || !(*value >= 0 && *value <= 1e9) || *value != std::floor(*value)) {
      fail(in, std::string(key) + "=\"" + text + "\" is no whole number from 0 to 1e9");
    }
    return std::uint64_t(*value);
  }
  [[nodiscard]] std::uint64_t count(const xml_element& in, std::string_view key,
                                    std::uint64_t otherwise) const {
    return in.attribute(key) == nullptr ? otherwise : count(in, key);
  }

  /// The one child of a name.
  [[nodiscard]] const xml_element& child(const xml_element& in, std::string_view name) const {
    const xml_element* found = nullptr;
    for (const xml_element& each : in.children) {
      if (each.name == name) {
        if (found != nullptr) {
          fail(each, "is there twice, first in line " + std::to_string(found->line));
        }
        found = &each;
      }
    }
    if (found == nullptr) {
      fail(in, "no element <" + std::string(name) + ">");
    }
    return *found;
  }

  /// The element that an attribute names by its id.
  [[nodiscard]] const xml_element& target(const xml_element& from, std::string_view key,
                                          std::string_view name) const {
    const std::string& url = attribute(from, key);
    if (!url.starts_with('#')) {
      fail(from, std::string(key) + "=\"" + url + "\" is not #id: other files are not read");
    }
    const auto found = by_id_.find({name, std::string_view(url).substr(1)});
    if (found == by_id_.end()) {
      fail(from, std::string(key) + "=\"" + url + "\": there is no <" + std::string(name) +
                     " id=\"" + url.substr(1) + "\">");
    }
    if (found->second.again != nullptr) {
      fail(*found->second.again,
           "the id is there twice, first in line " + std::to_string(found->second.first->line));
    }
    return *found->second.first;
  }

  /// The numbers that an element consists of, all finite.
  [[nodiscard]] std::vector<double> numbers(const xml_element& in) const {
    std::vector<double> result;
    for_each_word(in.text, [&](std::string_view word) {
      const auto value = parse_number(word);
      if (!value || !std::isfinite(*value)) {
        fail(in, "number " + std::to_string(result.size()) + ", \"" + std::string(word) +
                     (value ? "\", is not finite" : "\", is no number"));
      }
      result.push_back(*value);
    });
    return result;
  }
  [[nodiscard]] std::vector<double> numbers(const xml_element& in, std::size_t count) const {
    std::vector<double> result = numbers(in);
    if (result.size() != count) {
      fail(in, "has " + std::to_string(result.size()) + " numbers in place of " +
                   std::to_string(count));
    }
    return result;
  }

private:
  struct named_element {
    const xml_element* first;
    const xml_element* again = nullptr; ///< of the same id
  };

  void add(const xml_element& element) {
    if (const std::string* const id = element.attribute("id")) {
      const auto [place, is_new] = by_id_.try_emplace({element.name, *id}, named_element{&element});
      if (!is_new) {
        place->second.again = &element;
      }
    }
    for (const xml_element& each : element.children) {
      if (each.name == "asset" && &element != &root_ && each.child("unit") != nullptr) {
        fail(*each.child("unit"), "a unit of <" + element.name + "> alone is not supported");
      }
      add(each);
    }
  }

  std::string path_;
  xml_element root_;
  std::map<std::pair<std::string_view, std::string_view>, named_element> by_id_; ///< name, id
};

} // namespace duet::detail
