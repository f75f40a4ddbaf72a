// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/io/table_file.hpp>
#include <duet/io/tables/row_reader.hpp>
#include <duet/spline/lookup_table.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Recorded rotations and poses from files that may have bad or unordered rows.

namespace duet {

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

namespace detail {

/// Valid rows in order of time, each time once; the others are added to `issues`.
///
/// \throws file_error if differences of times overflow
[[nodiscard]] inline std::vector<table_row> in_order(const std::string& path,
                                                     std::vector<table_row> rows,
                                                     std::vector<recording_issue>& issues) {
  std::sort(rows.begin(), rows.end(), [](const table_row& a, const table_row& b) {
    return a.time < b.time || (!(b.time < a.time) && a.line < b.line);
  });
  const auto add_issue = [&](const table_row& row, const std::string& problem) {
    issues.push_back({row.line, printable("timestamp " + to_text(row.time.seconds()) + problem)});
  };
  std::vector<table_row> once;
  for (const table_row& row : rows) {
    const double since = row.time.since(rows.front().time);
    if (!(since - since == 0)) {
      raise(file_error(path, row.line,
                       "the difference of timestamp " + to_text(row.time.seconds()) + " from " +
                           to_text(rows.front().time.seconds()) + " in line " +
                           std::to_string(rows.front().line) + " overflows"));
    }
    if (!once.empty() && !(since > once.back().time.since(rows.front().time))) {
      add_issue(row, " repeats line " + std::to_string(once.back().line) + ": left out");
    } else {
      once.push_back(row);
    }
  }
  std::size_t earliest = once.empty() ? 0 : once.back().line; // first line of the later rows
  for (auto row = once.rbegin(); row != once.rend(); ++row) {
    if (row->line > earliest) {
      add_issue(*row, " is out of order: sorted in");
    }
    earliest = std::min(earliest, row->line);
  }
  std::sort(issues.begin(), issues.end(),
            [](const auto& a, const auto& b) { return a.line < b.line; });
  return once;
}

template <class T>
[[nodiscard]] recording<T> loaded_recording(const std::string& path, const std::string& times,
                                            const euler_columns* angles) {
  recording<T> result;
  std::vector<table_row> rows;
  std::size_t count = 0;
  result.remark =
      for_each_table_row(path, times, !is_rotation_scalar<T>, angles, [&](const table_row& row) {
        ++count;
        if (row.issue.empty()) {
          rows.push_back(row);
        } else {
          result.faults.push_back({row.line, printable(row.issue + ": left out")});
        }
      });
  if (rows.empty()) {
    raise(file_error(path, "holds no usable rows"));
  }
  rows = in_order(path, std::move(rows), result.faults);
  result.left_out = count - rows.size();
  result.start = rows.front().time.seconds();
  for (const table_row& row : rows) {
    result.table.parameters.push_back(row.time.since(rows.front().time));
    result.table.elements.push_back(element_of<T>(row));
    result.lines.push_back(row.line);
  }
  return result;
}

} // namespace detail

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
                                                                   const std::string& times = {}) {
  return detail::loaded_recording<detail::table_numbers_t<T>>(path, times, nullptr);
}

/// Reads a recording whose rotations are Euler angles, in the given columns, sequence and unit.
/// Otherwise as above; the file needs a header.
///
/// \return `recording<double>` or `recording<screw_dual<double>>`
template <class T>
[[nodiscard]] recording<detail::table_numbers_t<T>> load_recording(const std::string& path,
                                                                   const euler_columns& angles) {
  return detail::loaded_recording<detail::table_numbers_t<T>>(path, {}, &angles);
}

template <class T = void, class... More>
  requires(!requires { typename detail::table_numbers_t<T>; })
DUET_REFUSED("load_recording<double> reads rotations, load_recording<screw_dual<double>> poses")
recording<double> load_recording(const std::string&, const More&...);

} // namespace duet
