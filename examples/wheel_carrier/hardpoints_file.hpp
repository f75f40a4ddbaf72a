// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "carrier.hpp"

#include <duet/core/text/csv.hpp>

#include <array>
#include <cstddef>
#include <string>

/// \file
/// Hardpoints from a file.

namespace wheel_carrier {

using duet::csv_file;
using duet::csv_row;
using duet::file_error;

/// \throws file_error for a header that names the coordinates in another order or otherwise
inline void require_order(const csv_file& file, const std::string& path) {
  constexpr std::array<const char*, 6> names{"ax", "ay", "az", "px", "py", "pz"};
  const auto& header = file.header();
  for (std::size_t i = 0; !header.empty() && i < names.size(); ++i) {
    const std::string name = i + 1 < header.size() ? header[i + 1] : "";
    if (header.size() != 7 || name.substr(0, name.find_first_of(" [(")) != names[i]) {
      throw file_error(
          path, file.header_line(),
          "the header differs from the columns (expected name, ax, ay, az, px, py, pz)");
    }
  }
}

/// Reads five rows `name, ax, ay, az, px, py, pz` (chassis, carrier) and one `wheel centre, x, y,
/// z`.
/// \throws file_error
inline hardpoints read_hardpoints(const std::string& path) {
  const csv_file file(path);
  require_order(file, path);
  hardpoints result;
  bool has_centre = false;
  std::size_t rods = 0;
  for (const csv_row& row : file.rows()) {
    const auto& x = row.numbers;
    if (row.name == "wheel centre" && x.size() == 3 && !has_centre) {
      result.wheel_centre = {x[0], x[1], x[2]};
      has_centre = true;
    } else if (row.name == "wheel centre") {
      throw file_error(path, row.line, "the wheel centre is not a single row of three coordinates");
    } else if (x.size() != 6) {
      throw file_error(path, row.line,
                       "the row is not a rod (expected name, ax, ay, az, px, py, pz)");
    } else if (rods == 5) {
      throw file_error(path, row.line, "there is a sixth rod (expected five)");
    } else {
      result.rods[rods++] = {duet::printable(row.name), {x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
    }
  }
  if (rods != 5) {
    throw file_error(path, std::to_string(rods) + " rods (expected five)");
  }
  if (!has_centre) {
    throw file_error(path, "there is no line `wheel centre, x, y, z`");
  }
  return result;
}

} // namespace wheel_carrier
