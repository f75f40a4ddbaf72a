// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "table_rows.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/core/text/file_error.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace duet::detail {
namespace {

// Columns by their names in a header.

/// Contents of a column; `other` is ignored.
enum class table_column : std::size_t { u, x, y, z, qw, qx, qy, qz, nanosec, other };

constexpr const char* known_columns =
    "known columns are u (tau, t, time, timestamp; sec and nanosec), x y z (tx, px, p_x, p_RS_R_x "
    "...) and qw qx qy qz (q_w, q_RS_w ...), with units as in `t [s]`; Euler angles need "
    "`euler_columns`";

[[nodiscard]] bool is_any(std::string_view text, std::initializer_list<std::string_view> of) {
  return std::find(of.begin(), of.end(), text) != of.end();
}

/// Characters that separate the parts of a name.
constexpr std::string_view name_separators = "._/";

/// Name in a header, with its meaning and unit.
struct column_name {
  table_column what = table_column::other;
  bool is_a_time = false;   ///< `u` in seconds, or in a unit of time
  bool is_of_ros = false;   ///< time as `rostopic echo -p` writes it
  bool is_seconds = false;  ///< whole seconds, with nanoseconds in a column of their own
  bool is_arrival = false;  ///< time at which a program received the row
  bool is_measured = false; ///< time in the header of a message
  bool has_prefix = false;
  std::string text; ///< as in the header
  std::string name;
  std::string unit; ///< as written, empty if absent

  column_name() = default;

  /// \param prefix  removed from the name; without it, the name is read as a whole
  explicit column_name(std::string_view cell, std::string_view prefix = {}) : text(cell) {
    if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"') { // as spreadsheets write
      cell = cell.substr(1, cell.size() - 2);
    }
    has_prefix = cell.starts_with(prefix);
    if (has_prefix && !prefix.empty()) {
      cell.remove_prefix(
          std::min(cell.find_first_not_of(name_separators, prefix.size()), cell.size()));
    }
    const std::size_t bracket = std::min(cell.find_first_of("[("), cell.size());
    name = lower(trimmed(cell.substr(0, bracket)));
    std::replace_if(
        name.begin(), name.end(),
        [](char c) { return name_separators.find(c) != name_separators.npos; }, '_');
    if (bracket < cell.size()) {
      unit = lower(cell.substr(bracket + 1, cell.find_first_of("])", bracket) - bracket - 1));
    }
    what = meaning();
  }

private:
  [[nodiscard]] static std::string lower(std::string_view text) {
    std::string result(trimmed(text));
    for (char& c : result) {
      c = char(std::tolower(static_cast<unsigned char>(c)));
    }
    return result;
  }

  /// Column that the name denotes; also sets the kind of a time and its unit.
  [[nodiscard]] table_column meaning() {
    if (is_any(name, {"u", "tau"})) {
      return table_column::u;
    }
    is_of_ros = name == "%time" || name == "field_header_stamp";
    is_arrival = name == "%time" || name == "_"
                                            "_time"; // of rostopic and PlotJuggler
    is_measured = name.ends_with("header_stamp");
    is_a_time = is_time(name) || is_arrival || is_measured;
    if (is_a_time) {
      return table_column::u;
    }
    const std::size_t cut = name.rfind('_');
    const std::string last = name.substr(cut + 1), // npos + 1 is 0
        before = cut == std::string::npos ? "" : name.substr(0, cut);
    if (is_any(last, {"s", "ms", "us", "ns"}) && is_time(before) && unit.empty()) {
      unit = last; // timestamp_ns
      is_a_time = true;
      return table_column::u;
    }
    if (unit.empty() && (name == last || is_time(before) || before.ends_with("_stamp"))) {
      is_seconds = is_any(last, {"sec", "secs"});
      is_a_time = is_seconds || is_any(last, {"nanosec", "nanosecs", "nsec", "nsecs"});
      is_measured = before.ends_with("header_stamp");
      if (is_a_time) {
        return is_seconds ? table_column::u : table_column::nanosec;
      }
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
    return is_any(text, {"t", "time", "timestamp", "stamp"});
  }
};

/// Columns of the eight numbers of a row: u, x y z, qw qx qy qz, and of the nanoseconds beside u;
/// with Euler angles, three of them instead of the quaternion.
struct table_layout {
  static constexpr std::size_t absent = std::size_t(-1);
  static constexpr std::size_t nanosec = std::size_t(table_column::nanosec);

  std::array<std::size_t, 9> at;
  std::array<column_name, 9> names;
  std::size_t columns = 0;
  bool is_euroc = false;   ///< true if named as in the files of the EuRoC data set
  bool has_angles = false; ///< true for Euler angles instead of a quaternion
  std::string prefix;      ///< detected before the names of the columns, or empty

  table_layout() { at.fill(absent); }

  /// Reads a header. Without a stated prefix, and if columns are missing, it detects one.
  ///
  /// \param has_position  true if the rows must have positions
  /// \return problem with the header, empty if valid
  [[nodiscard]] std::string read(const std::vector<std::string_view>& header, bool has_position,
                                 const table_columns& stated) {
    std::string problem = read_below(stated.prefix, header, has_position, stated);
    if (problem.empty() || !stated.prefix.empty()) {
      return problem;
    }
    std::vector<table_layout> found;
    for (const std::string& each : prefixes(header, stated)) {
      table_layout layout;
      if (layout.read_below(each, header, has_position, stated).empty() &&
          std::none_of(found.begin(), found.end(),
                       [&](const table_layout& other) { return other.at == layout.at; })) {
        layout.prefix = each;
        found.push_back(layout);
      }
    }
    if (found.size() > 1) {
      return "the header has the columns of '" + found[0].prefix + "' and of '" + found[1].prefix +
             "' (expected one of them as `table_columns::prefix`)";
    }
    if (found.size() == 1 && !is_repeated) {
      *this = found[0];
      return {};
    }
    return problem;
  }

  /// Contradiction of the names of a header in the file with this stated layout, or an empty text.
  [[nodiscard]] std::string contradiction(const std::vector<std::string_view>& header,
                                          std::string_view below) const {
    for (std::size_t i = 0; i < header.size(); ++i) {
      const table_column what = column_name(header[i], below).what;
      const std::size_t k = std::size_t(what);
      if (what != table_column::other && (!has_angles || k < 4) && at[k] != absent && at[k] != i) {
        return "the file names column " + std::to_string(i + 1) + " '" + std::string(header[i]) +
               "', but the stated header has '" + names[k].text + "' in column " +
               std::to_string(at[k] + 1);
      }
    }
    return {};
  }

private:
  bool is_repeated = false; ///< true if two columns have the same meaning

  /// Prefixes of columns that may hold the last number of a rotation.
  [[nodiscard]] static std::vector<std::string>
  prefixes(const std::vector<std::string_view>& header, const table_columns& stated) {
    std::vector<std::string> result;
    if (header.size() > 1000) {
      return result; // a wider file needs a stated prefix, as the search is quadratic
    }
    const std::string last = stated.angles ? column_name(stated.angles->names()[2]).name : "w";
    for (const std::string_view cell : header) {
      if (!column_name(cell).name.ends_with(last)) {
        continue;
      }
      for (std::size_t cut = 0; (cut = cell.find_first_of(name_separators, cut + 1)) != cell.npos &&
                                result.size() < 100;) {
        const std::size_t begin = cell.front() == '"' ? 1 : 0;
        const std::string_view part = cell.substr(begin, cut + 1 - begin);
        if (std::find(result.begin(), result.end(), part) == result.end()) {
          result.emplace_back(part);
        }
      }
    }
    return result;
  }

  /// Reads the columns whose names begin with a prefix; times may be without it.
  ///
  /// \return problem with the header, empty if valid
  [[nodiscard]] std::string read_below(std::string_view below,
                                       const std::vector<std::string_view>& header,
                                       bool has_position, const table_columns& stated) {
    columns = header.size();
    has_angles = stated.angles.has_value();
    bool has_arrival = false, has_measured = false;
    for (const bool is_inside : {true, false}) {
      if (!is_inside && at[0] != absent) {
        break; // the time has the prefix, too
      }
      for (std::size_t i = 0; i < columns; ++i) {
        const column_name cell(header[i], below);
        const std::size_t k =
            stated.angles ? angle_column(*stated.angles, cell) : std::size_t(cell.what);
        const bool is_parameter = k == 0 || k == nanosec;
        if (k == std::size_t(table_column::other) || cell.has_prefix != is_inside ||
            (!is_inside && !is_parameter)) {
          continue;
        }
        // Messages of ROS have two times: that in their header is the time of the measurement.
        if (has_measured && cell.is_arrival) {
          continue;
        }
        if (has_arrival && cell.is_measured) {
          at[0] = absent;
        } else if (at[k] != absent) {
          is_repeated = true;
          return "the header has both '" + names[k].text + "' and '" + std::string(header[i]) + "'";
        }
        has_arrival = cell.is_arrival || (has_arrival && !is_parameter);
        has_measured = has_measured || cell.is_measured;
        at[k] = i;
        names[k] = cell;
        is_euroc = is_euroc || cell.name.starts_with("p_rs_");
      }
    }
    return missing(has_position, stated);
  }

  /// Index of a column of angles, which take the positions of the first three numbers of a
  /// quaternion.
  [[nodiscard]] static std::size_t angle_column(const euler_columns& angles,
                                                const column_name& cell) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (cell.name == column_name(angles.names()[k]).name) {
        return std::size_t(table_column::qw) + k;
      }
    }
    const bool is_of_quaternion = cell.what >= table_column::qw && cell.what <= table_column::qz;
    return std::size_t(is_of_quaternion ? table_column::other : cell.what);
  }

  [[nodiscard]] static bool is_unit_of(const euler_columns& angles, const std::string& unit) {
    return angles.unit() == angle_unit::degree
               ? is_any(unit, {"", "deg", "degree", "degrees", "\u00b0"})
               : is_any(unit, {"", "rad", "radian", "radians"});
  }

  /// Problem with the header: missing columns, or units of angles other than the given one.
  [[nodiscard]] std::string missing(bool has_position, const table_columns& stated) const {
    const std::optional<euler_columns>& angles = stated.angles;
    if (names[0].is_seconds != (at[nanosec] != absent)) {
      return "the header has '" + names[names[0].is_seconds ? 0 : nanosec].text +
             "', but names no column " + (names[0].is_seconds ? "nanosec" : "sec");
    }
    constexpr std::array<const char*, 8> short_names{"u", "x", "y", "z", "qw", "qx", "qy", "qz"};
    for (std::size_t k = 0; k < (has_angles ? 7 : 8); ++k) {
      if (at[k] == absent && (k == 0 || k >= 4 || has_position)) {
        const std::string name = angles && k >= 4 ? angles->names()[k - 4] : short_names[k];
        return "the header names no column " + name + ": " + known_columns;
      }
      if (has_angles && k >= 4 && !is_unit_of(*angles, names[k].unit)) {
        return "the header has the column " + names[k].text + ", but euler_columns expects " +
               (angles->unit() == angle_unit::degree ? "degrees" : "radians");
      }
    }
    return {};
  }
};

// Formats, as io/table_file.hpp describes them.

/// Format of the rows of a file.
struct row_format {
  table_layout layout;
  bool is_matrix = false;   ///< true for [R t] row by row, without the layout
  std::size_t digits = 0;   ///< times are in units of 10^−digits s
  std::string guessed_unit; ///< unit guessed from the size of times, which must then be integers
  std::string remark;       ///< assumptions about the format, empty if there were none
};

/// Name of the unit 10^−digits s of times, empty for seconds.
[[nodiscard]] std::string name_of_time_unit(std::size_t digits) {
  return digits == 9   ? "nanoseconds"
         : digits == 6 ? "microseconds"
         : digits == 3 ? "milliseconds"
                       : "";
}

/// Digits of the unit of times that no header names, guessed from the years 1973 to 5138. A number
/// with a fraction is in seconds, except one from 1e17 to 1e20, so that files of times in seconds
/// keep their unit when they are written and read again.
[[nodiscard]] std::size_t guessed_digits(std::string_view cell) {
  const double size = std::abs(parse_number(cell).value_or(0));
  return size >= 1e20                                            ? 0
         : size >= 1e17                                          ? 9
         : size < least_guessed_time || size != std::floor(size) ? 0
         : size >= 1e14                                          ? 6
                                                                 : 3;
}

/// Number of digits of a unit of time in a header: 9 for ns, 0 for s.
///
/// \throws file_error for an unknown unit
[[nodiscard]] std::size_t digits_of_time_unit(const std::string& path, std::size_t line,
                                              const std::string& unit) {
  const std::size_t digits = unit == "ns" ? 9 : unit == "us" ? 6 : unit == "ms" ? 3 : 0;
  if (digits == 0 && unit != "s" && unit != "sec" && unit != "seconds") {
    raise(file_error(path, line,
                     "the unit of timestamps is '" + unit + "' (expected s, ms, us or ns)"));
  }
  return digits;
}

// Numbers of rows.

/// Normalised quaternion. A quaternion that is a unit to round-off is returned unchanged, because
/// files preserve all digits.
[[nodiscard]] quaternion<double> unit_of_file(const quaternion<double>& q) {
  return std::abs(norm(q) - 1) <= 4e-16 ? q : normalized(q);
}

/// Reads the rotation nearest to a matrix.
///
/// \return problem with the matrix, empty if valid
[[nodiscard]] std::string read_rotation(const matrix3<double>& r, quaternion<double>& q) {
  const double defect = (r * r.transpose() - matrix3<double>::Identity()).cwiseAbs().maxCoeff();
  if (!(defect <= rotation_matrix_tolerance)) {
    return "the matrix is not a rotation: |R R^T - 1| = " + to_text(defect);
  }
  if (const double determinant = r.determinant(); determinant < 0) {
    return "the matrix is a reflection: det R = " + to_text(determinant);
  }
  const Eigen::JacobiSVD<matrix3<double>> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  q = normalized(from_rotation_matrix(matrix3<double>(svd.matrixU() * svd.matrixV().transpose())));
  return {};
}

/// Value of a number; 0 if the text is empty or the number nearer to 0 than any double.
[[nodiscard]] double number_of(std::string_view text) {
  double number = 0;
  static_cast<void>(read_number(text, number));
  return number;
}

/// Reads a file line by line.
class table_row_reader {
public:
  /// \param times_path    file of times, empty if times are in the rows
  /// \param has_position  true if rows must have positions
  /// \throws file_error for an invalid file of times, and for a stated header without all columns
  table_row_reader(std::string path, std::string times_path, bool has_position,
                   table_columns columns)
      : path_(std::move(path)), times_path_(std::move(times_path)), has_position_(has_position),
        columns_(std::move(columns)) {
    split_cells(columns_.header, cells_);
    if (!cells_.empty()) {
      stated_.emplace();
      if (const std::string problem = stated_->read(cells_, has_position_, columns_);
          !problem.empty()) {
        raise(file_error(path_, "stated columns: " + problem));
      }
    }
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
        inspect(line, parts.comment);
      }
      return std::nullopt;
    }
    split_cells(parts.text, cells_);
    if (is_begin && are_words(cells_)) {
      header_ = stated_ ? *stated_ : table_layout();
      if (const std::string problem = stated_ ? stated_->contradiction(cells_, columns_.prefix)
                                              : header_->read(cells_, has_position_, columns_);
          !problem.empty()) {
        fail(line, problem);
      }
      return std::nullopt;
    }
    if (!format_) {
      choose_format(line, parts.text.find_first_of(",;") != parts.text.npos);
    }
    if (cells_.size() != format_->layout.columns) {
      fail(line, std::to_string(format_->layout.columns) + " columns expected, got " +
                     std::to_string(cells_.size()));
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
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    raise(file_error(path_, line, what));
  }

  /// Time in the file of times.
  struct time_row {
    std::size_t line;
    file_time time;
  };

  /// Keeps a comment before the first row if it seems to name the columns.
  void inspect(std::size_t line, std::string_view comment) {
    std::vector<std::string_view> cells;
    split_cells(comment, cells);
    if (cells.size() > 1 && cells[0].ends_with(':')) { // `columns: t x y z ...`
      cells.erase(cells.begin());
    }
    std::array<bool, 10> has{};
    for (const std::string_view cell : cells) {
      has[std::size_t(column_name(cell, columns_.prefix).what)] = true;
    }
    const auto has_angle = [&](const std::string& name) {
      return std::any_of(cells.begin(), cells.end(), [&](std::string_view cell) {
        return column_name(cell, columns_.prefix).name == column_name(name).name;
      });
    };
    const bool has_rotation =
        (!columns_.angles ? has[4] && has[5] && has[6] && has[7]
                          : std::all_of(columns_.angles->names().begin(),
                                        columns_.angles->names().end(), has_angle)) ||
        table_layout().read(cells, false, columns_).empty();
    if (has_rotation || (!is_header_certain_ && cells.size() > 1 &&
                         column_name(cells[0]).what == table_column::u)) {
      comment_line_ = line;
      comment_.assign(cells.begin(), cells.end());
      is_header_certain_ = has_rotation;
    }
  }

  /// Layout that the comment gives to rows with as many columns as the first. Empty if the comment
  /// is not a header: its names or their number do not fit the rows, and no name contradicts the
  /// usual layout of such rows.
  ///
  /// \throws file_error if it is ambiguous
  [[nodiscard]] std::optional<table_layout>
  commented_layout(const std::optional<table_layout>& usual) const {
    table_layout result;
    std::string problem;
    if (comment_.size() == cells_.size()) {
      const std::vector<std::string_view> header(comment_.begin(), comment_.end());
      problem = result.read(header, has_position_, columns_);
      if (problem.empty()) {
        return result;
      }
    } else if (is_header_certain_) {
      problem = "the comment names " + std::to_string(comment_.size()) +
                " columns, but the rows have " + std::to_string(cells_.size());
    }
    if (problem.empty() || (usual && !columns_.angles && agrees_with(*usual))) {
      return std::nullopt;
    }
    fail(comment_line_, problem);
  }

  /// True if every known name is that of the column at its index. An unknown name may be of a
  /// scalar part, which must be in the usual column, or of four numbers in ambiguous order.
  [[nodiscard]] bool agrees_with(const table_layout& usual) const {
    for (std::size_t i = 0; i < comment_.size(); ++i) {
      const column_name cell(comment_[i]);
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

  /// Reads one time a line, in the unit of a header if there is one.
  void read_times() {
    std::optional<std::size_t> digits; // of the unit
    std::string guessed_unit;
    for_each_line(times_path_, [&](std::size_t line, std::string_view text) {
      split_cells(split_line(text).text, cells_);
      if (cells_.empty()) {
        return;
      }
      if (!digits && are_words(cells_)) {
        const std::string name = column_name(cells_[0]).unit;
        digits = name.empty() ? 0 : digits_of_time_unit(times_path_, line, name);
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
      if (!digits) {
        digits = guessed_digits(cells_[0]);
        guessed_unit = name_of_time_unit(*digits);
        times_remark_ = guessed_unit.empty() ? "" : "; times read as " + guessed_unit;
      }
      require_integer(times_path_, line, "time", number, guessed_unit);
      times_.push_back({line, file_time(cells_[0], *digits)});
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

  /// Layout of a first row of numbers: TUM's or EuRoC's, empty for others.
  [[nodiscard]] std::optional<table_layout> usual_layout(bool has_commas) const {
    if (cells_.size() != 8 || (has_commas && guessed_digits(cells_[0]) != 9)) {
      return std::nullopt;
    }
    table_layout result;
    static_cast<void>(
        has_commas
            ? result.read({"timestamp", "x", "y", "z", "qw", "qx", "qy", "qz"}, true, {})
            : result.read({"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"}, true, {}));
    return result;
  }

  /// Format of the first row, without a header.
  [[nodiscard]] row_format format_of_row(std::size_t line, bool has_commas) const {
    row_format result;
    if (cells_.size() == 12) {
      result.is_matrix = true;
      result.layout.columns = 12;
      result.remark = "12 columns: read as in KITTI files, the matrix [R t] row by row";
      return result;
    }
    const std::optional<table_layout> layout = usual_layout(has_commas);
    if (!layout) {
      fail(line, std::to_string(cells_.size()) +
                     " columns without a header before the first row (expected a header such as "
                     "`u,x,y,z,qw,qx,qy,qz`; TUM files, timestamp tx ty tz qx qy qz qw separated "
                     "by blanks, and KITTI files, 12 numbers, need none): " +
                     known_columns);
    }
    result = format_of_header(line, *layout);
    if (!result.remark.empty()) {
      result.remark = "timestamps in " + result.guessed_unit + ": read as " +
                      (has_commas ? "in EuRoC files, timestamp, x, y, z, qw, qx, qy, qz"
                                  : "timestamp tx ty tz qx qy qz qw");
    }
    return result;
  }

  /// Format by a header and the first row.
  [[nodiscard]] row_format format_of_header(std::size_t line, const table_layout& header) const {
    row_format result;
    result.layout = header;
    const std::string& unit = header.names[0].unit;
    if (header.names[0].is_a_time && !header.names[0].is_seconds && unit.empty()) {
      const std::string_view first = header.at[0] < cells_.size() ? cells_[header.at[0]] : "";
      const bool is_of_ros = header.names[0].is_of_ros && first.find_first_of(".eE") == first.npos;
      result.digits = header.is_euroc || is_of_ros ? 9 : guessed_digits(first);
      result.guessed_unit = name_of_time_unit(result.digits);
      if (result.digits > 0) {
        result.remark = header.is_euroc ? "a EuRoC file: timestamps in nanoseconds"
                        : is_of_ros
                            ? header.names[0].text + " as rostopic writes it, in nanoseconds"
                            : "timestamps of this size are taken for " + result.guessed_unit;
      }
    } else if (header.names[0].is_a_time && !header.names[0].is_seconds) {
      result.digits = digits_of_time_unit(path_, line, unit);
      if (result.digits > 0) {
        result.remark =
            std::string(header.is_euroc ? "a EuRoC file: " : "") + "timestamps in " + unit;
      }
    }
    if (!header.prefix.empty()) {
      result.remark = "columns of '" + header.prefix + "'" +
                      (result.remark.empty() ? "" : "; " + result.remark);
    }
    for (std::size_t k = 1; has_position_ && k < 4; ++k) {
      if (!header.names[k].unit.empty() && header.names[k].unit != "m") {
        fail(line, "the unit of positions is '" + header.names[k].unit + "' (expected m)");
      }
    }
    return result;
  }

  void choose_format(std::size_t line, bool has_commas) {
    if (!header_ && stated_) {
      const std::vector<std::string_view> names(comment_.begin(), comment_.end());
      const std::string problem = stated_->contradiction(names, columns_.prefix);
      if (is_header_certain_ && names.size() == stated_->columns && !problem.empty()) {
        fail(comment_line_, problem);
      }
      header_ = stated_;
    } else if (!header_) {
      header_ = commented_layout(usual_layout(has_commas));
    }
    if (!header_ && columns_.angles) {
      fail(line, "there is no header before the first row (expected names of the columns of "
                 "angles)");
    }
    format_ = header_ ? format_of_header(line, *header_) : format_of_row(line, has_commas);
    if (!header_ && (is_header_certain_ || comment_.size() == cells_.size())) {
      format_->remark += (format_->remark.empty() ? "" : "; ") +
                         std::string("the names in the comment of line ") +
                         std::to_string(comment_line_) + " do not fit";
    }
    if (!times_path_.empty() && !format_->is_matrix) {
      fail(line, "the rows have times, and so does " + times_path_);
    }
  }

  void read_columns(table_row& row) const {
    const table_layout& layout = format_->layout;
    std::array<double, 9> x{};
    for (std::size_t k = 0; k < 9; ++k) {
      if (layout.at[k] != table_layout::absent) {
        note(row, read_cell(path_, row.line, layout.names[k].text, cells_[layout.at[k]], x[k]));
      }
    }
    if (!row.issue.empty()) {
      return;
    }
    const quaternion<double> q = layout.has_angles ? columns_.angles->rotation({x[4], x[5], x[6]})
                                                   : quaternion<double>(x[4], x[5], x[6], x[7]);
    if (const double length = norm(q); !(std::abs(length - 1) <= unit_norm_tolerance)) {
      row.issue = "the quaternion of " + layout.names[4].text + ", " + layout.names[5].text + ", " +
                  layout.names[6].text + ", " + layout.names[7].text + " has norm " +
                  to_text(length) + ", not 1";
      return;
    }
    if (layout.names[0].is_seconds) {
      read_seconds(row, x[0], x[8]);
    } else {
      require_integer(path_, row.line, layout.names[0].text, x[0], format_->guessed_unit);
      row.time = file_time(cells_[layout.at[0]], format_->digits);
    }
    row.position = {x[1], x[2], x[3]};
    row.rotation = unit_of_file(q);
  }

  /// Time of two columns, added as integers.
  void read_seconds(table_row& row, double seconds, double nanoseconds) const {
    const auto require_between = [&](std::size_t k, double x, double least, double most) {
      if (x != std::floor(x) || x < least || x > most) {
        note(row, format_->layout.names[k].text + " is " +
                      std::string(cells_[format_->layout.at[k]]) + " (expected an integer from " +
                      to_text(least) + " to " + to_text(most) + ")");
      }
    };
    require_between(0, seconds, -9e9, 9e9);
    require_between(8, nanoseconds, 0, 999'999'999);
    if (row.issue.empty()) {
      row.time = file_time(
          std::to_string(std::int64_t(seconds) * 1'000'000'000 + std::int64_t(nanoseconds)), 9);
    }
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
      fail(row.line,
           "more rows than the " + std::to_string(times_.size()) + " times of " + times_path_);
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
  table_columns columns_;
  std::optional<table_layout> stated_; ///< layout of the stated header, if there is one
  std::vector<time_row> times_;
  std::string times_remark_;
  std::optional<table_layout> header_;
  // Comment before the first row that seems to name the columns.
  std::vector<std::string> comment_;
  std::size_t comment_line_ = 0;
  bool is_header_certain_ = false;
  std::optional<row_format> format_;
  std::size_t row_count_ = 0;
  std::vector<std::string_view> cells_;
};

} // namespace

DUET_ABI_BEGIN

file_time::file_time(std::string_view cell, std::size_t digits) {
  cell = trimmed(cell);
  const double sign = cell.starts_with('-') ? -1 : 1;
  if (cell.starts_with('-') || cell.starts_with('+')) {
    cell.remove_prefix(1);
  }
  const std::size_t e = std::min(cell.find_first_of("eE"), cell.size());
  const double exponent = number_of(cell.substr(std::min(e + 1, cell.size())));
  std::string all(cell.substr(0, e)); // digits, without the decimal point
  const std::size_t point = std::min(all.find('.'), all.size());
  all.erase(point, 1);
  const int power = int(std::clamp(exponent, -1e9, 1e9)) - int(digits + all.size() - point);
  const std::string scale = "e" + std::to_string(power);
  const std::size_t cut = all.size() - std::min(all.size(), std::size_t(std::max(-power, 0)));
  seconds_ = sign * number_of(all + scale);
  integral_ = sign * number_of("0" + all.substr(0, cut) + (power > 0 ? scale : ""));
  fraction_ = sign * number_of("0" + all.substr(cut) + scale);
}

std::string for_each_table_row(const std::string& path, const std::string& times_path,
                               bool has_position, const table_columns& columns,
                               const std::function<void(const table_row&)>& row) {
  table_row_reader reader(path, times_path, has_position, columns);
  for_each_line(path, [&](std::size_t line, std::string_view text) {
    if (const std::optional<table_row> r = reader.read(line, text)) {
      row(*r);
    }
  });
  reader.finish();
  return reader.remark();
}

DUET_ABI_END
} // namespace duet::detail
