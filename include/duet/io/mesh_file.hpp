// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file.hpp>

#include <array>
#include <string>
#include <vector>

/// \file
/// Triangle meshes from STL, OBJ and COLLADA files.

namespace duet {
DUET_ABI_BEGIN

/// A triangle mesh, a surface of separate triangles.
struct triangle_mesh {
  /// Vertices of the triangles, three for each.
  std::vector<std::array<double, 3>> vertices = {};
};

/// The triangle mesh in a file: STL, binary or text, OBJ, or COLLADA (.dae), whose faces may also
/// have more vertices. Lengths are as in the file, for COLLADA in metres.
///
/// Every word of STL text and of OBJ's vertices and faces is checked, except for the textures and
/// normals of faces. Normals may be nan, as for triangles without area, and are not used. COLLADA
/// is read by expat, without which duet::io may be built.
///
/// For COLLADA the mesh has all faces of the scene that `<scene>` names, each at the pose of its
/// nodes, times `<unit meter>`; lines and invisible parts are omitted. `<up_axis>` rotates nothing,
/// as in the viewers of the robot operating system, for which these files are made: they use z as
/// it is.
///
/// \throws file_error with the line, or the triangle, and the text there, for files that are not of
/// these formats, numbers that are not finite, more than 256 MB and files without triangles; for
/// COLLADA with line and element also for skins, `<lookat>`, `<skew>`, polygons with holes, units
/// of parts, references to other files, more than 5 million triangles, and for all files if
/// duet::io was built without expat
[[nodiscard]] triangle_mesh read_mesh(const std::string& path);

DUET_ABI_END
} // namespace duet
