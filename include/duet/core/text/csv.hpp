// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/core/text/text_rows.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

/// \file
/// Comma-separated values, read and written the same under every locale.

namespace duet {

/// A row of a file, as numbers.
struct csv_row {
  std::size_t line = 0;        ///< line number in the file, counted from 1
  std::string name;            ///< the first cell if it is not a number, else empty
  std::vector<double> numbers; ///< the other cells
};

/// The rows of a file, whose cells are separated by commas, semicolons or blanks. Empty lines and
/// text from `#` on are ignored; a first line without any number is the header.
class csv_file {
public:
  /// \param columns  number of cells with numbers per row; 0: any, the first cell may be a name
  /// \throws file_error
  explicit csv_file(const std::string& path, std::size_t columns = 0) {
    std::vector<std::string_view> cells;
    detail::for_each_line(path, [&](std::size_t line, std::string_view text) {
      detail::split_cells(detail::split_line(text).text, cells);
      if (cells.empty()) {
        return;
      }
      if (rows_.empty() && header_.empty() && detail::are_words(cells)) {
        header_.assign(cells.begin(), cells.end());
        header_line_ = line;
        return;
      }
      csv_row row{line, {}, {}};
      for (std::size_t i = 0; i < cells.size(); ++i) {
        double number = 0;
        if (i == 0 && columns == 0 &&
            detail::read_number(cells[i], number) == std::errc::invalid_argument &&
            !detail::has_decimal_comma(cells[i])) {
          row.name = cells[i];
          continue;
        }
        const std::string error_message =
            detail::read_cell(path, line, "column " + std::to_string(i + 1), cells[i], number);
        if (!error_message.empty()) {
          detail::raise(file_error(path, line, error_message));
        }
        row.numbers.push_back(number);
      }
      if (columns != 0 && row.numbers.size() != columns) {
        detail::raise(file_error(path, line,
                                 std::to_string(columns) + " numbers expected, got " +
                                     std::to_string(row.numbers.size())));
      }
      rows_.push_back(std::move(row));
    });
    if (rows_.empty()) {
      detail::raise(file_error(path, "holds no rows"));
    }
  }

  /// Rows of the file, at least one, in order.
  [[nodiscard]] const std::vector<csv_row>& rows() const { return rows_; }
  /// Names of the columns, empty if the file has none: rows are in the order of the file, so check
  /// the names if you rely on another order.
  [[nodiscard]] const std::vector<std::string>& header() const { return header_; }
  /// Line number of the names, counted from 1; 0 if the file has none.
  [[nodiscard]] std::size_t header_line() const { return header_line_; }

private:
  std::vector<csv_row> rows_;
  std::vector<std::string> header_;
  std::size_t header_line_ = 0;
};

/// A name as a cell: without characters that would end the cell or the line, or begin a comment. If
/// the result is blank or a number, `_` is put before it.
[[nodiscard]] inline std::string csv_sanitized(const std::string& text) {
  std::string name;
  for (const char c : printable(text)) {
    if (c != ',' && c != ';' && c != '"' && c != '#') {
      name += c;
    }
  }
  double number = 0; // would make the reader take a header for a row, or a row's name for a number
  const bool is_number = detail::read_number(name, number) != std::errc::invalid_argument;
  return is_number || detail::trimmed(name).empty() ? "_" + name : name;
}

/// The first line of a table: the names of its columns.
[[nodiscard]] inline std::string csv_header(const std::vector<std::string>& names) {
  std::string line;
  for (std::size_t i = 0; i < names.size(); ++i) {
    line += (i > 0 ? "," : "") + csv_sanitized(names[i]);
  }
  return line + "\n";
}

/// One line of numbers.
inline std::string csv_line(const std::vector<double>& numbers) {
  std::string line;
  for (const double x : numbers) {
    if (!line.empty()) {
      line += ',';
    }
    line += to_text(x);
  }
  line += '\n';
  return line;
}

} // namespace duet
