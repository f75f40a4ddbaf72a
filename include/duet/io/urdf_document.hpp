// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/closest_names.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/io/xml_element.hpp>
#include <duet/kinematics/robot_contents.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Elements and attributes of a URDF document, and their validation.

namespace duet::detail {

/// An element of a description and the joint or link that contains it, for messages.
struct urdf_context {
  const xml_element& element;
  const xml_element* owner = nullptr;
};

/// A known element: its attributes, others being errors, and the elements that it may contain.
struct urdf_element_kind {
  std::string_view name;
  std::array<std::string_view, 7> attributes;
  std::array<std::string_view, 9> children = {};
  /// Attributes that files of known robots have for other programs; they are ignored.
  std::array<std::string_view, 3> foreign = {};
};
inline constexpr std::array<urdf_element_kind, 20> urdf_element_kinds{
    {{"robot",
      {"name", "version"},
      {"link", "joint", "material", "transmission", "gazebo", "sensor"}},
     {"link", {"name", "type"}, {"inertial", "visual", "collision"}, {"concave"}},
     {"collision", {"name"}, {"origin", "geometry"}, {"group", "concave"}},
     {"geometry", {}, {"box", "cylinder", "capsule", "sphere", "mesh"}, {"name"}},
     {"box", {"size"}, {}, {"scale"}},
     {"cylinder", {"radius", "length"}},
     {"capsule", {"radius", "length"}},
     {"sphere", {"radius"}},
     {"mesh", {"filename", "scale"}},
     {"inertial", {}, {"origin", "mass", "inertia"}},
     {"mass", {"value"}},
     {"inertia", {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}, {}, {"iyx", "izx", "izy"}},
     {"joint",
      {"name", "type"},
      {"origin", "parent", "child", "axis", "limit", "mimic", "safety_controller", "dynamics",
       "calibration"},
      {"dont_collapse"}},
     {"parent", {"link"}},
     {"child", {"link"}},
     {"origin", {"xyz", "rpy"}},
     {"axis", {"xyz"}, {}, {"rpy"}},
     {"limit",
      {"lower", "upper", "velocity", "effort", "acceleration", "deceleration", "jerk"},
      {},
      {"command_effort", "current", "gear_velocity"}},
     {"mimic", {"joint", "multiplier", "offset"}},
     {"safety_controller", {"soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity"}}}};

/// A description whose elements and attributes have been checked against the format.
class urdf_document {
public:
  /// \throws file_error for another root than `<robot>`, and for unknown attributes
  urdf_document(std::string path, xml_element robot)
      : path_(std::move(path)), robot_(std::move(robot)) {
    if (robot_.name != "robot") {
      fail(robot_.line, "the root is <" + robot_.name + "> (expected <robot>)");
    }
    check(robot_);
  }

  [[nodiscard]] const xml_element& robot() const { return robot_; }
  [[nodiscard]] const std::vector<urdf_unknown_element>& unknown() const { return unknown_; }

  [[noreturn]] void fail(const std::string& what) const { raise(file_error(path_, what)); }
  [[noreturn]] void fail(const urdf_context& context, const std::string& what) const {
    fail(context.element.line, name_of(context) + ": " + what);
  }

  [[nodiscard]] const std::string& attribute(const urdf_context& context,
                                             std::string_view key) const {
    const std::string* const value = context.element.attribute(key);
    if (value == nullptr) {
      fail(context, "no attribute \"" + std::string(key) + "\"");
    }
    return *value;
  }

  [[noreturn]] void fail_negative(const urdf_context& context, std::string_view key) const {
    fail(context, std::string(key) + "=\"" + attribute(context, key) + "\" is negative");
  }

  /// A limit, infinite if it exceeds 1e6 in the direction of `sign`: such a number means unlimited.
  [[nodiscard]] double limit(const urdf_context& context, std::string_view key, double otherwise,
                             int sign) const {
    const std::string* const text = context.element.attribute(key);
    if (text == nullptr) {
      return otherwise;
    }
    const auto value = parse_number(*text);
    return value && sign * *value > max_number ? sign * std::numeric_limits<double>::infinity()
                                               : number(*text, context, key);
  }

  /// The three numbers of an attribute.
  [[nodiscard]] std::array<double, 3> numbers(const urdf_context& context, std::string_view key,
                                              const std::array<double, 3>& otherwise) const {
    const std::string* const text = context.element.attribute(key);
    if (text == nullptr) {
      return otherwise;
    }
    constexpr std::string_view blanks = " \t\r\n";
    std::array<double, 3> result{};
    std::size_t count = 0, end = 0;
    for (std::size_t first; (first = text->find_first_not_of(blanks, end)) != std::string::npos;) {
      end = std::min(text->find_first_of(blanks, first), text->size());
      if (count == 3) {
        ++count;
        break;
      }
      result[count++] = number(text->substr(first, end - first), context, key);
    }
    if (count != 3) {
      fail(context, std::string(key) + "=\"" + *text + "\" is not three numbers");
    }
    return result;
  }

  /// A required number.
  [[nodiscard]] double number(const urdf_context& context, std::string_view key) const {
    return number(attribute(context, key), context, key);
  }
  [[nodiscard]] double number(const urdf_context& context, std::string_view key,
                              double otherwise) const {
    const std::string* const text = context.element.attribute(key);
    return text == nullptr ? otherwise : number(*text, context, key);
  }

  /// A required mass or moment of inertia, of any size.
  [[nodiscard]] double measure(const urdf_context& context, std::string_view key) const {
    return number(attribute(context, key), context, key, std::numeric_limits<double>::max());
  }

private:
  static constexpr double max_number =
      1e6; ///< maximum length (m) and angle (rad); larger: digits lost

  [[nodiscard]] static std::string name_of(const urdf_context& context) {
    const std::string* const name = context.element.attribute("name");
    return (context.owner != nullptr ? name_of({*context.owner}) + " " : "") + "<" +
           context.element.name + (name != nullptr ? " name=\"" + *name + "\"" : "") + ">";
  }
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    raise(file_error(path_, line, what));
  }

  [[nodiscard]] double number(const std::string& text, const urdf_context& context,
                              std::string_view key, double limit = max_number) const {
    const auto value = parse_number(text);
    if (!value || !(std::abs(*value) <= limit)) {
      fail(context,
           std::string(key) + "=\"" + text +
               (limit > max_number ? "\" is not a finite number" : "\" is not a number up to 1e6"));
    }
    return *value;
  }

  /// Checks an element and those in it that are read. Elements with a prefix, and attributes that
  /// declare one, belong to other programs.
  void check(const xml_element& element, const xml_element* owner = nullptr) {
    const auto kind =
        std::find_if(urdf_element_kinds.begin(), urdf_element_kinds.end(),
                     [&](const urdf_element_kind& each) { return each.name == element.name; });
    if (kind == urdf_element_kinds.end()) {
      return;
    }
    for (const auto& [key, value] : element.attributes) {
      if (key != "xmlns" && key.find(':') == std::string::npos && !has(kind->foreign, key) &&
          !has(kind->attributes, key)) {
        std::vector<std::string> known(kind->attributes.begin(), kind->attributes.end());
        std::erase(known, "");
        fail({element, owner}, "unknown attribute \"" + key + "\": " + closest_names(key, known));
      }
    }
    const bool is_part = element.name == "link" || element.name == "joint";
    for (const xml_element& each : element.children) {
      if (!has(kind->children, each.name)) {
        unknown_.push_back({each.name, name_of({element, owner}), each.line});
        continue;
      }
      const urdf_context context{each, is_part ? &element : owner};
      const bool is_one_of_many =
          element.name == "robot" || each.name == "visual" || each.name == "collision";
      if (const xml_element* first = is_one_of_many ? &each : element.child(each.name);
          first != &each) {
        fail(context, "it is repeated, first in line " + std::to_string(first->line));
      }
      check(each, context.owner);
    }
  }
  [[nodiscard]] static bool has(const auto& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  }

  std::string path_;
  xml_element robot_;
  std::vector<urdf_unknown_element> unknown_;
};

} // namespace duet::detail
