// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/io/urdf_document.hpp>
#include <duet/io/xml_element.hpp>
#include <duet/kinematics/collision_shape.hpp>
#include <duet/kinematics/joint.hpp>

#include <array>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Origins and collision shapes of links in URDF.

namespace duet::detail {

/// The pose in `<origin>` of an element of a link or a joint.
[[nodiscard]] inline placement<double>
read_origin(const urdf_document& document, const xml_element& in, const xml_element& owner) {
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
[[nodiscard]] inline double read_size(const urdf_document& document, const urdf_context& context,
                                      std::string_view key) {
  const double result = document.number(context, key);
  if (result < 0) {
    document.fail_negative(context, key);
  }
  return result;
}

/// One collision shape, of a type known to URDF.
[[nodiscard]] inline collision_shape
read_shape(const urdf_document& document, const xml_element& collision, const xml_element& link) {
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
[[nodiscard]] inline std::vector<collision_shape> read_shapes(const urdf_document& document,
                                                              const xml_element& link) {
  std::vector<collision_shape> result;
  for (const xml_element& each : link.children) {
    if (each.name == "collision") {
      result.push_back(read_shape(document, each, link));
    }
  }
  return result;
}

} // namespace duet::detail
