// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/text/csv.hpp>
#include <duet/core/text/file_error.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/io/urdf.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/robot_description.hpp>
#include <duet/kinematics/urdf_chain.hpp>

#include "xml.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace duet::detail {
namespace {

// Elements and attributes, and their validation.

/// A known element: its attributes, others being errors, and the elements that it may contain.
struct urdf_element_kind {
  std::string_view name;
  std::array<std::string_view, 7> attributes;
  std::array<std::string_view, 9> children = {};
  /// Attributes that files of known robots have for other programs; they are ignored.
  std::array<std::string_view, 3> foreign = {};
};
constexpr std::array<urdf_element_kind, 20> urdf_element_kinds{
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

/// Links and joints of a description, whose elements and attributes have been checked against the
/// format: all, or those from one link to another. Elements are named in messages with the joint or
/// link that contains them, their `owner`.
class urdf_reader {
public:
  /// \throws file_error for another root than `<robot>`, and for errors anywhere in the
  /// description, except for numbers
  explicit urdf_reader(const std::string& path) : path_(path), robot_(read_xml(path)) {
    if (robot_.name != "robot") {
      raise(file_error(path_, robot_.line, "the root is <" + robot_.name + "> (expected <robot>)"));
    }
    check(robot_);
    for (const xml_element& each : robot_.children) {
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
        fail(no_link(link));
      }
    }
    const auto pass = [&](std::size_t i) {
      const xml_element& parent = child(*elements_[i], "parent");
      if (const std::string& link = attribute(parent, "link"); !links_.contains(link)) {
        fail(parent, no_link(link));
      }
    };
    const auto fail_on_path = [&](const auto&... what) { fail(what...); };
    const link_path path = find_link_path(names_.joints, base, tip, pass, fail_on_path);
    urdf_contents result = link_path_contents(path, base, [&](std::size_t i) {
      const tree_joint joint = read_joint(*elements_[i]);
      if (const std::string reason = not_in_a_chain(joint); !reason.empty()) {
        fail(i, reason);
      }
      return joint;
    });
    if (const std::size_t count = result.joint_names.size(); count > max_joints) {
      fail(std::to_string(count) + " moving joints from \"" + base + "\" to \"" + tip +
           "\": use read_urdf<" + std::to_string(count) + ">");
    }
    for (urdf_link& each : result.links) {
      each.collision = read_shapes(*links_.at(each.name));
    }
    result.unknown = names_.unknown;
    return result;
  }

  /// All links and joints.
  [[nodiscard]] robot_description description() const {
    robot_description result;
    result.file = path_;
    result.unknown = names_.unknown;
    for (const xml_element& each : robot_.children) {
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

  [[noreturn]] void fail(const std::string& what) const { raise(file_error(path_, what)); }
  [[noreturn]] void fail(const xml_element& in, const std::string& what) const {
    raise(file_error(path_, in.line, name_of(in) + ": " + what));
  }
  [[noreturn]] void fail(std::size_t joint, const std::string& what) const {
    fail(*elements_[joint], what);
  }
  [[noreturn]] void fail_negative(const xml_element& in, std::string_view key) const {
    fail(in, quoted(in, key) + " is negative");
  }

  [[nodiscard]] const std::string& attribute(const xml_element& in, std::string_view key) const {
    const std::string* const value = in.attribute(key);
    if (value == nullptr) {
      fail(in, "no attribute \"" + std::string(key) + "\"");
    }
    return *value;
  }
  /// `key="value"`
  [[nodiscard]] std::string quoted(const xml_element& in, std::string_view key) const {
    return std::string(key) + "=\"" + attribute(in, key) + "\"";
  }
  [[nodiscard]] const xml_element& child(const xml_element& in, const std::string& tag) const {
    const xml_element* const result = in.child(tag);
    if (result == nullptr) {
      fail(in, "no element <" + tag + ">");
    }
    return *result;
  }

  /// A limit, infinite if it exceeds 1e6 in the direction of `sign`: such a number means unlimited.
  [[nodiscard]] double limit(const xml_element& in, std::string_view key, double otherwise,
                             int sign) const {
    const std::string* const text = in.attribute(key);
    return text != nullptr && sign * parse_number(*text).value_or(0) > max_number
               ? sign * std::numeric_limits<double>::infinity()
               : number(in, key, otherwise);
  }
  /// A required number.
  [[nodiscard]] double number(const xml_element& in, std::string_view key) const {
    return number_of(attribute(in, key), in, key, max_number);
  }
  [[nodiscard]] double number(const xml_element& in, std::string_view key, double otherwise) const {
    return in.attribute(key) == nullptr ? otherwise : number(in, key);
  }
  /// A required mass or moment of inertia, of any size.
  [[nodiscard]] double measure(const xml_element& in, std::string_view key) const {
    return number_of(attribute(in, key), in, key, std::numeric_limits<double>::max());
  }
  /// A required number that is not negative.
  [[nodiscard]] double size(const xml_element& in, std::string_view key) const {
    const double result = number(in, key);
    if (result < 0) {
      fail_negative(in, key);
    }
    return result;
  }
  /// The three numbers of an attribute.
  [[nodiscard]] std::array<double, 3> numbers(const xml_element& in, std::string_view key,
                                              const std::array<double, 3>& otherwise) const {
    if (in.attribute(key) == nullptr) {
      return otherwise;
    }
    std::array<double, 3> result{};
    std::size_t count = 0;
    for_each_word(*in.attribute(key), [&](std::string_view word) {
      if (count < 3) {
        result[count] = number_of(std::string(word), in, key, max_number);
      }
      ++count;
    });
    if (count != 3) {
      fail(in, quoted(in, key) + " is not three numbers");
    }
    return result;
  }

  /// Maximum length (m) and angle (rad): larger ones lose digits.
  static constexpr double max_number = 1e6;

  [[nodiscard]] static std::string name_of(const xml_element& element) {
    const std::string* const name = element.attribute("name");
    return (element.owner != nullptr ? name_of(*element.owner) + " " : "") + "<" + element.name +
           (name != nullptr ? " name=\"" + *name + "\"" : "") + ">";
  }

  [[nodiscard]] double number_of(const std::string& text, const xml_element& in,
                                 std::string_view key, double limit) const {
    const auto value = parse_number(text);
    if (!value || !(std::abs(*value) <= limit)) {
      fail(in,
           std::string(key) + "=\"" + text +
               (limit > max_number ? "\" is not a finite number" : "\" is not a number up to 1e6"));
    }
    return *value;
  }

  /// Checks an element and those in it that are read. Elements with a prefix, and attributes that
  /// declare one, belong to other programs.
  void check(xml_element& element) {
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
        fail(element, "unknown attribute \"" + key + "\": " + closest_names(key, known));
      }
    }
    const bool is_part = element.name == "link" || element.name == "joint";
    for (xml_element& each : element.children) {
      each.owner = is_part ? &element : element.owner;
      if (!has(kind->children, each.name)) {
        names_.unknown.push_back({each.name, name_of(element), each.line});
        continue;
      }
      const bool is_one_of_many =
          element.name == "robot" || each.name == "visual" || each.name == "collision";
      if (const xml_element* first = element.child(each.name); !is_one_of_many && first != &each) {
        fail(each, "it is repeated, first in line " + std::to_string(first->line));
      }
      check(each);
    }
  }
  [[nodiscard]] static bool has(const auto& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  }

  [[nodiscard]] std::string no_link(const std::string& link) const {
    return "no link \"" + link + "\": " + closest_names(link, names_.links);
  }

  const std::string& add_name(const xml_element& element, elements& to) {
    const std::string& name = attribute(element, "name");
    if (const auto [first, is_new] = to.emplace(name, &element); !is_new) {
      fail(element, "it is repeated, first in line " + std::to_string(first->second->line));
    }
    return name;
  }

  void add_joint(const xml_element& element) {
    const std::string& name = add_name(element, joints_);
    const std::string& parent_link = attribute(child(element, "parent"), "link");
    const std::string& child_link = attribute(child(element, "child"), "link");
    if (const auto [above, is_new] = joint_above_.emplace(child_link, &element); !is_new) {
      fail(element, "the link \"" + child_link + "\" already has the parent joint \"" +
                        *above->second->attribute("name") + "\" of line " +
                        std::to_string(above->second->line));
    }
    elements_.push_back(&element);
    names_.joints.push_back({name, attribute(element, "type"), parent_link, child_link});
  }

  /// The pose in `<origin>` of an element.
  [[nodiscard]] placement<double> read_origin(const xml_element& in) const {
    const xml_element* const origin = in.child("origin");
    if (origin == nullptr) {
      return {};
    }
    const auto rpy = numbers(*origin, "rpy", {0, 0, 0});
    return {rotation_about_axis(2, rpy[2]) * rotation_about_axis(1, rpy[1]) *
                rotation_about_axis(0, rpy[0]),
            numbers(*origin, "xyz", {0, 0, 0})};
  }

  /// All collision shapes of a link.
  [[nodiscard]] std::vector<collision_shape> read_shapes(const xml_element& link) const {
    std::vector<collision_shape> result;
    for (const xml_element& each : link.children) {
      if (each.name == "collision") {
        const xml_element& geometry = child(each, "geometry");
        if (geometry.children.size() != 1) {
          fail(geometry,
               "it has " + std::to_string(geometry.children.size()) + " shapes (expected 1)");
        }
        result.push_back({read_origin(each), {}, each.line});
        result.back().geometry = read_geometry(geometry.children.front());
      }
    }
    return result;
  }

  [[nodiscard]] auto read_geometry(const xml_element& shape) const
      -> decltype(collision_shape::geometry) {
    if (shape.name == "box") {
      (void)attribute(shape, "size");
      if (numbers(shape, "scale", {1, 1, 1}) != std::array<double, 3>{1, 1, 1}) {
        fail(shape, "scale is valid for meshes only");
      }
      const collision_box box{numbers(shape, "size", {})};
      if (*std::min_element(box.size.begin(), box.size.end()) < 0) {
        fail_negative(shape, "size");
      }
      return box;
    }
    if (shape.name == "cylinder") {
      return collision_cylinder{size(shape, "radius"), size(shape, "length")};
    }
    if (shape.name == "capsule") {
      return collision_capsule{size(shape, "radius"), size(shape, "length")};
    }
    if (shape.name == "sphere") {
      return collision_sphere{size(shape, "radius")};
    }
    if (shape.name == "mesh") {
      return collision_mesh{attribute(shape, "filename"), numbers(shape, "scale", {1, 1, 1})};
    }
    fail(shape, "the shape is unknown (expected box, cylinder, capsule, sphere or mesh)");
  }

  [[nodiscard]] tree_link read_link(const xml_element& element) const {
    tree_link result{*element.attribute("name"), {}, element.line, read_shapes(element)};
    const xml_element* const inertial = element.child("inertial");
    if (inertial == nullptr) {
      return result;
    }
    link_inertia& inertia = result.inertia.emplace();
    inertia.frame = read_origin(*inertial);
    const xml_element& mass = child(*inertial, "mass");
    inertia.mass = measure(mass, "value");
    if (inertia.mass < 0) {
      fail_negative(mass, "value");
    }
    if (const xml_element* const moments = inertial->child("inertia")) {
      inertia.moments = read_moments(*moments);
    }
    return result;
  }

  /// Upper half of a symmetric matrix, whose lower half may also be given.
  [[nodiscard]] std::array<double, 6> read_moments(const xml_element& in) const {
    constexpr std::array<const char*, 6> keys = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
    constexpr std::array<const char*, 6> below = {"", "iyx", "izx", "", "izy", ""};
    std::array<double, 6> result{};
    for (std::size_t i = 0; i < keys.size(); ++i) {
      result[i] = measure(in, keys[i]);
      if (in.attribute(below[i]) == nullptr) {
        continue;
      }
      const double other = measure(in, below[i]);
      const double magnitude = std::max(std::abs(result[i]), std::abs(other));
      if (!(std::abs(result[i] / 2 - other / 2) <= 1e-6 * (magnitude / 2))) { // few digits, maybe
        fail(in, quoted(in, below[i]) + " differs from " + quoted(in, keys[i]) +
                     " (expected a symmetric matrix)");
      }
    }
    return result;
  }

  [[nodiscard]] tree_joint read_joint(const xml_element& element) const {
    tree_joint result{attribute(element, "name"),
                      attribute(child(element, "parent"), "link"),
                      attribute(child(element, "child"), "link"),
                      read_motion(element),
                      {},
                      element.line};
    if (const xml_element* const mimic = element.child("mimic")) {
      result.mimic = {attribute(*mimic, "joint"), number(*mimic, "multiplier", 1),
                      number(*mimic, "offset", 0)};
    }
    return result;
  }

  [[nodiscard]] joint<double> read_motion(const xml_element& element) const {
    joint<double> result;
    result.kind = kind(element);
    result.origin = read_origin(element);
    if (result.kind == joint_kind::fixed) {
      return result;
    }
    result.axis = {1, 0, 0}; // default
    if (const xml_element* axis = element.child("axis")) {
      result.axis = numbers(*axis, "xyz", result.axis);
      const double length = std::hypot(result.axis[0], result.axis[1], result.axis[2]);
      if (!is_nearly_one(length * length)) {
        fail(*axis, "the axis has length " + to_text(length) + " (expected 1)");
      }
    }
    if (result.coordinates() == 1) { // the format defines no limits for several coordinates
      result.limits = limits(element, result.kind);
    }
    return result;
  }

  [[nodiscard]] joint_kind kind(const xml_element& element) const {
    const std::string& type = attribute(element, "type");
    constexpr std::pair<std::string_view, joint_kind> kinds[] = {
        {"revolute", joint_kind::revolute},   {"continuous", joint_kind::continuous},
        {"prismatic", joint_kind::prismatic}, {"fixed", joint_kind::fixed},
        {"planar", joint_kind::planar},       {"floating", joint_kind::floating}};
    for (const auto& [word, meant] : kinds) {
      if (word == type) {
        return meant;
      }
    }
    fail(element, "unknown type \"" + type +
                      "\" (expected revolute, continuous, prismatic, fixed, planar or floating)");
  }

  /// Limits of `<limit>`, narrowed by the soft limits of `<safety_controller>`.
  [[nodiscard]] joint_limits<double> limits(const xml_element& element, joint_kind kind) const {
    joint_limits<double> result;
    const bool is_bounded = kind != joint_kind::continuous;
    const xml_element* const in = element.child("limit");
    if (in == nullptr) {
      if (is_bounded) {
        fail(element,
             "no element <limit> (required for a " + *element.attribute("type") + " joint)");
      }
      return result;
    }
    result.velocity = limit(*in, "velocity", result.velocity, 1);
    if (result.velocity < 0) {
      fail_negative(*in, "velocity");
    }
    if (!is_bounded) {
      return result;
    }
    result.lower = limit(*in, "lower", 0, -1); // 0 is the default of the format
    result.upper = limit(*in, "upper", 0, 1);
    if (result.lower > result.upper) {
      fail(*in, "lower " + to_text(result.lower) + " is above upper " + to_text(result.upper));
    }
    if (const xml_element* soft = element.child("safety_controller")) {
      result.lower = std::max(result.lower, limit(*soft, "soft_lower_limit", result.lower, -1));
      result.upper = std::min(result.upper, limit(*soft, "soft_upper_limit", result.upper, 1));
      if (result.lower > result.upper) {
        fail(*soft, "the soft limits contain no coordinate within those of <limit>");
      }
    }
    return result;
  }

  std::string path_;
  xml_element robot_;
  urdf_summary names_;
  std::vector<const xml_element*> elements_; ///< elements of the joints, as in `names_`
  elements links_, joints_;                  ///< elements by name
  elements joint_above_;                     ///< joint by the name of the link that it moves
};

} // namespace

DUET_ABI_BEGIN

urdf_contents read_urdf_contents(const std::string& path, const std::string& base,
                                 const std::string& tip, std::size_t max_joints) {
  return urdf_reader(path).chain(base, tip, max_joints);
}

DUET_ABI_END
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

kinematic_tree read_urdf_tree(const std::string& path) {
  return kinematic_tree(detail::urdf_reader(path).description());
}

urdf_summary read_urdf_summary(const std::string& path) {
  return detail::urdf_reader(path).names();
}

DUET_ABI_END
} // namespace duet
