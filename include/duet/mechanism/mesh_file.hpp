// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/bit_cast.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/text_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Surfaces out of files: STL and OBJ.

namespace duet {

/// A surface of triangles.
struct mesh_surface {
  /// Corners of the triangles, three of each.
  std::vector<std::array<double, 3>> corners = {};
};

namespace detail {

/// Reads one file, strictly.
class mesh_reader {
public:
  explicit mesh_reader(std::string path) : path_(std::move(path)), text_(content()) {}

  [[nodiscard]] mesh_surface read() {
    at_ = text_.starts_with("\xef\xbb\xbf") ? 3 : 0; // a byte order mark
    const std::size_t dot = std::min(path_.rfind('.'), path_.size());
    std::string kind = path_.substr(dot);
    std::transform(kind.begin(), kind.end(), kind.begin(),
                   [](char c) { return 'A' <= c && c <= 'Z' ? char(c + ('a' - 'A')) : c; });
    if (kind == ".stl") {
      if (is_binary_stl()) {
        read_binary_stl();
      } else {
        read_text_stl();
      }
    } else if (kind == ".obj") {
      read_obj();
    } else {
      fail("is neither .stl nor .obj");
    }
    if (surface_.corners.empty()) {
      fail("has no triangles");
    }
    return std::move(surface_);
  }

private:
  using point = std::array<double, 3>;
  static constexpr std::size_t most_bytes = std::size_t(1) << 28U;
  static constexpr std::size_t head = 84, bytes_of_triangle = 50;

  [[noreturn]] void fail(const std::string& what) const { raise(file_error(path_, what)); }
  [[noreturn]] void fail_here(const std::string& what) const {
    raise(file_error(path_, line_, what));
  }

  [[nodiscard]] std::string content() const {
    std::ifstream in;
    if (const std::string fault = open_input(path_, in); !fault.empty()) {
      fail(fault);
    }
    std::string text;
    for (std::array<char, 65536> part{}; in.read(part.data(), part.size()), in.gcount() > 0;) {
      text.append(part.data(), std::size_t(in.gcount()));
      if (text.size() > most_bytes) {
        fail("has more than 256 MB");
      }
    }
    if (in.bad()) {
      fail("cannot be read");
    }
    return text;
  }

  // STL: the length tells binary from text, which may both begin with "solid".

  [[nodiscard]] std::uint32_t word(std::size_t at) const { // least byte first
    std::uint32_t result = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      result |= std::uint32_t(static_cast<unsigned char>(text_[at + i])) << (8 * i);
    }
    return result;
  }
  [[nodiscard]] bool is_binary_stl() const {
    return text_.size() >= head && text_.size() - head == bytes_of_triangle * word(80);
  }
  void read_binary_stl() {
    for (std::size_t at = head; at < text_.size(); at += bytes_of_triangle) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        point x;
        for (std::size_t i = 0; i < 3; ++i) {
          x[i] = double(bit_cast<float>(word(at + 12 * (corner + 1) + 4 * i)));
          if (!std::isfinite(x[i])) {
            fail("triangle " + std::to_string((at - head) / bytes_of_triangle) +
                 " has a corner that is not finite");
          }
        }
        surface_.corners.push_back(x);
      }
    }
  }

  void read_text_stl() {
    if (!next_line() || words_[0] != "solid") {
      fail("is no STL: neither does it begin with \"solid\", nor has it the length of a binary "
           "file with as many triangles as it says");
    }
    const auto expect = [&](std::string_view first, std::size_t count, std::string_view form) {
      if (!next_line() || words_[0] != first || words_.size() != count) {
        fail_here("\"" + std::string(form) + "\" expected");
      }
    };
    for (bool is_open = true; next_line();) {
      if (words_[0] == (is_open ? "endsolid" : "solid")) {
        is_open = !is_open;
        continue;
      }
      if (!is_open || words_[0] != "facet" || words_.size() != 5) {
        fail_here(is_open ? "\"facet normal x y z\" or \"endsolid\" expected"
                          : "\"solid\" expected");
      }
      expect("outer", 2, "outer loop");
      for (int corner = 0; corner < 3; ++corner) {
        expect("vertex", 4, "vertex x y z");
        surface_.corners.push_back(point_of_line());
      }
      expect("endloop", 1, "endloop");
      expect("endfacet", 1, "endfacet");
    }
    if (words_of_last_ != "endsolid") {
      fail_here("the file ends before \"endsolid\"");
    }
  }

  // OBJ: of its statements, vertices and faces.

  void read_obj() {
    constexpr std::array<std::string_view, 12> skipped = {
        "vt", "vn", "vp", "l", "p", "g", "o", "s", "mtllib", "usemtl", "mg", "#"};
    std::vector<point> vertices;
    while (next_line()) {
      if (words_[0] == "v") {
        if (words_.size() != 4 && words_.size() != 5 && words_.size() != 7) { // weight, colour
          fail_here("\"v x y z\" expected");
        }
        vertices.push_back(point_of_line());
      } else if (words_[0] == "f") {
        if (words_.size() < 4) {
          fail_here("a face has three corners or more");
        }
        std::vector<point> face;
        for (std::size_t i = 1; i < words_.size(); ++i) {
          face.push_back(vertices[vertex_number(words_[i], vertices.size())]);
        }
        for (std::size_t i = 2; i < face.size(); ++i) {
          surface_.corners.insert(surface_.corners.end(), {face[0], face[i - 1], face[i]});
        }
      } else if (words_[0][0] != '#' &&
                 std::find(skipped.begin(), skipped.end(), words_[0]) == skipped.end()) {
        fail_here("unknown statement \"" + std::string(words_[0]) + "\"");
      }
    }
  }
  /// `7`, `7/1`, `7//3`, `7/1/3`, from 1 on; negative from the last one back.
  [[nodiscard]] std::size_t vertex_number(std::string_view text, std::size_t count) const {
    const auto value = parse_number(text.substr(0, text.find('/')));
    const double n = double(count), k = value ? *value : 0;
    if (!(k == std::floor(k) && k != 0 && -n <= k && k <= n)) {
      fail_here("\"" + std::string(text) + "\" is no corner of the " + std::to_string(count) +
                " vertices before");
    }
    return std::size_t(k > 0 ? k - 1 : n + k);
  }

  /// The words of the next line that has some.
  [[nodiscard]] bool next_line() {
    words_of_last_ = words_.empty() ? "" : std::string(words_[0]);
    for (words_.clear(); words_.empty() && at_ < text_.size(); ++line_) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      const std::string_view line = std::string_view(text_).substr(at_, end - at_);
      constexpr std::string_view blanks = " \t\r";
      for (std::size_t stop = 0, first;
           (first = line.find_first_not_of(blanks, stop)) != std::string_view::npos;) {
        stop = std::min(line.find_first_of(blanks, first), line.size());
        words_.push_back(line.substr(first, stop - first));
      }
      at_ = end + 1;
    }
    return !words_.empty();
  }
  /// The three numbers behind the first word.
  [[nodiscard]] point point_of_line() const {
    point result;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = parse_number(words_[i + 1]);
      if (!value || !std::isfinite(*value)) {
        fail_here("\"" + std::string(words_[i + 1]) + "\" is no number");
      }
      result[i] = *value;
    }
    return result;
  }

  std::string path_, text_;
  mesh_surface surface_;
  std::size_t at_ = 0, line_ = 0; ///< where the next line begins, the number of the last one
  std::vector<std::string_view> words_;
  std::string words_of_last_; ///< the first word of the line before
};

} // namespace detail

/// The surface in a file of triangles: STL, binary or text, or OBJ, whose faces may have more
/// corners; lengths as they stand there.
///
/// \throws file_error with the line, or the triangle, for what is not of these formats, numbers
/// that are not finite, more than 256 MB and no triangles at all
[[nodiscard]] inline mesh_surface read_mesh(const std::string& path) {
  return detail::mesh_reader(path).read();
}

} // namespace duet
