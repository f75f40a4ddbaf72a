// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "imported_mesh.hpp"

#include "xml.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/text_rows.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#ifdef DUET_WITH_ASSIMP
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#endif

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace duet::detail {
#ifdef DUET_WITH_ASSIMP

namespace {

/// Rejects transformations of COLLADA that Assimp 5 gets wrong: its rotations about axes that are
/// not unit vectors are none, and `<skew>` may end the program.
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

/// Triangles of a scene.
class scene_triangles {
public:
  scene_triangles(const std::string& path, const aiScene& scene) : path_(path), scene_(scene) {
    add(*scene.mRootNode, Eigen::Matrix4d::Identity());
  }

  std::vector<std::array<double, 3>> vertices;

private:
  void add(const aiNode& node, const Eigen::Matrix4d& parent) {
    using matrix = Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>;
    const Eigen::Matrix4d pose =
        parent * Eigen::Map<const matrix>(&node.mTransformation.a1).cast<double>();
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      add(*scene_.mMeshes[node.mMeshes[i]], pose);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      add(*node.mChildren[i], pose);
    }
  }
  /// Mirrored triangles are reversed, so that their outside remains outside.
  void add(const aiMesh& mesh, const Eigen::Matrix4d& pose) {
    const bool is_mirrored = pose.topLeftCorner<3, 3>().determinant() < 0;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      for (unsigned k = 0; k < 3 && face.mNumIndices == 3; ++k) { // others are points and lines
        const aiVector3D& v = mesh.mVertices[face.mIndices[is_mirrored ? 2 - k : k]];
        const Eigen::Vector4d x = pose * Eigen::Vector4d(v.x, v.y, v.z, 1);
        if (!x.allFinite()) {
          raise(file_error(path_, "triangle " + std::to_string(vertices.size() / 3) +
                                      " has a vertex that is not finite"));
        }
        vertices.push_back({x[0], x[1], x[2]});
      }
    }
  }

  const std::string& path_;
  const aiScene& scene_;
};

} // namespace

DUET_ABI_BEGIN

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
  return scene_triangles(path, *scene).vertices;
}

DUET_ABI_END

#else
DUET_ABI_BEGIN

std::vector<std::array<double, 3>> read_imported_mesh(const std::string& path, const std::string&,
                                                      std::size_t) {
  raise(file_error(path, "the format is unknown (expected .stl or .obj: the library was built "
                         "without Assimp, which reads .dae and others)"));
}

DUET_ABI_END
#endif
} // namespace duet::detail
