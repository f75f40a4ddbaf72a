// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/spline/tables/columns.hpp>

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Which format a file of rotations or poses has. It is told by
///
/// - a header, a first line of names or a comment before the first row: columns by their names,
///   others passed over. Times are in the unit that it says, else in seconds; in nanoseconds in
///   files with the names of the EuRoC data set, or where the first is 1e17 or more. rostopic's
///   (%time, or field.header.stamp where it is there, too) are nanoseconds where they are whole
///   numbers, seconds where they have a point, as it prints them. Columns u and tau are no times
///   and are taken as they are;
/// - 8 numbers apart by blanks: TUM's `timestamp tx ty tz qx qy qz qw`, in seconds, or nanoseconds
///   by the same rule;
/// - 8 numbers apart by commas, the first 1e17 or more: EuRoC's `timestamp,x,y,z,qw,qx,qy,qz`.
///   Smaller ones are refused, as w may be first or last (semicolons in place of commas: alike);
/// - 12 numbers: KITTI's matrix [R t], row by row; the time is the row's number from 0 on, or in a
///   file of times.

namespace duet::detail {

/// How the rows of a file are to be read.
struct row_format {
  table_layout layout;
  bool is_matrix = false;     ///< [R t] row by row, not by the layout
  std::size_t digits = 0;     ///< times are in units of 10^−digits s
  bool must_be_whole = false; ///< times are taken for nanoseconds and must be whole
  std::string remark;         ///< how the file was understood, where that is not plain
};

/// Is it a time since 1970 in nanoseconds?
[[nodiscard]] inline bool is_of_nanoseconds(std::string_view cell) {
  constexpr double least = 1e17; // 1973; as seconds the age of the universe
  return std::abs(parse_number(cell).value_or(0)) >= least;
}

/// \param cells  the first row
/// \throws file_error where it could be more than one format, or is none
[[nodiscard]] inline row_format format_of_row(const std::string& path, std::size_t line,
                                              const std::vector<std::string_view>& cells,
                                              bool has_commas) {
  using enum table_column;
  row_format result;
  if (cells.size() == 12) {
    result.is_matrix = true;
    result.layout.columns = 12;
    result.remark = "12 columns: read as in KITTI files, the matrix [R t] row by row";
    return result;
  }
  const bool has_nanoseconds = is_of_nanoseconds(cells[0]);
  if (cells.size() != 8 || (has_commas && !has_nanoseconds)) {
    raise(
        file_error(path, line,
                   std::to_string(cells.size()) +
                       " columns, and no header before the first row says which is which, as "
                       "`u,x,y,z,qw,qx,qy,qz` does; those of TUM's files (timestamp tx ty tz qx qy "
                       "qz qw, apart by blanks) and KITTI's (12 numbers) need none: " +
                       known_columns));
  }
  if (has_commas) {
    result.layout = table_layout({u, x, y, z, qw, qx, qy, qz},
                                 {"timestamp", "x", "y", "z", "qw", "qx", "qy", "qz"});
  } else {
    result.layout = table_layout({u, x, y, z, qx, qy, qz, qw},
                                 {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"});
  }
  if (has_nanoseconds) {
    result.digits = 9;
    result.must_be_whole = true;
    result.remark = std::string("timestamps in nanoseconds: read as ") +
                    (has_commas ? "in EuRoC files, timestamp, x, y, z, qw, qx, qy, qz"
                                : "timestamp tx ty tz qx qy qz qw");
  }
  return result;
}

/// \param cells      the first row
/// \param has_place  are places wanted?
/// \throws file_error for units that are not known
[[nodiscard]] inline row_format format_of_header(const std::string& path, std::size_t line,
                                                 const table_layout& header,
                                                 const std::vector<std::string_view>& cells,
                                                 bool has_place) {
  row_format result;
  result.layout = header;
  const std::string& unit = header.units[0];
  if (header.has_time && unit.empty()) {
    const std::string_view first = header.at[0] < cells.size() ? cells[header.at[0]] : "";
    const bool is_of_ros = header.is_of_ros && first.find_first_of(".eE") == first.npos;
    if (header.is_euroc || is_of_ros || is_of_nanoseconds(first)) {
      result.digits = 9;
      result.must_be_whole = true;
      result.remark = header.is_euroc ? "a EuRoC file: timestamps in nanoseconds"
                      : is_of_ros     ? header.names[0] + " as rostopic writes it, in nanoseconds"
                                      : "timestamps of this size are taken for nanoseconds";
    }
  } else if (header.has_time && (unit == "ns" || unit == "us" || unit == "ms")) {
    result.digits = unit == "ns" ? 9 : unit == "us" ? 6 : 3;
    result.remark = std::string(header.is_euroc ? "a EuRoC file: " : "") + "timestamps in " + unit;
  } else if (header.has_time && unit != "s" && unit != "sec" && unit != "seconds") {
    raise(file_error(path, line, "timestamps in '" + unit + "': s, ms, us or ns expected"));
  }
  for (std::size_t k = 1; has_place && k < 4; ++k) {
    if (!header.units[k].empty() && header.units[k] != "m") {
      raise(file_error(path, line, "positions in '" + header.units[k] + "': m expected"));
    }
  }
  return result;
}

} // namespace duet::detail
