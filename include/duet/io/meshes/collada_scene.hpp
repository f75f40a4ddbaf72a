// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/number_text.hpp>
#include <duet/io/meshes/collada_document.hpp>
#include <duet/io/meshes/collada_geometry.hpp>
#include <duet/io/xml_element.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// The scene of a document of COLLADA: geometries where nodes place them.

namespace duet::detail {

class collada_scene {
  using point = collada_geometries::point;
  using points = std::vector<point>;

public:
  explicit collada_scene(const collada_document& document)
      : document_(document), geometries_(document) {}

  /// Corners of triangles, three of each: all that is shown, in metres.
  /// \throws file_error
  [[nodiscard]] points triangles() {
    const Eigen::Matrix4d metres =
        Eigen::Vector4d(metres_of_unit(), metres_of_unit(), metres_of_unit(), 1).asDiagonal();
    const xml_element& instance =
        document_.child(document_.child(document_.root(), "scene"), "instance_visual_scene");
    const xml_element& scene = document_.target(instance, "url", "visual_scene");
    points result;
    for (const xml_element& each : scene.children) {
      if (each.name == "node") {
        add_node(result, each, metres, 1);
      }
    }
    return result;
  }

private:
  static constexpr std::size_t most_depth = 100, most_triangles = 5'000'000;

  [[nodiscard]] double metres_of_unit() const {
    const xml_element* const asset = document_.root().child("asset");
    if (asset == nullptr) {
      return 1;
    }
    if (const xml_element* const up = asset->child("up_axis")) { // changes nothing
      const std::string_view axis = trimmed(up->text);
      if (axis != "X_UP" && axis != "Y_UP" && axis != "Z_UP") {
        document_.fail(*up, "\"" + std::string(axis) + "\" is none of X_UP, Y_UP and Z_UP");
      }
    }
    const xml_element* const unit = asset->child("unit");
    const std::string* const text = unit == nullptr ? nullptr : unit->attribute("meter");
    if (text == nullptr) {
      return 1;
    }
    const auto metres = parse_number(*text);
    if (!metres || !(*metres > 0) || !std::isfinite(*metres)) {
      document_.fail(*unit, "meter=\"" + *text + "\" is no number above 0");
    }
    return *metres;
  }

  void add_node(points& to, const xml_element& node, const Eigen::Matrix4d& parent,
                std::size_t depth) {
    constexpr std::array<std::string_view, 4> skipped = {"asset", "instance_camera",
                                                         "instance_light", "extra"};
    if (depth > most_depth) {
      document_.fail(node, "nodes are nested more than 100 deep, or in a circle");
    }
    Eigen::Matrix4d place = parent; // transformations come before what they place
    for (const xml_element& each : node.children) {
      if (each.name == "node") {
        add_node(to, each, place, depth + 1);
      } else if (each.name == "instance_geometry") {
        add(to, geometries_.triangles(document_.target(each, "url", "geometry")), place, each);
      } else if (each.name == "instance_node") {
        add(to, surface_of(document_.target(each, "url", "node"), depth + 1), place, each);
      } else if (each.name == "instance_controller") {
        document_.fail(each, "skins and morphs are not supported");
      } else if (std::find(skipped.begin(), skipped.end(), each.name) == skipped.end()) {
        place *= transformation(each);
      }
    }
  }

  /// Of a node of which there are instances, made once, however many name it.
  [[nodiscard]] const points& surface_of(const xml_element& node, std::size_t depth) {
    if (const auto found = surfaces_.find(&node); found != surfaces_.end()) {
      return found->second;
    }
    points result;
    add_node(result, node, Eigen::Matrix4d::Identity(), depth);
    return surfaces_.emplace(&node, std::move(result)).first->second;
  }

  /// Mirrored triangles are turned round, so that what was outside still is.
  void add(points& to, const points& corners, const Eigen::Matrix4d& place,
           const xml_element& instance) {
    placed_ += corners.size() / 3;
    if (placed_ > most_triangles) {
      document_.fail(instance, "the scene has more than 5 million triangles");
    }
    const bool is_mirrored = place.topLeftCorner<3, 3>().determinant() < 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const point& x = corners[is_mirrored && i % 3 != 0 ? i + 3 - 2 * (i % 3) : i];
      const Eigen::Vector4d moved = place * Eigen::Vector4d(x[0], x[1], x[2], 1);
      if (!moved.allFinite()) {
        document_.fail(instance, "a corner is not finite where it is placed");
      }
      to.push_back({moved[0], moved[1], moved[2]});
    }
  }

  [[nodiscard]] Eigen::Matrix4d transformation(const xml_element& e) const {
    Eigen::Matrix4d result = Eigen::Matrix4d::Identity();
    if (e.name == "matrix") { // row by row
      result = Eigen::Map<const Eigen::Matrix4d>(document_.numbers(e, 16).data()).transpose();
      if (result.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
        document_.fail(e, "its last row is not 0 0 0 1");
      }
    } else if (e.name == "translate") {
      result.topRightCorner<3, 1>() = vector_of(document_.numbers(e, 3));
    } else if (e.name == "scale") {
      result.diagonal().head<3>() = vector_of(document_.numbers(e, 3));
    } else if (e.name == "rotate") { // an axis, and degrees
      const std::vector<double> x = document_.numbers(e, 4);
      const vector3<double> axis = vector_of(x);
      const double length = axis.stableNorm();
      if (length == 0 && x[3] != 0) {
        document_.fail(e, "turns about an axis of no length");
      }
      const double half = x[3] / 360 * std::numbers::pi;
      result.topLeftCorner<3, 3>() = rotation_matrix(
          exp(vector3<double>(length == 0 ? axis : vector3<double>(axis / length * half))));
    } else if (e.name == "lookat" || e.name == "skew") {
      document_.fail(e, "is not supported");
    } else {
      document_.fail(e, "is not known in <node>");
    }
    return result;
  }
  [[nodiscard]] static vector3<double> vector_of(const std::vector<double>& x) {
    return {x[0], x[1], x[2]};
  }

  const collada_document& document_;
  collada_geometries geometries_;
  std::map<const xml_element*, points> surfaces_;
  std::size_t placed_ = 0; ///< triangles
};

} // namespace duet::detail
