// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file_error.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/printable.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <ios>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

/// \file
/// Text files, line by line and cell by cell; comma-separated values, read and written the same
/// under every locale.

namespace duet::detail {

/// A file opened for reading, byte by byte as it is.
///
/// \throws file_error if it cannot be read
[[nodiscard]] inline std::ifstream opened_input(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) { // opens, and fails when it is read
    raise(file_error(path, "is a folder, not a file"));
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    raise(file_error(path, "cannot be read"));
  }
  return in;
}

/// Content of a file, byte by byte as it is.
///
/// \throws file_error if it cannot be read or exceeds that many megabytes
[[nodiscard]] inline std::string whole_content(const std::string& path, std::size_t megabytes) {
  std::ifstream in = opened_input(path);
  std::string text;
  for (std::array<char, 65536> part{}; in.read(part.data(), part.size()), in.gcount() > 0;) {
    text.append(part.data(), std::size_t(in.gcount()));
    if (text.size() > megabytes << 20U) {
      raise(file_error(path, "has more than " + std::to_string(megabytes) + " MB"));
    }
  }
  if (in.bad()) {
    raise(file_error(path, "cannot be read"));
  }
  return text;
}

/// Calls f(word) for every word of a text, between blanks and ends of lines.
template <class F>
void for_each_word(std::string_view text, const F& f) {
  constexpr std::string_view blanks = " \t\r\n";
  for (std::size_t end = 0, first;
       (first = text.find_first_not_of(blanks, end)) != std::string_view::npos;) {
    end = std::min(text.find_first_of(blanks, first), text.size());
    f(text.substr(first, end - first));
  }
}

/// Calls f(number, text) for every line, counted from 1, without its end and without a byte order
/// mark.
///
/// \throws file_error if the file cannot be read or is not text
template <class F>
void for_each_line(const std::string& path, const F& f) {
  std::ifstream in = opened_input(path);
  std::string buffer(std::size_t(1) << 14, '\0');
  std::string_view unread;
  for (std::size_t line = 1;; ++line) {
    std::size_t end = unread.find('\n');
    while (end == std::string_view::npos && in) {
      if (unread.size() > 1'000'000) {
        raise(file_error(path, line,
                         "the line has more than a million characters (expected a table)"));
      }
      // Moves the unread text to the front, and reads more behind it.
      std::copy(unread.begin(), unread.end(), buffer.begin());
      const std::size_t size = unread.size();
      if (2 * size > buffer.size()) {
        buffer.resize(2 * buffer.size());
      }
      in.read(buffer.data() + size, std::streamsize(buffer.size() - size));
      if (in.bad()) {
        raise(file_error(path, line, "cannot be read"));
      }
      const auto count = std::size_t(in.gcount());
      unread = {buffer.data(), size + count};
      end = unread.find('\n', size);
    }
    if (unread.empty()) {
      return;
    }
    std::string_view text = unread.substr(0, end);
    unread.remove_prefix(std::min(text.size() + 1, unread.size()));
    if (line == 1) {
      if (text.starts_with("\xef\xbb\xbf")) {
        text.remove_prefix(3);
      } else if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
        raise(file_error(path, "is UTF-16 (expected UTF-8)"));
      }
    }
    f(line, text);
  }
}

/// Text before `#`, and the comment after it.
struct split_line {
  std::string_view text, comment;

  explicit split_line(std::string_view line) {
    const std::size_t hash = std::min(line.find('#'), line.size());
    text = trimmed(line.substr(0, hash));
    comment = trimmed(line.substr(std::min(hash + 1, line.size())));
  }
};

/// The cells of a line: separated by semicolons if it has any, else by commas if it has any, one at
/// its end not counted, else by blanks, where units in brackets, as in `t [s]`, belong to the cell
/// before.
inline void split_cells(std::string_view text, std::vector<std::string_view>& cells) {
  cells.clear();
  text = trimmed(text);
  const char separator = text.find(';') != text.npos ? ';' : ',';
  if (text.find(separator) != text.npos) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find(separator), text.size());
      cells.push_back(trimmed(text.substr(0, end)));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    return;
  }
  constexpr std::string_view blanks = " \t\r\n";
  for (std::size_t first = 0; (first = text.find_first_not_of(blanks, first)) != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, first), text.size());
    if ((text[first] == '[' || text[first] == '(') && !cells.empty()) {
      const char* const begin = cells.back().data();
      cells.back() = {begin, std::size_t(text.data() + end - begin)};
    } else {
      cells.push_back(text.substr(first, end - first));
    }
    first = end;
  }
}

/// True if it would be a number with a decimal point instead of a comma.
[[nodiscard]] inline bool has_decimal_comma(std::string_view cell) {
  const std::size_t comma = cell.find(',');
  if (comma == cell.npos) {
    return false;
  }
  std::string text(cell);
  text[comma] = '.';
  double number = 0;
  return read_number(text, number) != std::errc::invalid_argument;
}

/// True if a line of cells holds no number.
[[nodiscard]] inline bool are_words(const std::vector<std::string_view>& cells) {
  return std::none_of(cells.begin(), cells.end(), [](std::string_view cell) {
    double number = 0;
    return read_number(cell, number) != std::errc::invalid_argument || has_decimal_comma(cell);
  });
}

/// The number of a cell.
///
/// \return the problem with it as a number, empty if valid
/// \throws file_error if it is not a number
[[nodiscard]] inline std::string read_cell(const std::string& path, std::size_t line,
                                           const std::string& name, std::string_view cell,
                                           double& number) {
  const std::errc error = read_number(cell, number);
  if (error == std::errc::invalid_argument) {
    raise(file_error(
        path, line,
        name + " is not a number: '" + std::string(cell) + "'" +
            (has_decimal_comma(cell) ? " (expected a decimal point, not a comma)" : "")));
  }
  if (error != std::errc() || !(number - number == 0)) {
    return name + " is " + std::string(cell) +
           (error == std::errc() ? "" : ", beyond the range of a double");
  }
  return {};
}

} // namespace duet::detail

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
