// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file_error.hpp>

#include <array>
#include <string>
#include <vector>

/// \file
/// Triangle meshes from files: STL, OBJ and what Assimp reads.

namespace duet {
DUET_ABI_BEGIN

/// A triangle mesh, a surface of separate triangles.
struct triangle_mesh {
  /// Vertices of the triangles, three for each.
  std::vector<std::array<double, 3>> vertices = {};
};

/// The triangle mesh in a file: STL, binary or text, OBJ, or any other format that Assimp reads, as
/// COLLADA (.dae), PLY and glTF; faces may have more vertices. Lengths are as in the file, for
/// COLLADA in metres.
///
/// Every word of STL text and of OBJ's vertices and faces is checked, except for the textures and
/// normals of faces. Normals may be nan, as for triangles without area, and are not used.
///
/// Other formats need a duet::io that was built with Assimp, and a trusted file. The mesh has all
/// faces of the scene, each at the pose of its nodes; lines, points and unused parts are omitted.
/// For COLLADA lengths are multiplied by `<unit meter>`, and `<up_axis>` rotates nothing, as in the
/// viewers of the robot operating system, for which these files are made: they use z as it is.
///
/// \throws file_error with the line, or the triangle, and the text there, for files that are not of
/// these formats, numbers that are not finite, more than 256 MB and files without triangles; for
/// COLLADA with the line also for `<skew>`, and for `<rotate>` about an axis that is not a unit
/// vector; with the reason that Assimp states for other files that it does not read
[[nodiscard]] triangle_mesh read_mesh(const std::string& path);

DUET_ABI_END
} // namespace duet
