// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/number_text.hpp>

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// \file
/// Numbers on a command line.

namespace example {

/// Finite numbers separated by commas.
/// \throws std::runtime_error with the option's name
[[nodiscard]] inline std::vector<double> parse_numbers(const std::string& option,
                                                       const std::string& text) {
  std::vector<double> result;
  std::istringstream cells(text);
  std::string cell;
  while (std::getline(cells, cell, ',')) {
    const auto number = duet::parse_number(cell);
    if (!number || !std::isfinite(*number)) {
      throw std::runtime_error(option + ": '" + cell + "' is not a finite number");
    }
    result.push_back(*number);
  }
  return result;
}

} // namespace example
