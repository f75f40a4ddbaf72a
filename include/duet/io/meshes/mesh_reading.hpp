// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/text/file.hpp>
#include <duet/io/mesh_file.hpp>
#include <duet/io/meshes/collada_scene.hpp>
#include <duet/io/meshes/triangle_file.hpp>
#include <duet/io/xml_parser.hpp>

#include <algorithm>
#include <cstddef>
#include <string>

/// \file
/// By which reader a surface is read.

namespace duet {

#ifdef DUET_DEFINES_COMPILED
DUET_COMPILED_FUNCTION triangle_mesh read_mesh(const std::string& path) {
  std::string ending = path.substr(std::min(path.rfind('.'), path.size()));
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return 'A' <= c && c <= 'Z' ? char(c + ('a' - 'A')) : c; });
  constexpr std::size_t max_megabytes = 256;
  triangle_mesh result;
  if (ending == ".dae") {
    const detail::collada_document document(
        path, detail::xml_parser(path, max_megabytes, detail::xml_text::kept).root());
    result.vertices = detail::collada_scene(document).triangles();
  } else {
    result.vertices = detail::triangle_file(path, max_megabytes).read(ending);
  }
  if (result.vertices.empty()) {
    detail::raise(file_error(path, "the file contains no triangles"));
  }
  return result;
}
#endif

} // namespace duet
