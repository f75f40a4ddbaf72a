// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/file.hpp>
#include <duet/core/number_text.hpp>
#include <duet/core/printable.hpp>

#include <cmath>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Comma-separated values, read and written the same under every locale.

namespace duet {

/// A row of a file, as numbers.
struct csv_row {
  std::size_t line;
  std::string name; ///< the first cell where it is not a number, else empty
  std::vector<double> numbers;
};

/// The rows of a file. Empty lines and lines from `#` on are passed over, and so is a first line
/// without any number, the header.
class csv_file {
public:
  /// \param columns  how many numbers each row must hold; 0: any, the first cell may be a name
  /// \throws file_error
  explicit csv_file(const std::string& path, std::size_t columns = 0) {
    std::ifstream in(path);
    if (!in) {
      throw file_error(path, "cannot be read");
    }
    std::string text;
    for (std::size_t line = 1; std::getline(in, text); ++line) {
      text = text.substr(0, text.find('#'));
      if (text.find_first_not_of(" \t\r") == std::string::npos) {
        continue;
      }
      const bool first = rows_.empty() && !has_header_;
      csv_row row = parse(path, line, text, columns == 0);
      if (first && row.numbers.empty()) {
        has_header_ = true;
        continue;
      }
      if (columns != 0 && (row.numbers.size() != columns || !row.name.empty())) {
        throw file_error(path, line,
                         std::to_string(columns) + " numbers expected, got " +
                             std::to_string(row.numbers.size()));
      }
      rows_.push_back(std::move(row));
    }
    if (rows_.empty()) {
      throw file_error(path, "holds no rows");
    }
  }

  [[nodiscard]] const std::vector<csv_row>& rows() const { return rows_; }

private:
  csv_row parse(const std::string& path, std::size_t line, const std::string& text,
                bool named) const {
    csv_row row{line, {}, {}};
    std::istringstream cells(text);
    std::string cell;
    bool all_words = true;
    for (std::size_t column = 1; std::getline(cells, cell, ','); ++column) {
      const auto number = parse_number(cell);
      if (number && !std::isfinite(*number)) {
        throw file_error(path, line, "column " + std::to_string(column) + " is " + trimmed(cell));
      }
      if (number) {
        row.numbers.push_back(*number);
        all_words = false;
      } else if (column == 1 && named) {
        row.name = trimmed(cell);
      } else if (!(all_words && rows_.empty() && !has_header_)) {
        throw file_error(path, line,
                         "column " + std::to_string(column) + " is not a number: '" +
                             trimmed(cell) + "'");
      }
    }
    return row;
  }

  static std::string trimmed(const std::string& s) {
    const auto first = s.find_first_not_of(" \t\r");
    if (first == std::string::npos) {
      return {};
    }
    return s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
  }

  std::vector<csv_row> rows_;
  bool has_header_ = false;
};

/// A name as a cell: without what would end the cell or the line, or begin a comment.
[[nodiscard]] inline std::string csv_name(const std::string& text) {
  std::string name;
  for (const char c : printable(text)) {
    if (c != ',' && c != '"' && c != '#') {
      name += c;
    }
  }
  return name;
}

/// The first line of a table: the names of its columns.
[[nodiscard]] inline std::string csv_header(const std::vector<std::string>& names) {
  std::string line;
  for (const std::string& name : names) {
    line += (line.empty() ? "" : ",") + csv_name(name);
  }
  return line + "\n";
}

/// One line of numbers.
inline std::string csv_line(const std::vector<double>& numbers) {
  std::string line;
  for (const double x : numbers) {
    line += (line.empty() ? "" : ",") + to_text(x);
  }
  return line + "\n";
}

} // namespace duet
