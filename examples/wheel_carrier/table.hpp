// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "equal_arcs.hpp"

#include <duet/core/text/file_error.hpp>
#include <duet/io/table_file.hpp>
#include <duet/spline/orientations.hpp>

#include <string>
#include <utility>
#include <vector>

/// \file
/// The lookup table: computed from the mechanism or read from a file.

namespace wheel_carrier {

using duet::file_error;

/// Reads u, qw, qx, qy, qz, in the order of the header. Rows that cannot be interpolated are
/// reported here, since the path of the file is known.
/// \throws file_error
inline table read_table(const std::string& path) {
  auto [u, q] = duet::load_table<double>(path);
  if (u.size() < 2) {
    throw file_error(path, "has fewer than two rows");
  }
  try {
    q = duet::align_quaternion_signs(q);
  } catch (const duet::invalid_sample& error) {
    throw file_error(path, "row " + std::to_string(error.index() + 1) + ": " + error.reason());
  }
  return {std::move(u), std::move(q)};
}

} // namespace wheel_carrier
