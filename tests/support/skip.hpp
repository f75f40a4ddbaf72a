// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

/// \file
/// Tests that cannot run everywhere say so: ctest lists the whole file as skipped, unless one of
/// its checks failed.

namespace duet_test {

void skip(const std::string& reason);

/// `name` in the folder of outside data that the environment variable DUET_TEST_DATA names. Without
/// the file the test is skipped and should return.
[[nodiscard]] inline std::optional<std::filesystem::path> outside_data(const std::string& name) {
  const char* const folder = std::getenv("DUET_TEST_DATA");
  if (folder == nullptr) {
    skip("DUET_TEST_DATA names no folder to read " + name + " from");
    return std::nullopt;
  }
  std::filesystem::path file = std::filesystem::path(folder) / name;
  if (!std::filesystem::exists(file)) {
    skip(file.string() + " does not exist");
    return std::nullopt;
  }
  return file;
}

} // namespace duet_test
