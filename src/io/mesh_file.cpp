// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/compiler/types.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/core/text/file_error.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/io/mesh_file.hpp>

#include "xml.hpp"

#include <Eigen/Core>
#include <Eigen/LU>

#ifdef DUET_WITH_ASSIMP
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace duet::detail {
namespace {

/// Reads one file, strictly.
class triangle_file {
public:
  triangle_file(std::string path, std::size_t max_megabytes)
      : path_(std::move(path)), text_(whole_content(path_, max_megabytes)) {}

  /// Corners of triangles, three of each.
  /// \param ending  of the file's name, in small letters
  [[nodiscard]] std::vector<std::array<double, 3>> read(std::string_view ending) {
    at_ = text_.starts_with("\xef\xbb\xbf") ? 3 : 0; // a byte order mark
    if (ending == ".obj") {
      read_obj();
    } else if (is_binary_stl()) {
      read_binary_stl();
    } else {
      read_text_stl();
    }
    return std::move(triangles_);
  }

private:
  using point = std::array<double, 3>;
  static constexpr std::size_t head = 84, bytes_of_triangle = 50;

  [[noreturn]] void fail(const std::string& what) const { raise(file_error(path_, what)); }
  /// Throws the error of a word of the text, with its line.
  [[noreturn]] void fail_at(std::string_view location, const std::string& what) const {
    const auto before =
        std::string_view(text_).substr(0, std::size_t(location.data() - text_.data()));
    const auto lines = std::count(before.begin(), before.end(), '\n');
    raise(file_error(path_, std::size_t(lines) + 1, what));
  }
  [[noreturn]] void fail_of_line(const std::string& what) const {
    const std::string_view first = words_.front(), last = words_.back();
    const std::size_t size = std::size_t(last.data() - first.data()) + last.size();
    fail_at(first, what + ", not " + quoted({first.data(), size}));
  }
  [[noreturn]] void fail_at_end(std::string_view missing) const {
    const std::size_t last = text_.find_last_not_of(" \t\r\n");
    fail_at(std::string_view(text_).substr(last), "the file ends before " + quoted(missing));
  }
  [[nodiscard]] static std::string quoted(std::string_view text) {
    return "\"" + std::string(text) + "\"";
  }

  // STL: the length tells binary from text, which may both begin with "solid". The number of
  // triangles in a binary file is beyond its length if read from text.

  [[nodiscard]] std::uint32_t word(std::size_t at) const { // least byte first
    std::uint32_t result = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      result |= std::uint32_t(static_cast<unsigned char>(text_[at + i])) << (8 * i);
    }
    return result;
  }
  [[nodiscard]] bool is_binary_stl() const {
    if (text_.size() < head || (text_.size() - head) / bytes_of_triangle < word(80)) {
      return false;
    }
    // Padding may follow, and anything that is less than a triangle.
    const std::string_view rest = std::string_view(text_).substr(end_of_triangles());
    return rest.size() < bytes_of_triangle ||
           rest.find_first_not_of(std::string_view("\0 \t\r\n", 5)) == rest.npos;
  }
  [[nodiscard]] std::size_t end_of_triangles() const {
    return head + bytes_of_triangle * std::size_t(word(80));
  }
  void read_binary_stl() {
    for (std::size_t at = head; at < end_of_triangles(); at += bytes_of_triangle) {
      for (std::size_t vertex = 0; vertex < 3; ++vertex) {
        point x;
        for (std::size_t i = 0; i < 3; ++i) {
          x[i] = double(bit_cast<float>(word(at + 12 * (vertex + 1) + 4 * i)));
          if (!std::isfinite(x[i])) {
            fail("triangle " + std::to_string((at - head) / bytes_of_triangle) +
                 " has a vertex that is not finite");
          }
        }
        triangles_.push_back(x);
      }
    }
  }

  void read_text_stl() {
    if (!next_line() || words_[0] != "solid") {
      fail("the file is not STL: it neither begins with \"solid\" nor has the length of a binary "
           "file with its number of triangles");
    }
    bool is_open = true;
    while (next_line()) {
      if (words_[0] == (is_open ? "endsolid" : "solid")) {
        is_open = !is_open;
        continue;
      }
      require_line(is_open ? "facet normal x y z" : "solid");
      for (std::size_t i = 2; i < 5; ++i) { // of a triangle without area it may be nan
        static_cast<void>(number(words_[i]));
      }
      require_next("outer loop");
      for (int vertex = 0; vertex < 3; ++vertex) {
        require_next("vertex x y z");
        triangles_.push_back(point_of_line());
      }
      require_next("endloop");
      require_next("endfacet");
    }
    if (is_open) {
      fail_at_end("endsolid");
    }
  }
  /// True if the line has these words, except for those of one letter.
  void require_line(std::string_view form) const {
    std::size_t i = 0;
    bool is_so = true;
    for_each_word(form, [&](std::string_view word) {
      is_so = is_so && i < words_.size() && (word.size() == 1 || word == words_[i]);
      ++i;
    });
    if (!is_so || i != words_.size()) {
      fail_of_line(quoted(form) + " expected");
    }
  }
  void require_next(std::string_view form) {
    if (!next_line()) {
      fail_at_end(form);
    }
    require_line(form);
  }

  // OBJ: of its statements, vertices and faces.

  void read_obj() {
    constexpr std::array<std::string_view, 12> skipped = {
        "vt", "vn", "vp", "l", "p", "g", "o", "s", "mtllib", "usemtl", "mg", "#"};
    std::vector<point> vertices;
    while (next_statement()) {
      if (words_[0] == "v") {
        if (words_.size() != 4 && words_.size() != 5 && words_.size() != 7) { // weight, colour
          fail_of_line("\"v x y z\" expected");
        }
        vertices.push_back(point_of_line());
      } else if (words_[0] == "f") {
        if (words_.size() < 4) {
          fail_of_line("a face of three or more vertices expected");
        }
        std::vector<point> face;
        for (std::size_t i = 1; i < words_.size(); ++i) {
          face.push_back(vertices[vertex_number(words_[i], vertices.size())]);
        }
        for (std::size_t i = 2; i < face.size(); ++i) {
          triangles_.insert(triangles_.end(), {face[0], face[i - 1], face[i]});
        }
      } else if (words_[0][0] != '#' &&
                 std::find(skipped.begin(), skipped.end(), words_[0]) == skipped.end()) {
        fail_at(words_[0], "unknown statement " + quoted(words_[0]));
      }
    }
  }
  /// Zero-based vertex index of an element `v`, `v/vt`, `v//vn` or `v/vt/vn` of an OBJ face; v
  /// counts from 1, or, if negative, back from the last vertex.
  [[nodiscard]] std::size_t vertex_number(std::string_view text, std::size_t count) const {
    const auto integer = [](std::string_view part) { // 0 if it is not an integer
      const double k = parse_number(part).value_or(0);
      return std::isfinite(k) && k == std::floor(k) ? k : 0;
    };
    const std::size_t slash = std::min(text.find('/'), text.size());
    const double n = double(count), k = integer(text.substr(0, slash));
    if (!(k != 0 && -n <= k && k <= n)) {
      fail_at(text,
              quoted(text) + " is not one of the " + std::to_string(count) + " vertices before it");
    }
    int others = 0; // of the texture, of the normal
    for (std::size_t at = slash, end; at < text.size(); at = end) {
      end = std::min(text.find('/', at + 1), text.size());
      const std::string_view other = text.substr(at + 1, end - at - 1);
      if (++others > 2 || (!other.empty() && integer(other) == 0)) {
        fail_at(text, quoted(text) + " is not a vertex reference (expected k, k/t, k//n or k/t/n)");
      }
    }
    return std::size_t(k > 0 ? k - 1 : n + k);
  }

  /// The words of the next line that has some.
  [[nodiscard]] bool next_line() {
    for (words_.clear(); words_.empty() && at_ < text_.size();) {
      add_line();
    }
    return !words_.empty();
  }
  /// The words of a statement of OBJ: a backslash at its end joins a line with the next, but not a
  /// comment, which may end with the name of a folder.
  [[nodiscard]] bool next_statement() {
    words_.clear();
    for (bool goes_on = false; at_ < text_.size() && (goes_on || words_.empty());) {
      add_line();
      goes_on = !words_.empty() && words_[0][0] != '#' && words_.back().ends_with('\\');
      if (goes_on) {
        words_.back().remove_suffix(1);
        if (words_.back().empty()) {
          words_.pop_back();
        }
      }
    }
    return !words_.empty();
  }
  void add_line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    for_each_word(std::string_view(text_).substr(at_, end - at_),
                  [&](std::string_view word) { words_.push_back(word); });
    at_ = end + 1;
  }

  [[nodiscard]] double number(std::string_view text) const {
    const auto value = parse_number(text);
    if (!value) {
      fail_at(text, quoted(text) + " is not a number");
    }
    return *value;
  }
  /// The first three of the numbers behind the first word.
  [[nodiscard]] point point_of_line() const {
    point result;
    for (std::size_t i = 0; i + 1 < words_.size(); ++i) {
      const double value = number(words_[i + 1]);
      if (!std::isfinite(value)) {
        fail_at(words_[i + 1], quoted(words_[i + 1]) + " is not finite");
      }
      if (i < 3) {
        result[i] = value;
      }
    }
    return result;
  }

  std::string path_, text_;
  std::vector<point> triangles_; ///< of triangles, three of each
  std::size_t at_ = 0;           ///< where the next line begins
  std::vector<std::string_view> words_;
};

// Other formats.

#ifdef DUET_WITH_ASSIMP

/// Rejects transformations of COLLADA that Assimp 5 gets wrong: it does not normalise axes of
/// rotation, and `<skew>` may end the program.
void require_known_transformations(const std::string& path, const xml_element& in) {
  if (in.name == "skew") {
    raise(file_error(path, in.line, "<skew> is not supported"));
  }
  if (in.name == "rotate") {
    std::vector<double> x;
    for_each_word(in.text, [&](std::string_view word) {
      x.push_back(parse_number(word).value_or(std::nan("")));
    });
    const double length = x.size() == 4 ? std::hypot(x[0], x[1], x[2]) : std::nan("");
    if (!(std::abs(length - 1) <= 1e-4 || (x.size() == 4 && x[3] == 0))) {
      raise(file_error(path, in.line,
                       "<rotate> is not a unit vector and an angle: \"" +
                           std::string(trimmed(in.text)) + "\""));
    }
  }
  for (const xml_element& each : in.children) {
    require_known_transformations(path, each);
  }
}

/// Adds the triangles of a node and of those below it. Mirrored triangles are reversed, so that
/// their outside remains outside.
void add_triangles(const std::string& path, const aiScene& scene, const aiNode& node,
                   const Eigen::Matrix4d& parent, std::vector<std::array<double, 3>>& to) {
  using matrix = Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>;
  const Eigen::Matrix4d pose =
      parent * Eigen::Map<const matrix>(&node.mTransformation.a1).cast<double>();
  const bool is_mirrored = pose.topLeftCorner<3, 3>().determinant() < 0;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      for (unsigned k = 0; k < 3 && face.mNumIndices == 3; ++k) { // others are points and lines
        const aiVector3D& v = mesh.mVertices[face.mIndices[is_mirrored ? 2 - k : k]];
        const Eigen::Vector4d x = pose * Eigen::Vector4d(v.x, v.y, v.z, 1);
        if (!x.allFinite()) {
          raise(file_error(path, "triangle " + std::to_string(to.size() / 3) +
                                     " has a vertex that is not finite"));
        }
        to.push_back({x[0], x[1], x[2]});
      }
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    add_triangles(path, scene, *node.mChildren[i], pose, to);
  }
}

std::vector<std::array<double, 3>>
read_imported_mesh(const std::string& path, const std::string& ending, std::size_t max_megabytes) {
  Assimp::Importer importer;
  if (ending.empty() || !importer.IsExtensionSupported(ending)) {
    raise(file_error(path,
                     "the format is unknown (expected .stl, .obj, .dae or another format that "
                     "Assimp reads)"));
  }
  if (ending == ".dae") {
    require_known_transformations(path, read_xml(path, max_megabytes, xml_text::kept));
  }
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* const scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    raise(file_error(path, importer.GetErrorString()));
  }
  std::vector<std::array<double, 3>> result;
  add_triangles(path, *scene, *scene->mRootNode, Eigen::Matrix4d::Identity(), result);
  return result;
}

#else

std::vector<std::array<double, 3>> read_imported_mesh(const std::string& path, const std::string&,
                                                      std::size_t) {
  raise(file_error(path, "the format is unknown (expected .stl or .obj: the library was built "
                         "without Assimp, which reads .dae and others)"));
}

#endif

} // namespace
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

triangle_mesh read_mesh(const std::string& path) {
  std::string ending = path.substr(std::min(path.rfind('.'), path.size()));
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return 'A' <= c && c <= 'Z' ? char(c + ('a' - 'A')) : c; });
  constexpr std::size_t max_megabytes = 256;
  triangle_mesh result;
  if (ending == ".stl" || ending == ".obj") {
    result.vertices = detail::triangle_file(path, max_megabytes).read(ending);
  } else {
    static_cast<void>(detail::whole_content(path, max_megabytes)); // Assimp's errors say less
    result.vertices = detail::read_imported_mesh(path, ending, max_megabytes);
  }
  if (result.vertices.empty()) {
    detail::raise(file_error(path, "the file contains no triangles"));
  }
  return result;
}

DUET_ABI_END
} // namespace duet
