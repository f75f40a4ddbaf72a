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

/// Finds out before the work whether files could be written to a folder, or to one to be made;
/// makes nothing.
/// \throws std::runtime_error
inline void require_folder(const std::string& folder) {
  namespace fs = std::filesystem;
  if (folder.empty()) {
    throw std::runtime_error("--out: a folder's name is empty");
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
    throw std::runtime_error(folder + ": " +
                             (above == folder ? "is no folder" : above.string() + " is no folder"));
  }
  try {
    duet::require_writable((above / "duet").string());
  } catch (const duet::file_error&) {
    throw std::runtime_error(folder + ": nothing can be written to the folder " + above.string());
  }
}

} // namespace example
