// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>

#include <cstddef>
#include <string>

/// \file
/// Errors of files.

namespace duet {

/// A file that cannot be used: `duet: path:line: reason`, on one line whatever it quotes.
class file_error : public invalid_input {
public:
  file_error(const std::string& path, const std::string& reason)
      : invalid_input(printable("duet: " + path + ": " + reason)) {}
  file_error(const std::string& path, std::size_t line, const std::string& reason)
      : file_error(path + ":" + std::to_string(line), reason) {}
};

} // namespace duet
