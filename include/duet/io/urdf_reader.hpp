// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/closest_names.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/io/urdf_document.hpp>
#include <duet/io/urdf_shapes.hpp>
#include <duet/io/xml_element.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/robot_contents.hpp>
#include <duet/kinematics/robot_description.hpp>
#include <duet/kinematics/tree_chain.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

/// \file
/// Links and joints of a robot description: all, or those from one link to another.

namespace duet::detail {

class urdf_reader {
public:
  /// \throws file_error for errors anywhere in the description, except for numbers
  urdf_reader(const std::string& path, xml_element robot)
      : path_(path), document_(path, std::move(robot)) {
    names_.unknown = document_.unknown();
    for (const xml_element& each : document_.robot().children) {
      if (each.name == "link") {
        names_.links.push_back(add_name(each, links_));
      } else if (each.name == "joint") {
        add_joint(each);
      }
    }
  }
  urdf_reader(const urdf_reader&) = delete;
  urdf_reader& operator=(const urdf_reader&) = delete;

  [[nodiscard]] const urdf_summary& names() const { return names_; }

  /// The chain from the link `base` to the link `tip`.
  [[nodiscard]] urdf_contents chain(const std::string& base, const std::string& tip,
                                    std::size_t max_joints) const {
    for (const std::string& link : {base, tip}) {
      if (!links_.contains(link)) {
        document_.fail(no_link(link));
      }
    }
    const auto pass = [&](std::size_t i) {
      require_link({*elements_[i]->child("parent"), elements_[i]});
    };
    struct {
      const urdf_reader& reader;
      void operator()(std::size_t i, const std::string& what) const {
        reader.document_.fail({*reader.elements_[i]}, what);
      }
      void operator()(const std::string& what) const { reader.document_.fail(what); }
    } const fail{*this};
    const link_path path = find_link_path(names_.joints, base, tip, pass, fail);
    urdf_contents result = link_path_contents(path, base, [&](std::size_t i) {
      const tree_joint joint = read_joint(*elements_[i]);
      if (const std::string reason = not_in_a_chain(joint); !reason.empty()) {
        document_.fail({*elements_[i]}, reason);
      }
      return joint;
    });
    if (const std::size_t count = result.joint_names.size(); count > max_joints) {
      document_.fail(std::to_string(count) + " moving joints from \"" + base + "\" to \"" + tip +
                     "\": use read_urdf<" + std::to_string(count) + ">");
    }
    for (urdf_link& each : result.links) {
      each.collision = read_shapes(document_, *links_.at(each.name));
    }
    result.unknown = names_.unknown;
    return result;
  }

  /// All links and joints.
  [[nodiscard]] robot_description description() const {
    robot_description result;
    result.file = path_;
    result.unknown = names_.unknown;
    for (const xml_element& each : document_.robot().children) {
      if (each.name == "link") {
        result.links.push_back(read_link(each));
      } else if (each.name == "joint") {
        result.joints.push_back(read_joint(each));
      }
    }
    return result;
  }

private:
  using elements = std::unordered_map<std::string_view, const xml_element*>;

  [[nodiscard]] tree_link read_link(const xml_element& element) const {
    tree_link result{*element.attribute("name"), {}, element.line, read_shapes(document_, element)};
    const xml_element* const inertial = element.child("inertial");
    if (inertial == nullptr) {
      return result;
    }
    link_inertia& inertia = result.inertia.emplace();
    inertia.frame = read_origin(document_, *inertial, element);
    const xml_element* const mass = inertial->child("mass");
    if (mass == nullptr) {
      document_.fail({*inertial, &element}, "no element <mass>");
    }
    inertia.mass = document_.measure({*mass, &element}, "value");
    if (inertia.mass < 0) {
      document_.fail_negative({*mass, &element}, "value");
    }
    if (const xml_element* const moments = inertial->child("inertia")) {
      inertia.moments = read_moments({*moments, &element});
    }
    return result;
  }

  /// Upper half of a symmetric matrix, whose lower half may also be given.
  [[nodiscard]] std::array<double, 6> read_moments(const urdf_context& context) const {
    constexpr std::array<const char*, 6> keys = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
    constexpr std::array<const char*, 6> below = {"", "iyx", "izx", "", "izy", ""};
    std::array<double, 6> result{};
    for (std::size_t i = 0; i < keys.size(); ++i) {
      result[i] = document_.measure(context, keys[i]);
      if (context.element.attribute(below[i]) == nullptr) {
        continue;
      }
      const double other = document_.measure(context, below[i]);
      const double magnitude = std::max(std::abs(result[i]), std::abs(other));
      if (!(std::abs(result[i] / 2 - other / 2) <= 1e-6 * (magnitude / 2))) { // few digits, maybe
        document_.fail(context, std::string(below[i]) + "=\"" +
                                    document_.attribute(context, below[i]) + "\" differs from " +
                                    keys[i] + "=\"" + document_.attribute(context, keys[i]) +
                                    "\" (expected a symmetric matrix)");
      }
    }
    return result;
  }

  [[nodiscard]] tree_joint read_joint(const xml_element& element) const {
    tree_joint result;
    result.name = name(element);
    result.parent = *element.child("parent")->attribute("link");
    result.child = child(element);
    result.line = element.line;
    result.motion = read_motion(element);
    if (const xml_element* const mimic = element.child("mimic")) {
      const urdf_context context{*mimic, &element};
      result.mimic = {document_.attribute(context, "joint"),
                      document_.number(context, "multiplier", 1),
                      document_.number(context, "offset", 0)};
    }
    return result;
  }

  [[nodiscard]] joint<double> read_motion(const xml_element& element) const {
    joint<double> result;
    result.kind = kind(element);
    result.origin = read_origin(document_, element, element);
    if (result.kind != joint_kind::fixed) {
      result.axis = {1, 0, 0}; // default
      if (const xml_element* axis = element.child("axis")) {
        result.axis = document_.numbers({*axis, &element}, "xyz", result.axis);
        const double length = std::hypot(result.axis[0], result.axis[1], result.axis[2]);
        if (!is_nearly_one(length * length)) {
          document_.fail({*axis, &element},
                         "the axis has length " + to_text(length) + " (expected 1)");
        }
      }
      if (result.coordinates() == 1) { // the format defines no limits for several coordinates
        result.limits = limits(element, result.kind);
      }
    }
    return result;
  }

  [[nodiscard]] static const std::string& name(const xml_element& joint) {
    return *joint.attribute("name");
  }
  [[nodiscard]] static const std::string& child(const xml_element& joint) {
    return *joint.child("child")->attribute("link");
  }

  [[nodiscard]] std::string no_link(const std::string& link) const {
    return "no link \"" + link + "\": " + closest_names(link, names_.links);
  }

  void require_link(const urdf_context& context) const {
    if (const std::string& link = document_.attribute(context, "link"); !links_.contains(link)) {
      document_.fail(context, no_link(link));
    }
  }

  const std::string& add_name(const xml_element& element, elements& to) {
    const std::string& name = document_.attribute({element}, "name");
    if (const auto [first, is_new] = to.emplace(name, &element); !is_new) {
      document_.fail({element},
                     "it is repeated, first in line " + std::to_string(first->second->line));
    }
    return name;
  }

  void add_joint(const xml_element& element) {
    add_name(element, joints_);
    for (const char* key : {"parent", "child"}) {
      const xml_element* const part = element.child(key);
      if (part == nullptr) {
        document_.fail({element}, std::string("no element <") + key + ">");
      }
      (void)document_.attribute({*part, &element}, "link");
    }
    if (const auto [first, is_new] = joint_above_.emplace(child(element), &element); !is_new) {
      document_.fail({element}, "the link \"" + child(element) +
                                    "\" already has the parent joint \"" + name(*first->second) +
                                    "\" of line " + std::to_string(first->second->line));
    }
    elements_.push_back(&element);
    names_.joints.push_back({name(element), document_.attribute({element}, "type"),
                             *element.child("parent")->attribute("link"), child(element)});
  }

  [[nodiscard]] joint_kind kind(const xml_element& element) const {
    const std::string& type = document_.attribute({element}, "type");
    constexpr std::pair<std::string_view, joint_kind> kinds[] = {
        {"revolute", joint_kind::revolute},   {"continuous", joint_kind::continuous},
        {"prismatic", joint_kind::prismatic}, {"fixed", joint_kind::fixed},
        {"planar", joint_kind::planar},       {"floating", joint_kind::floating}};
    for (const auto& [word, meant] : kinds) {
      if (word == type) {
        return meant;
      }
    }
    document_.fail({element}, "unknown type \"" + type +
                                  "\" (expected revolute, continuous, prismatic, "
                                  "fixed, planar or floating)");
  }

  /// Limits of `<limit>`, narrowed by the soft limits of `<safety_controller>`.
  [[nodiscard]] joint_limits<double> limits(const xml_element& element, joint_kind kind) const {
    joint_limits<double> result;
    const bool is_bounded = kind != joint_kind::continuous;
    const xml_element* const limit = element.child("limit");
    if (limit == nullptr) {
      if (is_bounded) {
        document_.fail({element}, "no element <limit> (required for a " +
                                      *element.attribute("type") + " joint)");
      }
      return result;
    }
    const urdf_context context{*limit, &element};
    result.velocity = document_.limit(context, "velocity", result.velocity, 1);
    if (result.velocity < 0) {
      document_.fail_negative(context, "velocity");
    }
    if (!is_bounded) {
      return result;
    }
    result.lower = document_.limit(context, "lower", 0, -1); // 0 is the default of the format
    result.upper = document_.limit(context, "upper", 0, 1);
    if (result.lower > result.upper) {
      document_.fail(context,
                     "lower " + to_text(result.lower) + " is above upper " + to_text(result.upper));
    }
    if (const xml_element* soft = element.child("safety_controller")) {
      const urdf_context soft_context{*soft, &element};
      result.lower = std::max(result.lower,
                              document_.limit(soft_context, "soft_lower_limit", result.lower, -1));
      result.upper = std::min(result.upper,
                              document_.limit(soft_context, "soft_upper_limit", result.upper, 1));
      if (result.lower > result.upper) {
        document_.fail(soft_context,
                       "the soft limits contain no coordinate within those of <limit>");
      }
    }
    return result;
  }

  std::string path_;
  urdf_document document_;
  urdf_summary names_;
  std::vector<const xml_element*> elements_; ///< elements of the joints, as in `names_`
  elements links_, joints_;                  ///< elements by name
  elements joint_above_;                     ///< joint by the name of the link that it moves
};

} // namespace duet::detail
