// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/nearest_names.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/mechanism/urdf_contents.hpp>
#include <duet/mechanism/urdf_document.hpp>
#include <duet/mechanism/xml_element.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

/// \file
/// Links and joints of a robot description, and the way from one link to another.

namespace duet::detail {

class urdf_reader {
public:
  /// \throws file_error for what is wrong anywhere in the description, numbers aside
  urdf_reader(const std::string& path, xml_element robot) : document_(path, std::move(robot)) {
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

  [[nodiscard]] const urdf_names& names() const { return names_; }

  /// The joints from the link `base` to the link `tip`, in that order.
  [[nodiscard]] std::vector<const xml_element*> path(const std::string& base,
                                                     const std::string& tip) const {
    for (const std::string& link : {base, tip}) {
      if (!links_.contains(link)) {
        document_.fail(no_link(link));
      }
    }
    std::vector<const xml_element*> result;
    std::unordered_set<std::string_view> seen{tip};
    for (std::string_view link = tip; link != base;) {
      const auto above = joint_above_.find(link);
      if (above == joint_above_.end()) {
        if (hangs_on(base, tip)) {
          document_.fail("the tip \"" + tip + "\" is an ancestor of the base \"" + base +
                         "\": exchange them");
        }
        document_.fail("the link \"" + tip + "\" does not hang on \"" + base + "\": above \"" +
                       std::string(link) + "\" there is no joint");
      }
      const xml_element& joint = *above->second;
      result.push_back(&joint);
      require_link({*joint.child("parent"), &joint});
      link = *joint.child("parent")->attribute("link");
      if (!seen.insert(link).second) {
        document_.fail({joint}, "closes a cycle at the link \"" + std::string(link) + "\"");
      }
    }
    std::reverse(result.begin(), result.end());
    return result;
  }

  [[nodiscard]] joint<double> read(const xml_element& element) const {
    if (const xml_element* mimic = element.child("mimic")) {
      document_.fail({*mimic, &element}, "joints that follow others are not supported in a chain");
    }
    joint<double> result;
    result.kind = kind(element);
    if (const xml_element* origin = element.child("origin")) {
      const auto rpy = document_.numbers({*origin, &element}, "rpy", {0, 0, 0});
      result.origin = {turn_about(2, rpy[2]) * turn_about(1, rpy[1]) * turn_about(0, rpy[0]),
                       document_.numbers({*origin, &element}, "xyz", {0, 0, 0})};
    }
    if (result.kind != joint_kind::fixed) {
      result.axis = {1, 0, 0}; // where nothing is said
      if (const xml_element* axis = element.child("axis")) {
        result.axis = document_.numbers({*axis, &element}, "xyz", result.axis);
        const double length = std::hypot(result.axis[0], result.axis[1], result.axis[2]);
        if (!is_nearly_one(length * length)) {
          document_.fail({*axis, &element}, "length " + to_text(length) + ", not 1");
        }
      }
      result.limits = limits(element, result.kind);
    }
    return result;
  }

  [[nodiscard]] static const std::string& name(const xml_element& joint) {
    return *joint.attribute("name");
  }
  [[nodiscard]] static const std::string& child(const xml_element& joint) {
    return *joint.child("child")->attribute("link");
  }
  [[noreturn]] void fail(const std::string& what) const { document_.fail(what); }

private:
  using elements = std::unordered_map<std::string_view, const xml_element*>;

  [[nodiscard]] std::string no_link(const std::string& link) const {
    return "no link \"" + link + "\": " + nearest_names(link, names_.links);
  }

  void require_link(const urdf_place& place) const {
    if (const std::string& link = document_.attribute(place, "link"); !links_.contains(link)) {
      document_.fail(place, no_link(link));
    }
  }

  const std::string& add_name(const xml_element& element, elements& to) {
    const std::string& name = document_.attribute({element}, "name");
    if (const auto [first, is_new] = to.emplace(name, &element); !is_new) {
      document_.fail({element},
                     "is there twice, first in line " + std::to_string(first->second->line));
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
                                    "\" has a joint above it already, \"" + name(*first->second) +
                                    "\" of line " + std::to_string(first->second->line));
    }
    names_.joints.push_back({name(element), document_.attribute({element}, "type"),
                             *element.child("parent")->attribute("link"), child(element)});
  }

  [[nodiscard]] joint_kind kind(const xml_element& element) const {
    const std::string& type = document_.attribute({element}, "type");
    constexpr std::pair<std::string_view, joint_kind> kinds[] = {
        {"revolute", joint_kind::revolute},
        {"continuous", joint_kind::continuous},
        {"prismatic", joint_kind::prismatic},
        {"fixed", joint_kind::fixed}};
    for (const auto& [word, meant] : kinds) {
      if (word == type) {
        return meant;
      }
    }
    document_.fail({element},
                   "type \"" + type + "\" is none of revolute, continuous, prismatic and fixed");
  }

  /// Those of `<limit>`, narrowed by the soft ones of `<safety_controller>`.
  [[nodiscard]] joint_limits<double> limits(const xml_element& element, joint_kind kind) const {
    joint_limits<double> result;
    const bool is_bounded = kind != joint_kind::continuous;
    const xml_element* const limit = element.child("limit");
    if (limit == nullptr) {
      if (is_bounded) {
        document_.fail({element}, "no element <limit>, which a " + *element.attribute("type") +
                                      " joint must have");
      }
      return result;
    }
    const urdf_place place{*limit, &element};
    result.velocity = document_.limit(place, "velocity", result.velocity, 1);
    if (result.velocity < 0) {
      document_.fail(place, "velocity is negative");
    }
    if (!is_bounded) {
      return result;
    }
    result.lower = document_.limit(place, "lower", 0, -1); // 0 as the format says
    result.upper = document_.limit(place, "upper", 0, 1);
    if (result.lower > result.upper) {
      document_.fail(place, "lower is above upper");
    }
    if (const xml_element* soft = element.child("safety_controller")) {
      const urdf_place there{*soft, &element};
      result.lower =
          std::max(result.lower, document_.limit(there, "soft_lower_limit", result.lower, -1));
      result.upper =
          std::min(result.upper, document_.limit(there, "soft_upper_limit", result.upper, 1));
      if (result.lower > result.upper) {
        document_.fail(there, "no motion is within its limits and those of <limit>");
      }
    }
    return result;
  }

  /// Is there a way up from one link to another?
  [[nodiscard]] bool hangs_on(std::string_view link, const std::string& ancestor) const {
    for (std::size_t steps = 0; link != ancestor; ++steps) {
      const auto above = joint_above_.find(link);
      if (above == joint_above_.end() || steps == links_.size()) { // at the root, or in a cycle
        return false;
      }
      link = *above->second->child("parent")->attribute("link");
    }
    return true;
  }

  urdf_document document_;
  urdf_names names_;
  elements links_, joints_; ///< by name
  elements joint_above_;    ///< by the link that it moves
};

} // namespace duet::detail
