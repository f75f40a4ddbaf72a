// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "collada.hpp"

#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/text_rows.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

#include "xml.hpp"

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace duet::detail {
namespace {

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

/// Reads each element once, however many name it, so that time is in proportion to the document.
class collada_geometries {
public:
  using point = std::array<double, 3>;

  explicit collada_geometries(const collada_document& document) : document_(document) {}

  /// Corners of triangles, three of each.
  /// \throws file_error
  [[nodiscard]] const std::vector<point>& triangles(const xml_element& geometry) {
    const auto [place, is_new] = triangles_.try_emplace(&geometry);
    if (is_new) {
      for (const xml_element& each : document_.child(geometry, "mesh").children) {
        add_faces(place->second, each);
      }
    }
    return place->second;
  }

private:
  using index = std::uint64_t;

  /// Where positions stand among numbers.
  struct positions {
    const std::vector<double>* numbers = nullptr;
    std::array<index, 3> first = {}; ///< of x, y, z of the first one
    index stride = 1, count = 0;

    [[nodiscard]] point at(index i) const {
      const auto number = [&](index of_first) { return (*numbers)[of_first + i * stride]; };
      return {number(first[0]), number(first[1]), number(first[2])};
    }
  };

  [[nodiscard]] const std::vector<double>& numbers_of(const xml_element& array) {
    const auto [place, is_new] = numbers_.try_emplace(&array);
    if (is_new) {
      place->second = document_.numbers(array);
      const std::size_t size = place->second.size();
      if (document_.count(array, "count", size) != size) {
        document_.fail(array, "count=\"" + *array.attribute("count") + "\", but there are " +
                                  std::to_string(size) + " numbers");
      }
    }
    return place->second;
  }

  [[nodiscard]] positions positions_in(const xml_element& source) {
    const xml_element& accessor =
        document_.child(document_.child(source, "technique_common"), "accessor");
    const xml_element& array = document_.target(accessor, "source", "float_array");
    positions result{&numbers_of(array)};
    result.count = document_.count(accessor, "count");
    result.stride = document_.count(accessor, "stride", 1);
    const index offset = document_.count(accessor, "offset", 0);
    index parameters = 0;
    std::array<index, 3> place_of = {0, 0, 0}; // from 1 on
    for (const xml_element& each : accessor.children) {
      if (each.name == "param") {
        ++parameters;
        const std::string* const name = each.attribute("name");
        for (std::size_t i = 0; i < 3 && name != nullptr; ++i) {
          if (*name == std::string_view("XYZ").substr(i, 1)) {
            place_of[i] = parameters;
          }
        }
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (place_of[i] == 0) {
        document_.fail(accessor, std::string("no <param name=\"") + "XYZ"[i] + "\"> for positions");
      }
      result.first[i] = offset + place_of[i] - 1;
    }
    if (result.stride < parameters) {
      document_.fail(accessor, "stride=\"" + std::to_string(result.stride) + "\" for " +
                                   std::to_string(parameters) + " parameters");
    }
    const index last = *std::max_element(result.first.begin(), result.first.end());
    if (result.count > 0 && last + (result.count - 1) * result.stride >= result.numbers->size()) {
      document_.fail(accessor, std::to_string(result.count) + " positions reach beyond the " +
                                   std::to_string(result.numbers->size()) + " numbers of line " +
                                   std::to_string(array.line));
    }
    return result;
  }

  /// Of `<source>`, or of `<vertices>`, which names one.
  [[nodiscard]] const positions& positions_of(const xml_element& element) {
    const auto [place, is_new] = positions_.try_emplace(&element);
    if (is_new) {
      place->second =
          element.name == "source"
              ? positions_in(element)
              : positions_of(document_.target(input(element, "POSITION"), "source", "source"));
    }
    return place->second;
  }

  /// The one input of a kind.
  [[nodiscard]] const xml_element& input(const xml_element& in, std::string_view semantic) const {
    const xml_element* found = nullptr;
    for (const xml_element& each : in.children) {
      if (each.name == "input" && document_.attribute(each, "semantic") == semantic) {
        if (found != nullptr) {
          document_.fail(each, "semantic=\"" + std::string(semantic) +
                                   "\" is there twice, first in line " +
                                   std::to_string(found->line));
        }
        found = &each;
      }
    }
    if (found == nullptr) {
      document_.fail(in, "no <input semantic=\"" + std::string(semantic) + "\">");
    }
    return *found;
  }

  /// What names the corners of faces: of the numbers of a corner one is its position.
  struct corner_format {
    const positions* at = nullptr;
    index offset = 0, size = 1;
  };
  [[nodiscard]] corner_format format_of(const xml_element& faces) {
    const xml_element& vertex = input(faces, "VERTEX");
    corner_format result{&positions_of(document_.target(vertex, "source", "vertices")),
                         document_.count(vertex, "offset")};
    for (const xml_element& each : faces.children) {
      if (each.name == "input") {
        result.size = std::max(result.size, document_.count(each, "offset") + 1);
      }
    }
    return result;
  }

  [[nodiscard]] std::vector<point> corners(const corner_format& format,
                                           const xml_element& p) const {
    const std::vector<double> numbers = document_.numbers(p);
    if (numbers.size() % format.size != 0) {
      document_.fail(p, "has " + std::to_string(numbers.size()) +
                            " numbers, which are no corners of " + std::to_string(format.size));
    }
    std::vector<point> result;
    for (index i = format.offset; i < numbers.size(); i += format.size) {
      const double k = numbers[i];
      if (!(k >= 0 && k < double(format.at->count)) || k != double(index(k))) {
        document_.fail(p, "number " + std::to_string(i) + " names none of the " +
                              std::to_string(format.at->count) + " positions");
      }
      result.push_back(format.at->at(index(k)));
    }
    return result;
  }

  void add_faces(std::vector<point>& to, const xml_element& faces) {
    constexpr std::array<std::string_view, 5> skipped = {"source", "vertices", "lines",
                                                         "linestrips", "extra"};
    constexpr std::array<std::string_view, 5> known = {"triangles", "polylist", "polygons",
                                                       "trifans", "tristrips"};
    if (std::find(skipped.begin(), skipped.end(), faces.name) != skipped.end()) {
      return;
    }
    if (std::find(known.begin(), known.end(), faces.name) == known.end()) {
      document_.fail(faces, "is not known in <mesh>");
    }
    for (const xml_element& each : faces.children) {
      if (each.name == "ph") {
        document_.fail(each, "polygons with holes are not supported");
      }
    }
    const index count = faces.child("p") == nullptr ? 0 : add_lists(to, faces);
    if (document_.count(faces, "count", count) != count) {
      document_.fail(faces, "count=\"" + *faces.attribute("count") + "\", but there are " +
                                std::to_string(count));
    }
  }

  /// \return the number that `count` stands for: of triangles, of polygons, of fans or strips
  [[nodiscard]] index add_lists(std::vector<point>& to, const xml_element& faces) {
    const corner_format format = format_of(faces);
    if (faces.name == "triangles") {
      return add_triangles(to, faces, corners(format, document_.child(faces, "p")));
    }
    if (faces.name == "polylist") {
      return add_polygons(to, faces, corners(format, document_.child(faces, "p")));
    }
    index count = 0;
    for (const xml_element& each : faces.children) {
      if (each.name == "p") {
        ++count;
        const std::vector<point> c = corners(format, each);
        if (c.size() < 3) {
          document_.fail(each, "a face has " + std::to_string(c.size()) + " corners");
        }
        if (faces.name == "tristrips") {
          add_strip(to, c);
        } else {
          add_fan(to, c, 0, c.size());
        }
      }
    }
    return count;
  }

  static void add_fan(std::vector<point>& to, const std::vector<point>& c, std::size_t first,
                      std::size_t count) {
    for (std::size_t i = first + 2; i < first + count; ++i) {
      to.insert(to.end(), {c[first], c[i - 1], c[i]});
    }
  }
  /// Every other triangle of a strip is turned round.
  static void add_strip(std::vector<point>& to, const std::vector<point>& c) {
    for (std::size_t i = 2; i < c.size(); ++i) {
      const bool is_turned = i % 2 != 0;
      to.insert(to.end(), {c[i - 2], c[is_turned ? i : i - 1], c[is_turned ? i - 1 : i]});
    }
  }
  [[nodiscard]] index add_triangles(std::vector<point>& to, const xml_element& faces,
                                    const std::vector<point>& c) const {
    if (c.size() % 3 != 0) {
      document_.fail(faces, "has " + std::to_string(c.size()) + " corners, no multiple of 3");
    }
    to.insert(to.end(), c.begin(), c.end());
    return c.size() / 3;
  }
  [[nodiscard]] index add_polygons(std::vector<point>& to, const xml_element& faces,
                                   const std::vector<point>& c) const {
    const xml_element& sizes = document_.child(faces, "vcount");
    index count = 0, at = 0;
    for (const double size : document_.numbers(sizes)) {
      if (!(size >= 3 && size <= double(c.size() - at)) || size != double(index(size))) {
        document_.fail(sizes, "face " + std::to_string(count) + " has " + to_text(size) +
                                  " corners, and " + std::to_string(c.size() - at) + " are left");
      }
      ++count;
      add_fan(to, c, at, index(size));
      at += index(size);
    }
    if (at != c.size()) {
      document_.fail(sizes, "the faces have " + std::to_string(at) + " corners, but there are " +
                                std::to_string(c.size()));
    }
    return count;
  }

  const collada_document& document_;
  std::map<const xml_element*, std::vector<double>> numbers_;  ///< of `<float_array>`
  std::map<const xml_element*, positions> positions_;          ///< of `<source>`, `<vertices>`
  std::map<const xml_element*, std::vector<point>> triangles_; ///< of `<geometry>`
};

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

} // namespace

DUET_ABI_BEGIN

std::vector<std::array<double, 3>> read_collada(const std::string& path,
                                                std::size_t max_megabytes) {
  const collada_document document(path, read_xml(path, max_megabytes, xml_text::kept));
  return collada_scene(document).triangles();
}

DUET_ABI_END
} // namespace duet::detail
