// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/text_rows.hpp>
#include <duet/io/tables/columns.hpp>
#include <duet/io/tables/euler_columns.hpp>
#include <duet/io/tables/file_rotation.hpp>
#include <duet/io/tables/file_time.hpp>
#include <duet/io/tables/row_format.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Reader of rotations and poses from files of any format, row by row.

namespace duet::detail {

/// Row of a file.
struct table_row {
  std::size_t line = 0;
  std::string issue; ///< problem with the row; if empty, the other fields are valid
  file_time time;
  vector3<double> position = vector3<double>::Zero();
  quaternion<double> rotation{1};
};

/// Reads a file line by line.
class table_row_reader {
public:
  /// \param times_path    file of times, empty if times are in the rows
  /// \param has_position  true if rows must have positions
  /// \param angles        columns of Euler angles; null: rotations are quaternions
  /// \throws file_error for an invalid file of times
  table_row_reader(std::string path, std::string times_path, bool has_position,
                   const euler_columns* angles)
      : path_(std::move(path)), times_path_(std::move(times_path)), has_position_(has_position),
        angles_(angles) {
    if (!times_path_.empty()) {
      read_times();
    }
  }

  /// Row in a line, empty if the line holds none.
  ///
  /// \throws file_error with the line of an invalid row, or for an ambiguous header
  [[nodiscard]] std::optional<table_row> read(std::size_t line, std::string_view text) {
    const split_line parts(text);
    const bool is_begin = !format_ && !header_;
    if (parts.text.empty()) {
      if (is_begin) {
        comment_.inspect(line, parts.comment, angles_);
      }
      return std::nullopt;
    }
    split_cells(parts.text, cells_);
    if (is_begin && are_words(cells_)) {
      header_.emplace();
      if (const std::string problem = header_->read(cells_, true, has_position_, angles_);
          !problem.empty()) {
        raise(file_error(path_, line, problem));
      }
      return std::nullopt;
    }
    if (!format_) {
      choose_format(line, parts.text.find_first_of(",;") != parts.text.npos);
    }
    if (cells_.size() != format_->layout.columns) {
      raise(file_error(path_, line,
                       std::to_string(format_->layout.columns) + " columns expected, got " +
                           std::to_string(cells_.size())));
    }
    table_row row;
    row.line = line;
    if (format_->is_matrix) {
      read_matrix(row);
    } else {
      read_columns(row);
    }
    ++row_count_;
    return row;
  }

  /// Checks the number of times, after the last line.
  ///
  /// \throws file_error for more times than rows
  void finish() const {
    if (row_count_ > 0 && row_count_ < times_.size()) {
      raise(file_error(times_path_, times_[row_count_].line,
                       "more times than the " + std::to_string(row_count_) + " rows of " + path_));
    }
  }

  /// Assumptions about the format, empty if there were none.
  [[nodiscard]] std::string remark() const {
    return format_ ? format_->remark + times_remark_ : "";
  }

private:
  /// Time in the file of times.
  struct time_row {
    std::size_t line;
    file_time time;
  };

  /// Reads one time a line, in the unit of a header if there is one.
  void read_times() {
    std::optional<guessed_time_unit> unit;
    for_each_line(times_path_, [&](std::size_t line, std::string_view text) {
      split_cells(split_line(text).text, cells_);
      if (cells_.empty()) {
        return;
      }
      if (!unit && are_words(cells_)) {
        const std::string name = column_name(cells_[0]).unit;
        unit.emplace(name.empty() ? 0 : digits_of_time_unit(times_path_, line, name));
        return;
      }
      double number = 0;
      if (const std::string issue = read_cell(times_path_, line, "column 1", cells_[0], number);
          !issue.empty()) {
        raise(file_error(times_path_, line, issue));
      }
      if (cells_.size() != 1) {
        raise(file_error(times_path_, line,
                         "1 numbers expected, got " + std::to_string(cells_.size())));
      }
      if (!unit) {
        unit.emplace(cells_[0]);
        times_remark_ = unit->name.empty() ? "" : "; times read as " + unit->name;
      }
      require_integer(times_path_, line, "time", number, times_remark_.empty() ? "" : unit->name);
      times_.push_back({line, file_time(cells_[0], unit->digits)});
    });
    if (times_.empty()) {
      raise(file_error(times_path_, "holds no rows"));
    }
  }

  /// \throws file_error for a fraction of a unit that was guessed
  static void require_integer(const std::string& path, std::size_t line, const std::string& name,
                              double x, const std::string& unit) {
    if (!unit.empty() && x != std::floor(x)) {
      raise(file_error(path, line,
                       name + " " + to_text(x) + " is not an integer number of " + unit +
                           " (other units need a header, as in `timestamp [s]`)"));
    }
  }

  void choose_format(std::size_t line, bool has_commas) {
    if (!header_) {
      header_ = comment_.layout(path_, cells_.size(), true, has_position_, angles_,
                                usual_layout(cells_, has_commas));
    }
    if (!header_ && angles_ != nullptr) {
      raise(file_error(path_, line,
                       "there is no header before the first row (expected names of the columns of "
                       "angles)"));
    }
    format_ = header_ ? format_of_header(path_, line, *header_, cells_, has_position_)
                      : format_of_row(path_, line, cells_, has_commas);
    if (const std::string remark = comment_.remark(cells_.size()); !header_ && !remark.empty()) {
      format_->remark += (format_->remark.empty() ? "" : "; ") + remark;
    }
    if (!times_path_.empty() && !format_->is_matrix) {
      raise(file_error(path_, line, "the rows have times, and so does " + times_path_));
    }
  }

  void read_columns(table_row& row) const {
    const table_layout& layout = format_->layout;
    std::array<double, 8> x{};
    for (std::size_t k = 0; k < 8; ++k) {
      if (layout.at[k] != table_layout::absent) {
        note(row, read_cell(path_, row.line, layout.names[k], cells_[layout.at[k]], x[k]));
      }
    }
    if (!row.issue.empty()) {
      return;
    }
    const quaternion<double> q = layout.has_angles ? angles_->rotation({x[4], x[5], x[6]})
                                                   : quaternion<double>(x[4], x[5], x[6], x[7]);
    if (const double length = norm(q); !(std::abs(length - 1) <= unit_norm_tolerance)) {
      row.issue = "the quaternion of " + layout.names[4] + ", " + layout.names[5] + ", " +
                  layout.names[6] + ", " + layout.names[7] + " has norm " + to_text(length) +
                  ", not 1";
      return;
    }
    require_integer(path_, row.line, layout.names[0], x[0], format_->guessed_unit);
    row.time = file_time(cells_[layout.at[0]], format_->digits);
    row.position = {x[1], x[2], x[3]};
    row.rotation = unit_of_file(q);
  }

  void read_matrix(table_row& row) const {
    Eigen::Matrix<double, 3, 4> m;
    for (std::size_t i = 0; i < 12; ++i) {
      note(row, read_cell(path_, row.line, "column " + std::to_string(i + 1), cells_[i],
                          m(Eigen::Index(i / 4), Eigen::Index(i % 4))));
    }
    if (row.issue.empty()) {
      row.issue = read_rotation(m.leftCols<3>(), row.rotation);
    }
    row.position = m.col(3);
    if (times_path_.empty()) {
      row.time = file_time(double(row_count_));
    } else if (row_count_ < times_.size()) {
      row.time = times_[row_count_].time;
    } else {
      raise(file_error(path_, row.line,
                       "more rows than the " + std::to_string(times_.size()) + " times of " +
                           times_path_));
    }
  }

  /// Records a problem with the row; the first one is kept.
  static void note(table_row& row, std::string issue) {
    if (row.issue.empty()) {
      row.issue = std::move(issue);
    }
  }

  std::string path_, times_path_;
  bool has_position_;
  const euler_columns* angles_;
  std::vector<time_row> times_;
  std::string times_remark_;
  std::optional<table_layout> header_;
  commented_header comment_;
  std::optional<row_format> format_;
  std::size_t row_count_ = 0;
  std::vector<std::string_view> cells_;
};

/// Calls row(r) for every `table_row` of a file.
///
/// \return assumptions about the format, empty if there were none
/// \throws file_error as `table_row_reader`
template <class Row>
std::string for_each_table_row(const std::string& path, const std::string& times_path,
                               bool has_position, const euler_columns* angles, const Row& row) {
  table_row_reader reader(path, times_path, has_position, angles);
  for_each_line(path, [&](std::size_t line, std::string_view text) {
    if (const std::optional<table_row> r = reader.read(line, text)) {
      row(*r);
    }
  });
  reader.finish();
  return reader.remark();
}

} // namespace duet::detail
