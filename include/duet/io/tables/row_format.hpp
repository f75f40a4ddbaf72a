// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/io/tables/columns.hpp>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Format of a file of rotations or poses, detected from
///
/// - a header, a first line of names or a comment before the first row: columns by their names,
///   others ignored. A comment counts if its names and their number fit the columns. Times are in
///   the unit given there, in nanoseconds in files with the names of the EuRoC data set, else in
///   seconds; integers that as seconds would be later than the year 5000 are read as milliseconds
///   (from 1e11 on), microseconds (1e14) or nanoseconds (1e17). Times of rostopic (%time, or
///   field.header.stamp if present) are nanoseconds if they are integers, seconds if they have a
///   decimal point, as it prints them. Columns u and tau are not times and are read unchanged;
/// - 8 numbers separated by blanks: TUM's `timestamp tx ty tz qx qy qz qw`, times by the same rule;
/// - 8 numbers separated by commas, the first 1e17 or more: EuRoC's `timestamp,x,y,z,qw,qx,qy,qz`.
///   Smaller ones are rejected, as w may be first or last (likewise with semicolons instead of
///   commas);
/// - 12 numbers: KITTI's matrix [R t], row by row; the time is the row's index from 0 on, or in a
///   file of times.

namespace duet::detail {

/// Format of the rows of a file.
struct row_format {
  table_layout layout;
  bool is_matrix = false;   ///< true for [R t] row by row, without the layout
  std::size_t digits = 0;   ///< times are in units of 10^−digits s
  std::string guessed_unit; ///< unit guessed from the size of times, which must then be integers
  std::string remark;       ///< assumptions about the format, empty if there were none
};

/// Unit of time that no header names, guessed from the size of the first time.
struct guessed_time_unit {
  std::size_t digits = 0; ///< unit is 10^−digits s
  std::string name;       ///< name of the unit, empty for seconds

  explicit guessed_time_unit(std::size_t digits_of_second)
      : digits(digits_of_second), name(digits == 9   ? "nanoseconds"
                                       : digits == 6 ? "microseconds"
                                       : digits == 3 ? "milliseconds"
                                                     : "") {}
  /// Guesses the unit of times from the years 1973 to 5138. A number with a fraction is in seconds,
  /// except one from 1e17 to 1e20, so that files of times in seconds keep their unit when they are
  /// written and read again.
  explicit guessed_time_unit(std::string_view cell)
      : guessed_time_unit([&]() -> std::size_t {
          const double size = std::abs(parse_number(cell).value_or(0));
          const bool is_integer = size == std::floor(size);
          return size >= 1e20                 ? 0
                 : size >= 1e17               ? 9
                 : !is_integer || size < 1e11 ? 0
                 : size >= 1e14               ? 6
                                              : 3;
        }()) {}
};

/// Layout of a row of numbers without a header: TUM's or EuRoC's, empty for others.
[[nodiscard]] inline std::optional<table_layout>
usual_layout(const std::vector<std::string_view>& cells, bool has_commas) {
  using enum table_column;
  if (cells.size() != 8 || (has_commas && guessed_time_unit(cells[0]).digits != 9)) {
    return std::nullopt;
  }
  return has_commas ? table_layout({u, x, y, z, qw, qx, qy, qz},
                                   {"timestamp", "x", "y", "z", "qw", "qx", "qy", "qz"})
                    : table_layout({u, x, y, z, qx, qy, qz, qw},
                                   {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"});
}

/// Detects the format from the first row, without a header.
///
/// \param cells  cells of the first row
/// \throws file_error if it could be more than one format, or is not a known one
[[nodiscard]] inline row_format format_of_row(const std::string& path, std::size_t line,
                                              const std::vector<std::string_view>& cells,
                                              bool has_commas) {
  row_format result;
  if (cells.size() == 12) {
    result.is_matrix = true;
    result.layout.columns = 12;
    result.remark = "12 columns: read as in KITTI files, the matrix [R t] row by row";
    return result;
  }
  const std::optional<table_layout> layout = usual_layout(cells, has_commas);
  if (!layout) {
    raise(
        file_error(path, line,
                   std::to_string(cells.size()) +
                       " columns without a header before the first row (expected a header such as "
                       "`u,x,y,z,qw,qx,qy,qz`; TUM files, timestamp tx ty tz qx qy qz qw separated "
                       "by blanks, and KITTI files, 12 numbers, need none): " +
                       known_columns));
  }
  result.layout = *layout;
  const guessed_time_unit unit(cells[0]);
  result.digits = unit.digits;
  result.guessed_unit = unit.name;
  if (!unit.name.empty()) {
    result.remark = "timestamps in " + unit.name + ": read as " +
                    (has_commas ? "in EuRoC files, timestamp, x, y, z, qw, qx, qy, qz"
                                : "timestamp tx ty tz qx qy qz qw");
  }
  return result;
}

/// Number of digits of a unit of time in a header: 9 for ns, 0 for s.
///
/// \throws file_error for an unknown unit
[[nodiscard]] inline std::size_t digits_of_time_unit(const std::string& path, std::size_t line,
                                                     const std::string& unit) {
  const std::size_t digits = unit == "ns" ? 9 : unit == "us" ? 6 : unit == "ms" ? 3 : 0;
  if (digits == 0 && unit != "s" && unit != "sec" && unit != "seconds") {
    raise(file_error(path, line,
                     "the unit of timestamps is '" + unit + "' (expected s, ms, us or ns)"));
  }
  return digits;
}

/// Detects the format from a header and the first row.
///
/// \param cells         cells of the first row
/// \param has_position  true if positions are needed
/// \throws file_error for unknown units
[[nodiscard]] inline row_format format_of_header(const std::string& path, std::size_t line,
                                                 const table_layout& header,
                                                 const std::vector<std::string_view>& cells,
                                                 bool has_position) {
  row_format result;
  result.layout = header;
  const std::string& unit = header.units[0];
  if (header.has_time && unit.empty()) {
    const std::string_view first = header.at[0] < cells.size() ? cells[header.at[0]] : "";
    const bool is_of_ros = header.is_of_ros && first.find_first_of(".eE") == first.npos;
    const guessed_time_unit guess =
        header.is_euroc || is_of_ros ? guessed_time_unit(9) : guessed_time_unit(first);
    result.digits = guess.digits;
    result.guessed_unit = guess.name;
    if (!guess.name.empty()) {
      result.remark = header.is_euroc ? "a EuRoC file: timestamps in nanoseconds"
                      : is_of_ros     ? header.names[0] + " as rostopic writes it, in nanoseconds"
                                      : "timestamps of this size are taken for " + guess.name;
    }
  } else if (header.has_time) {
    result.digits = digits_of_time_unit(path, line, unit);
    if (result.digits > 0) {
      result.remark =
          std::string(header.is_euroc ? "a EuRoC file: " : "") + "timestamps in " + unit;
    }
  }
  for (std::size_t k = 1; has_position && k < 4; ++k) {
    if (!header.units[k].empty() && header.units[k] != "m") {
      raise(file_error(path, line,
                       "the unit of positions is '" + header.units[k] + "' (expected m)"));
    }
  }
  return result;
}

} // namespace duet::detail
