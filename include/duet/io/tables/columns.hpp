// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/file.hpp>
#include <duet/core/text/text_rows.hpp>
#include <duet/io/tables/euler_columns.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// \file
/// Columns of a table of rotations or poses, identified by their names in a header.

namespace duet::detail {

/// Contents of a column; `other` is ignored.
enum class table_column : std::size_t { u, x, y, z, qw, qx, qy, qz, other };

inline constexpr const char* known_columns =
    "known columns are u (tau, t, time, timestamp), x y z (tx, px, p_x, p_RS_R_x ...) and qw qx qy "
    "qz (q_w, q_RS_w ...), with units as in `t [s]`; Euler angles need `euler_columns`";

/// Name in a header, with its meaning and unit.
struct column_name {
  table_column what = table_column::other;
  bool is_a_time = false; ///< `u` in seconds, or in a unit of time
  bool is_of_ros = false; ///< time as `rostopic echo -p` writes it
  std::string name;
  std::string unit; ///< as written, empty if absent

  explicit column_name(std::string_view cell) {
    if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"') { // as spreadsheets write
      cell = cell.substr(1, cell.size() - 2);
    }
    const std::size_t bracket = std::min(cell.find_first_of("[("), cell.size());
    name = lower(trimmed(cell.substr(0, bracket)));
    if (bracket < cell.size()) {
      unit = lower(cell.substr(bracket + 1, cell.find_first_of("])", bracket) - bracket - 1));
    }
    what = meaning();
  }

private:
  [[nodiscard]] static std::string lower(std::string_view text) {
    std::string result(trimmed(text));
    for (char& c : result) {
      c = c == '.' ? '_' : char(std::tolower(static_cast<unsigned char>(c)));
    }
    return result;
  }

  /// Column that the name denotes; also sets `is_a_time`, `is_of_ros` and `unit`.
  [[nodiscard]] table_column meaning() {
    if (name == "u" || name == "tau") {
      return table_column::u;
    }
    is_of_ros = name == "%time" || name == "field_header_stamp";
    if (is_time(name) || is_of_ros) {
      is_a_time = true;
      return table_column::u;
    }
    const std::size_t cut = name.rfind('_');
    const std::string last = cut == std::string::npos ? "" : name.substr(cut + 1);
    if ((last == "s" || last == "ms" || last == "us" || last == "ns") &&
        is_time(name.substr(0, cut)) && unit.empty()) {
      unit = last; // timestamp_ns
      is_a_time = true;
      return table_column::u;
    }
    const std::string_view axes = "wxyz";
    const std::size_t axis = name.empty() ? axes.npos : axes.find(name.back());
    if (axis == axes.npos) {
      return table_column::other;
    }
    const bool has_cut = cut != std::string::npos && cut + 2 == name.size();
    const std::string of = name.substr(0, has_cut ? cut : name.size() - 1);
    const auto ends_with = [&](std::string_view end) { return has_cut && of.ends_with(end); };
    if (of == "q" || (has_cut && of.starts_with("q_")) || ends_with("quat") ||
        ends_with("quaternion") || ends_with("orientation") || ends_with("rotation")) {
      return table_column(std::size_t(table_column::qw) + axis);
    }
    if (axis > 0 && (of.empty() || of == "t" || of == "p" || (has_cut && of.starts_with("p_")) ||
                     ends_with("pos") || ends_with("position") || ends_with("translation"))) {
      return table_column(std::size_t(table_column::x) + axis - 1);
    }
    return table_column::other;
  }

  [[nodiscard]] static bool is_time(const std::string& text) {
    return text == "t" || text == "time" || text == "timestamp" || text == "stamp";
  }
};

/// Columns of the eight numbers of a row: u, x y z, qw qx qy qz; or of seven, with three Euler
/// angles instead of the last four.
struct table_layout {
  static constexpr std::size_t absent = std::size_t(-1);

  std::array<std::size_t, 8> at;
  std::array<std::string, 8> names; ///< names as in the header
  std::size_t columns = 0;
  std::array<std::string, 8> units;
  bool has_time = false;   ///< true if the parameter is a time
  bool is_euroc = false;   ///< true if named as in the files of the EuRoC data set
  bool is_of_ros = false;  ///< true if the time is as `rostopic echo -p` writes it
  bool has_angles = false; ///< true for Euler angles instead of a quaternion

  table_layout() { at.fill(absent); }
  /// Layout with columns in this order.
  table_layout(const std::vector<table_column>& order, const std::vector<std::string>& their_names)
      : table_layout() {
    columns = order.size();
    for (std::size_t i = 0; i < columns; ++i) {
      at[std::size_t(order[i])] = i;
      names[std::size_t(order[i])] = their_names[i];
    }
  }

  /// Reads a header.
  ///
  /// \param has_u         true if the rows must have a parameter
  /// \param has_position  true if the rows must have positions
  /// \param angles        columns of Euler angles; null: rotations are quaternions
  /// \return problem with the header, empty if valid
  [[nodiscard]] std::string read(const std::vector<std::string_view>& header, bool has_u,
                                 bool has_position, const euler_columns* angles = nullptr) {
    columns = header.size();
    has_angles = angles != nullptr;
    for (std::size_t i = 0; i < columns; ++i) {
      const column_name cell(header[i]);
      const std::size_t k = has_angles ? angle_column(*angles, cell) : std::size_t(cell.what);
      if (k == std::size_t(table_column::other)) {
        continue;
      }
      // ROS writes two times: the second, in the header of the message, is that of the measurement.
      const bool is_better_time = names[k] == "%time" && cell.name == "field_header_stamp";
      if (at[k] != absent && !is_better_time) {
        return "the header has both '" + names[k] + "' and '" + std::string(header[i]) + "'";
      }
      at[k] = i;
      names[k] = header[i];
      units[k] = cell.unit;
      has_time = has_time || cell.is_a_time;
      is_euroc = is_euroc || cell.name.starts_with("p_rs_");
      is_of_ros = is_of_ros || cell.is_of_ros;
    }
    return missing(has_u, has_position, angles);
  }

private:
  /// Index of a column of angles, which take the positions of the first three numbers of a
  /// quaternion.
  [[nodiscard]] static std::size_t angle_column(const euler_columns& angles,
                                                const column_name& cell) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (cell.name == column_name(angles.names()[k]).name) {
        return std::size_t(table_column::qw) + k;
      }
    }
    return std::size_t(cell.what < table_column::qw ? cell.what : table_column::other);
  }

  [[nodiscard]] static bool is_unit_of(const euler_columns& angles, const std::string& unit) {
    return unit.empty() ||
           (angles.unit() == angle_unit::degree
                ? unit == "deg" || unit == "degree" || unit == "degrees" || unit == "\u00b0"
                : unit == "rad" || unit == "radian" || unit == "radians");
  }

  /// Problem with the header: missing columns, or units of angles other than the given one.
  [[nodiscard]] std::string missing(bool has_u, bool has_position,
                                    const euler_columns* angles) const {
    constexpr std::array<const char*, 8> short_names{"u", "x", "y", "z", "qw", "qx", "qy", "qz"};
    for (std::size_t k = 0; k < (has_angles ? 7 : 8); ++k) {
      if (at[k] == absent && (k == 0 ? has_u : k >= 4 || has_position)) {
        const std::string name = has_angles && k >= 4 ? angles->names()[k - 4] : short_names[k];
        return "the header names no column " + name + ": " + known_columns;
      }
      if (has_angles && k >= 4 && !is_unit_of(*angles, units[k])) {
        return "the header has the column " + names[k] + ", but euler_columns expects " +
               (angles->unit() == angle_unit::degree ? "degrees" : "radians");
      }
    }
    return {};
  }
};

/// Comment before the first row that seems to name the columns.
class commented_header {
public:
  void inspect(std::size_t line, std::string_view comment, const euler_columns* angles) {
    std::vector<std::string_view> cells;
    split_cells(comment, cells);
    if (cells.size() > 1 && cells[0].ends_with(':')) { // `columns: t x y z ...`
      cells.erase(cells.begin());
    }
    std::array<bool, 9> has{};
    for (const std::string_view cell : cells) {
      has[std::size_t(column_name(cell).what)] = true;
    }
    const auto has_angle = [&](const std::string& name) {
      return std::any_of(cells.begin(), cells.end(), [&](std::string_view cell) {
        return column_name(cell).name == column_name(name).name;
      });
    };
    const bool has_rotation =
        angles == nullptr ? has[4] && has[5] && has[6] && has[7]
                          : std::all_of(angles->names().begin(), angles->names().end(), has_angle);
    if (has_rotation ||
        (!is_certain_ && cells.size() > 1 && column_name(cells[0]).what == table_column::u)) {
      line_ = line;
      cells_.assign(cells.begin(), cells.end());
      is_certain_ = has_rotation;
    }
  }

  /// Layout that the comment gives to rows with this number of columns. Empty if the comment is not
  /// a header: its names or their number do not fit the rows, and no name contradicts the usual
  /// layout of such rows.
  ///
  /// \throws file_error if it is ambiguous
  [[nodiscard]] std::optional<table_layout> layout(const std::string& path, std::size_t columns,
                                                   bool has_u, bool has_position,
                                                   const euler_columns* angles,
                                                   const std::optional<table_layout>& usual) const {
    table_layout result;
    std::string problem;
    if (cells_.size() == columns) {
      const std::vector<std::string_view> header(cells_.begin(), cells_.end());
      problem = result.read(header, has_u, has_position, angles);
      if (problem.empty()) {
        return result;
      }
    } else if (is_certain_) {
      problem = "the comment names " + std::to_string(cells_.size()) +
                " columns, but the rows have " + std::to_string(columns);
    }
    if (problem.empty() || (usual && angles == nullptr && agrees_with(*usual))) {
      return std::nullopt;
    }
    raise(file_error(path, line_, problem));
  }

  /// Remark on a comment that could be a header of this number of columns, but is not; empty
  /// otherwise.
  [[nodiscard]] std::string remark(std::size_t columns) const {
    return is_certain_ || (columns > 0 && cells_.size() == columns)
               ? "the names in the comment of line " + std::to_string(line_) + " do not fit"
               : "";
  }

private:
  /// True if every known name is that of the column at its index. An unknown name may be of a
  /// scalar part, which must be in the usual column, or of four numbers in ambiguous order.
  [[nodiscard]] bool agrees_with(const table_layout& usual) const {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const column_name cell(cells_[i]);
      const std::string& name = cell.name;
      const bool is_w = name == "w" || name.ends_with("_w") || (name.size() == 2 && name[1] == 'w');
      const bool has_number =
          name.size() == 2 && name[0] == 'q' && name[1] >= '0' && name[1] <= '9';
      const table_column what =
          cell.what == table_column::other && is_w ? table_column::qw : cell.what;
      if (has_number || (what != table_column::other && usual.at[std::size_t(what)] != i)) {
        return false;
      }
    }
    return true;
  }

  std::size_t line_ = 0;
  std::vector<std::string> cells_;
  bool is_certain_ = false;
};

} // namespace duet::detail
