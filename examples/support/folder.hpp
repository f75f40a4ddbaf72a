// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file.hpp>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

/// \file
/// The folder that a program writes to.

namespace example {

/// Checks before the computation that files can be written to a folder, or that the folder can be
/// created; creates nothing.
/// \throws std::runtime_error
inline void require_folder(const std::string& folder) {
  namespace fs = std::filesystem;
  if (folder.empty()) {
    throw std::runtime_error("--out is empty (expected a folder)");
  }
  std::error_code ignored;
  fs::path above = fs::path(folder);
  while (!exists(fs::symlink_status(above, ignored))) {
    above = above.has_relative_path() ? above.parent_path() : fs::path();
    if (above.empty()) {
      above = ".";
    }
  }
  if (!is_directory(fs::status(above, ignored))) {
    throw std::runtime_error(
        folder + ": " +
        (above == folder ? "is not a folder" : above.string() + " is not a folder"));
  }
  try {
    duet::require_writable((above / "duet").string());
  } catch (const duet::file_error&) {
    throw std::runtime_error(folder + ": cannot write to the folder " + above.string());
  }
}

} // namespace example
