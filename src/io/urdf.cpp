// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/text/closest_names.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/io/urdf.hpp>
#include <duet/kinematics/collision_shape.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/robot_contents.hpp>
#include <duet/kinematics/robot_description.hpp>
#include <duet/kinematics/tree_chain.hpp>

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

// Origins and collision shapes.

/// The pose in `<origin>` of an element of a link or a joint.
[[nodiscard]] placement<double> read_origin(const urdf_document& document, const xml_element& in,
                                            const xml_element& owner) {
  const xml_element* const origin = in.child("origin");
  if (origin == nullptr) {
    return {};
  }
  const auto rpy = document.numbers({*origin, &owner}, "rpy", {0, 0, 0});
  return {rotation_about_axis(2, rpy[2]) * rotation_about_axis(1, rpy[1]) *
              rotation_about_axis(0, rpy[0]),
          document.numbers({*origin, &owner}, "xyz", {0, 0, 0})};
}

/// A size of a shape.
[[nodiscard]] double read_size(const urdf_document& document, const urdf_context& context,
                               std::string_view key) {
  const double result = document.number(context, key);
  if (result < 0) {
    document.fail_negative(context, key);
  }
  return result;
}

/// One collision shape, of a type known to URDF.
[[nodiscard]] collision_shape read_shape(const urdf_document& document,
                                         const xml_element& collision, const xml_element& link) {
  const xml_element* const geometry = collision.child("geometry");
  if (geometry == nullptr) {
    document.fail({collision, &link}, "no element <geometry>");
  }
  if (geometry->children.size() != 1) {
    document.fail({*geometry, &link},
                  "it has " + std::to_string(geometry->children.size()) + " shapes (expected 1)");
  }
  collision_shape result{read_origin(document, collision, link), {}, collision.line};
  const xml_element& shape = geometry->children.front();
  const urdf_context context{shape, &link};
  const auto size = [&](std::string_view key) { return read_size(document, context, key); };
  if (shape.name == "box") {
    (void)document.attribute(context, "size");
    if (document.numbers(context, "scale", {1, 1, 1}) != std::array<double, 3>{1, 1, 1}) {
      document.fail(context, "scale is valid for meshes only");
    }
    const collision_box box{document.numbers(context, "size", {})};
    if (box.size[0] < 0 || box.size[1] < 0 || box.size[2] < 0) {
      document.fail_negative(context, "size");
    }
    result.geometry = box;
  } else if (shape.name == "cylinder") {
    result.geometry = collision_cylinder{size("radius"), size("length")};
  } else if (shape.name == "capsule") {
    result.geometry = collision_capsule{size("radius"), size("length")};
  } else if (shape.name == "sphere") {
    result.geometry = collision_sphere{size("radius")};
  } else if (shape.name == "mesh") {
    result.geometry = collision_mesh{document.attribute(context, "filename"),
                                     document.numbers(context, "scale", {1, 1, 1})};
  } else {
    document.fail(context,
                  "the shape is unknown (expected box, cylinder, capsule, sphere or mesh)");
  }
  return result;
}

/// All collision shapes of a link.
[[nodiscard]] std::vector<collision_shape> read_shapes(const urdf_document& document,
                                                       const xml_element& link) {
  std::vector<collision_shape> result;
  for (const xml_element& each : link.children) {
    if (each.name == "collision") {
      result.push_back(read_shape(document, each, link));
    }
  }
  return result;
}

// Links and joints: all, or those from one link to another.

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

} // namespace

DUET_ABI_BEGIN

urdf_contents read_urdf_contents(const std::string& path, const std::string& base,
                                 const std::string& tip, std::size_t max_joints) {
  return urdf_reader(path, read_xml(path)).chain(base, tip, max_joints);
}

DUET_ABI_END
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

kinematic_tree read_urdf_tree(const std::string& path) {
  return kinematic_tree(detail::urdf_reader(path, detail::read_xml(path)).description());
}

urdf_summary read_urdf_summary(const std::string& path) {
  return detail::urdf_reader(path, detail::read_xml(path)).names();
}

DUET_ABI_END
} // namespace duet
