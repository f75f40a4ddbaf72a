// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <filesystem>
#include <fstream>
#include <ios>
#include <string>
#include <system_error>

/// \file
/// Files that are read.

namespace duet::detail {

/// Opens a file to be read, byte by byte as it is.
/// \return what is wrong with it, empty if nothing
[[nodiscard]] inline std::string open_input(const std::string& path, std::ifstream& in) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) { // opens, and fails when it is read
    return "is a folder, not a file";
  }
  in.open(path, std::ios::binary);
  return in ? "" : "cannot be read";
}

} // namespace duet::detail
