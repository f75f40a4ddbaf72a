// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/text/file_error.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/io/recording.hpp>

#include "table_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace duet::detail {
namespace {

/// Valid rows in order of time, each time once; the others are added to `issues`.
///
/// \throws file_error if differences of times overflow
[[nodiscard]] std::vector<table_row> in_order(const std::string& path, std::vector<table_row> rows,
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

} // namespace

DUET_ABI_BEGIN

template <class T>
recording<T> loaded_recording(const std::string& path, const std::string& times,
                              const table_columns& columns) {
  recording<T> result;
  std::vector<table_row> rows;
  std::size_t count = 0;
  result.remark = for_each_table_row(
      path, times, !std::is_same_v<T, double>, columns, [&](const table_row& row) {
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
template recording<double> loaded_recording(const std::string&, const std::string&,
                                            const table_columns&);
template recording<screw_dual<double>> loaded_recording(const std::string&, const std::string&,
                                                        const table_columns&);

DUET_ABI_END
} // namespace duet::detail
