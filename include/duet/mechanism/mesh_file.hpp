// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/core/text/file.hpp>

#include <array>
#include <string>
#include <vector>

/// \file
/// Surfaces out of files: STL, OBJ and COLLADA.

namespace duet {

/// A surface of triangles.
struct mesh_surface {
  /// Corners of the triangles, three of each.
  std::vector<std::array<double, 3>> corners = {};
};

/// The surface in a file of triangles: STL, binary or text, OBJ, or COLLADA (.dae), whose faces may
/// have more corners, too; lengths as they stand there, of COLLADA in metres.
///
/// Every word of STL as text and of OBJ's vertices and faces is checked, but which textures and
/// normals faces name. Normals may be nan, as of triangles without area, and are not used. XML is
/// read by expat: programs link it, or duet::compiled.
///
/// Of COLLADA it is all faces of the scene that `<scene>` names, each where nodes place it, times
/// `<unit meter>`; lines and what is not shown are left out. `<up_axis>` turns nothing, as in the
/// viewers of the robot operating system, for which these files are made: they take z as it stands.
///
/// \throws file_error with the line, or the triangle, and what stands there, for what is not of
/// these formats, numbers that are not finite, more than 256 MB and no triangles at all; of COLLADA
/// with line and element also for skins, `<lookat>`, `<skew>`, polygons with holes, units of parts,
/// what is in other files, and more than 5 million triangles
[[nodiscard]] DUET_COMPILED_FUNCTION mesh_surface read_mesh(const std::string& path);

} // namespace duet

#ifndef DUET_COMPILED
#include <duet/mechanism/meshes/mesh_reading.hpp>
#endif
