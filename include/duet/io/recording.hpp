// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/io/table_file.hpp>
#include <duet/spline/orientations.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Recorded rotations and poses from files that may have bad or unordered rows.

namespace duet {
DUET_ABI_BEGIN

/// Row of a recording that was left out or moved, and the reason.
struct recording_issue {
  std::size_t line = 0; ///< line of the file, counted from 1
  std::string reason;   ///< reason on one line, as `tx is nan: left out`

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("line", line);
    f("reason", reason);
  }
};

/// Recorded rotations (T = double) or poses (T = screw_dual<double>).
template <class T>
struct recording {
  lookup_table<T> table;               ///< parameters: seconds since `start`, from 0 on, increasing
  double start = 0;                    ///< first time of the file, in seconds
  std::vector<std::size_t> lines;      ///< line of the file for each sample of the table
  std::vector<recording_issue> faults; ///< rows left out or moved, by line
  std::size_t left_out = 0;            ///< number of rows of the file that are not in the table
  std::string remark;                  ///< assumptions about the format, empty if there were none

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("table", table);
    f("start", start);
    f("left_out", left_out);
    f("faults", faults);
    f("remark", remark);
  }
};

DUET_ABI_END
} // namespace duet

namespace duet::detail {
DUET_ABI_BEGIN

/// \throws as `load_recording`
template <class T>
[[nodiscard]] recording<T> loaded_recording(const std::string& path, const std::string& times,
                                            const table_columns& columns);
extern template recording<double> loaded_recording(const std::string&, const std::string&,
                                                   const table_columns&);
extern template recording<screw_dual<double>>
loaded_recording(const std::string&, const std::string&, const table_columns&);

DUET_ABI_END
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

/// Reads recorded rotations or poses from any format that `load_table` reads, with the same T.
/// Leaves out rows that are not finite, not units or rotations, or repeat a time; sorts rows that
/// are out of order. `faults` lists all of them.
///
/// Parameters are the differences of the times in the file, with all its digits, even for
/// nanoseconds since 1970, which a double in seconds resolves only to 238 ns.
///
/// \param times  as `load_table`
/// \return `recording<double>` or `recording<screw_dual<double>>`
/// \throws file_error for a file without a valid row or with ambiguous columns; with the line of a
/// row that is ragged or has cells that are not numbers
template <class T>
[[nodiscard]] recording<detail::table_numbers_t<T>> load_recording(const std::string& path,
                                                                   std::string_view times = {}) {
  return detail::loaded_recording<detail::table_numbers_t<T>>(path, std::string(times), {});
}

/// Reads a recording whose columns are stated, as `load_table` with `table_columns`.
///
/// \return `recording<double>` or `recording<screw_dual<double>>`
template <class T>
[[nodiscard]] recording<detail::table_numbers_t<T>> load_recording(const std::string& path,
                                                                   const table_columns& columns) {
  return detail::loaded_recording<detail::table_numbers_t<T>>(path, {}, columns);
}

/// Reads a recording whose rotations are Euler angles, in the given columns, sequence and unit.
/// Otherwise as above; the file needs a header.
///
/// \return `recording<double>` or `recording<screw_dual<double>>`
template <class T>
[[nodiscard]] recording<detail::table_numbers_t<T>> load_recording(const std::string& path,
                                                                   const euler_columns& angles) {
  return detail::loaded_recording<detail::table_numbers_t<T>>(path, {}, {.angles = angles});
}

template <class T = void, class... More>
  requires(!requires { typename detail::table_numbers_t<T>; })
DUET_REFUSED("load_recording<double> reads rotations, load_recording<screw_dual<double>> poses")
recording<double> load_recording(const std::string&, const More&...);

DUET_ABI_END
} // namespace duet
