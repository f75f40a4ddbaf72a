// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Meshes in the formats that Assimp reads.

namespace duet::detail {
DUET_ABI_BEGIN

/// Vertices of triangles, three for each: all that the scene of a file shows.
///
/// \param ending  of the file's name, in small letters
/// \throws file_error; for all files if the library was built without Assimp
[[nodiscard]] std::vector<std::array<double, 3>>
read_imported_mesh(const std::string& path, const std::string& ending, std::size_t max_megabytes);

DUET_ABI_END
} // namespace duet::detail
