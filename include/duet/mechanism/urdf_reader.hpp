// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file.hpp>
#include <duet/core/text/nearest_names.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/text_rows.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/mechanism/urdf_contents.hpp>
#include <duet/mechanism/xml_check.hpp>

#if !defined(__cpp_exceptions) || !defined(__cpp_rtti)
// After an #error compilers would go on, with Boost's errors.
#include "duet: read_urdf needs exceptions and RTTI, as Boost.PropertyTree does: compile without -fno-exceptions and -fno-rtti"
#endif
#include <boost/property_tree/xml_parser.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// The elements of a robot description in URDF, and what may be wrong with them.

namespace duet::detail {

/// Tells file and element of what is wrong.
/// \tparam Xml  boost::property_tree::ptree
template <class Xml>
class urdf_reader {
public:
  explicit urdf_reader(std::string path) : path_(std::move(path)) {
    Xml document;
    catching<boost::property_tree::xml_parser_error>(
        [&] {
          std::istringstream text(checked_text());
          boost::property_tree::read_xml(text, document);
        },
        [&](const auto& e) {
          fail(e.line() > 0 ? "line " + std::to_string(e.line()) : "", e.message());
        });
    const auto robot = document.get_child_optional("robot");
    if (!robot) {
      fail("", "no element <robot>");
    }
    for (const auto& [tag, element] : *robot) {
      if (tag == "link") {
        names_.links.push_back(attribute(element, "<link>", "name"));
        links_.insert(names_.links.back());
      } else if (tag == "joint") {
        add_joint(element);
      }
    }
  }

  [[nodiscard]] const urdf_names& names() const { return names_; }

  /// The joints from the link `base` to the link `tip`, in that order.
  [[nodiscard]] std::vector<const Xml*> path(const std::string& base, const std::string& tip) {
    require_link("", base);
    require_link("", tip);
    std::vector<const Xml*> result;
    std::set<std::string> seen{tip};
    for (std::string link = tip; link != base;) {
      const auto above = joint_above_.find(link);
      if (above == joint_above_.end()) {
        if (hangs_on(base, tip)) {
          fail("", "the tip \"" + tip + "\" is an ancestor of the base \"" + base +
                       "\": exchange them");
        }
        fail("", "the link \"" + tip + "\" does not hang on \"" + base + "\": above \"" + link +
                     "\" there is no joint");
      }
      result.push_back(&above->second);
      link = attribute(above->second.get_child("parent"), where(above->second), "link");
      require_link(where(above->second) + " <parent>", link);
      if (!seen.insert(link).second) {
        fail(where(above->second), "closes a cycle at the link \"" + link + "\"");
      }
    }
    std::reverse(result.begin(), result.end());
    return result;
  }

  [[nodiscard]] joint<double> read(const Xml& element) const {
    const std::string here = where(element);
    if (element.get_child_optional("mimic")) {
      fail(here + " <mimic>", "joints that follow others are not supported in a chain");
    }
    joint<double> result;
    const std::string type = attribute(element, here, "type");
    static const std::map<std::string, joint_kind> kinds{{"revolute", joint_kind::revolute},
                                                         {"continuous", joint_kind::continuous},
                                                         {"prismatic", joint_kind::prismatic},
                                                         {"fixed", joint_kind::fixed}};
    const auto kind = kinds.find(type);
    if (kind == kinds.end()) {
      fail(here, "type \"" + type + "\" is none of revolute, continuous, prismatic and fixed");
    }
    result.kind = kind->second;
    if (const auto origin = element.get_child_optional("origin")) {
      const auto rpy = numbers(*origin, here + " <origin>", "rpy", {0, 0, 0});
      result.origin = {turn_about(2, rpy[2]) * turn_about(1, rpy[1]) * turn_about(0, rpy[0]),
                       numbers(*origin, here + " <origin>", "xyz", {0, 0, 0})};
    }
    if (result.kind != joint_kind::fixed) {
      result.axis = {1, 0, 0}; // where nothing is said
      if (const auto axis = element.get_child_optional("axis")) {
        result.axis = numbers(*axis, here + " <axis>", "xyz", result.axis);
      }
      const double length = std::hypot(result.axis[0], result.axis[1], result.axis[2]);
      if (!is_nearly_one(length * length)) {
        fail(here + " <axis>", "length " + to_text(length) + ", not 1");
      }
      read_limits(element, here, result);
    }
    return result;
  }

  [[nodiscard]] static std::string name(const Xml& element) {
    return element.template get<std::string>("<xmlattr>.name", "");
  }
  [[nodiscard]] std::string child(const Xml& element) const {
    return attribute(element.get_child("child"), where(element), "link");
  }
  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    raise(file_error(path_, (where.empty() ? "" : where + ": ") + what));
  }

private:
  /// The file, if it may be given to the parser.
  [[nodiscard]] std::string checked_text() const {
    constexpr std::size_t most = std::size_t(1) << 24U;
    std::ifstream in;
    if (const std::string fault = open_input(path_, in); !fault.empty()) {
      fail("", fault);
    }
    std::string text;
    for (std::array<char, 4096> part{}; in.read(part.data(), part.size()), in.gcount() > 0;) {
      text.append(part.data(), std::size_t(in.gcount()));
      if (text.size() > most) {
        fail("", "has more than 16 MB");
      }
    }
    if (in.bad()) {
      fail("", "cannot be read");
    }
    if (const auto fault = xml_check(text).fault()) {
      fail("line " + std::to_string(fault->line), fault->reason);
    }
    return text;
  }

  [[nodiscard]] static std::string where(const Xml& joint) {
    return "<joint name=\"" + name(joint) + "\">";
  }

  void require_attribute(const Xml& element, const std::string& where,
                         const std::string& key) const {
    if (!element.get_child_optional("<xmlattr>." + key)) {
      fail(where, "no attribute \"" + key + "\"");
    }
  }
  [[nodiscard]] std::string attribute(const Xml& element, const std::string& where,
                                      const std::string& key) const {
    require_attribute(element, where, key);
    return element.template get<std::string>("<xmlattr>." + key);
  }

  [[nodiscard]] double number(const std::string& text, const std::string& where,
                              const std::string& key) const {
    const auto value = parse_number(text);
    if (!value || !(*value - *value == 0) || std::abs(*value) > 1e6) {
      fail(where, key + "=\"" + text + "\" is no number up to 1e6");
    }
    return *value;
  }

  /// The three numbers of an attribute.
  [[nodiscard]] std::array<double, 3> numbers(const Xml& element, const std::string& where,
                                              const std::string& key,
                                              const std::array<double, 3>& otherwise) const {
    const auto text = element.template get_optional<std::string>("<xmlattr>." + key);
    if (!text) {
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
      result[count++] = number(text->substr(first, end - first), where, key);
    }
    if (count != 3) {
      fail(where, key + "=\"" + *text + "\" is not three numbers");
    }
    return result;
  }

  void read_limits(const Xml& element, const std::string& here, joint<double>& result) const {
    const auto limit = element.get_child_optional("limit");
    const std::string place = here + " <limit>";
    const bool is_bounded = result.kind != joint_kind::continuous;
    if (!limit) {
      if (is_bounded) {
        fail(here, "no element <limit>, which a " + attribute(element, here, "type") +
                       " joint must have");
      }
      return;
    }
    const auto value = [&](const std::string& key, double otherwise) {
      const auto text = limit->template get_optional<std::string>("<xmlattr>." + key);
      return text ? number(*text, place, key) : otherwise;
    };
    if (is_bounded) {
      result.limits.lower = value("lower", 0); // as the format says
      result.limits.upper = value("upper", 0);
      if (result.limits.lower > result.limits.upper) {
        fail(place, "lower is above upper");
      }
    }
    result.limits.velocity = value("velocity", result.limits.velocity);
    if (result.limits.velocity < 0) {
      fail(place, "velocity is negative");
    }
  }

  /// Is there a way up from one link to another?
  [[nodiscard]] bool hangs_on(std::string link, const std::string& ancestor) const {
    for (std::size_t steps = 0; link != ancestor; ++steps) {
      const auto above = joint_above_.find(link);
      if (above == joint_above_.end() || steps == links_.size()) { // at the root, or in a cycle
        return false;
      }
      link = above->second.get("parent.<xmlattr>.link", "");
    }
    return true;
  }

  void require_link(const std::string& where, const std::string& link) const {
    if (!links_.contains(link)) {
      fail(where, "no link \"" + link + "\": " + nearest_names(link, names_.links));
    }
  }

  void add_joint(const Xml& element) {
    require_attribute(element, "<joint>", "name");
    for (const char* key : {"parent", "child"}) {
      if (!element.get_child_optional(key)) {
        fail(where(element), std::string("no element <") + key + ">");
      }
      require_attribute(element.get_child(key), where(element) + " <" + key + ">", "link");
    }
    names_.joints.push_back({name(element), element.template get<std::string>("<xmlattr>.type", ""),
                             element.template get<std::string>("parent.<xmlattr>.link"),
                             child(element)});
    if (!joint_above_.emplace(child(element), element).second) {
      fail(where(element), "the link \"" + child(element) + "\" has a joint above it already");
    }
  }

  std::string path_;
  urdf_names names_;
  std::set<std::string> links_;
  std::map<std::string, Xml> joint_above_; ///< by the link that it moves
};

} // namespace duet::detail
