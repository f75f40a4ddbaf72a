// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Triangles of COLLADA files.

namespace duet::detail {
DUET_ABI_BEGIN

/// Corners of triangles, three of each: all that the scene shows, in metres.
///
/// \throws file_error
[[nodiscard]] std::vector<std::array<double, 3>> read_collada(const std::string& path,
                                                              std::size_t max_megabytes);

DUET_ABI_END
} // namespace duet::detail
