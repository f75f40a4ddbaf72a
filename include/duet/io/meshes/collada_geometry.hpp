// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/number_text.hpp>
#include <duet/io/meshes/collada_document.hpp>
#include <duet/io/xml_element.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// The triangles of `<geometry>` in COLLADA.

namespace duet::detail {

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

} // namespace duet::detail
