// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/errors.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/io/table_file.hpp>

#include "table_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace duet::detail {
namespace {

/// Name of the parameter column in CSV files.
[[nodiscard]] std::string parameter_name(table_format format) {
  return format == table_format::csv_seconds ? "t [s]" : "u";
}

[[nodiscard]] bool is_csv(table_format format) {
  return format == table_format::csv || format == table_format::csv_seconds;
}

[[nodiscard]] std::string blank_line(const std::vector<double>& numbers) {
  std::string line = csv_line(numbers);
  std::replace(line.begin(), line.end(), ',', ' ');
  return line;
}

/// Nearest integer number of nanoseconds, for times below 2^63 ns.
[[nodiscard]] std::int64_t nanoseconds_of(double seconds) {
  require(std::abs(seconds) < 9.2e9, "duet: save_table: the time ", to_text(seconds),
          " s is beyond 9.2e18 nanoseconds");
  const double integral = std::floor(seconds);
  return std::int64_t(integral) * 1'000'000'000 + std::llround((seconds - integral) * 1e9);
}

/// Header and rows of a file of poses.
[[nodiscard]] std::string text_of(const lookup_table<screw_dual<double>>& table,
                                  table_format format) {
  std::string text;
  if (format == table_format::tum) {
    text = "# timestamp [s] tx [m] ty [m] tz [m] qx qy qz qw\n";
  } else if (format == table_format::euroc) {
    text = "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
           "q_RS_z []\n";
  } else if (is_csv(format)) {
    text = parameter_name(format) + ",x,y,z,qw,qx,qy,qz\n";
  }
  std::int64_t last = 0;
  for (std::size_t i = 0; i < table.parameters.size(); ++i) {
    const double u = table.parameters[i];
    const auto x = pose_coordinates(table.elements[i]);
    if (is_csv(format)) {
      text += csv_line({u, x[0], x[1], x[2], x[3], x[4], x[5], x[6]});
    } else if (format == table_format::tum) {
      text += blank_line({u, x[0], x[1], x[2], x[4], x[5], x[6], x[3]});
    } else if (format == table_format::euroc) {
      const std::int64_t now = nanoseconds_of(u);
      require(i == 0 || now > last, "duet: save_table: sample ", i, " at ", to_text(u),
              " s is less than a nanosecond after the sample before");
      last = now;
      text += std::to_string(now) + "," + csv_line({x[0], x[1], x[2], x[3], x[4], x[5], x[6]});
    } else {
      const Eigen::Matrix4d m = transform_matrix(table.elements[i]);
      std::vector<double> numbers;
      for (Eigen::Index k = 0; k < 12; ++k) {
        numbers.push_back(m(k / 4, k % 4));
      }
      text += blank_line(numbers);
    }
  }
  return text;
}
[[nodiscard]] std::string text_of(const lookup_table<double>& table, table_format format) {
  require(is_csv(format),
          "duet: save_table: TUM, EuRoC and KITTI files hold poses, not rotations alone");
  std::string text = parameter_name(format) + ",qw,qx,qy,qz\n";
  for (std::size_t i = 0; i < table.parameters.size(); ++i) {
    const quaternion<double>& q = table.elements[i];
    text += csv_line({table.parameters[i], q.w(), q.x(), q.y(), q.z()});
  }
  return text;
}

/// True if two paths lead to one file, existing or not; false for devices and pipes.
[[nodiscard]] bool is_same_file(const std::string& first, const std::string& second) {
  const auto real_path = [](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(link_target(path)));
  };
  return !is_written_directly(first) && !is_written_directly(second) &&
         real_path(first) == real_path(second);
}

template <class T>
void write_any_table(const std::string& path, const lookup_table<T>& table, table_format format,
                     const std::string& times) {
  require(table.parameters.size() == table.elements.size(),
          "duet: save_table: ", table.parameters.size(), " parameters for ", table.elements.size(),
          " elements");
  require(times.empty() || format == table_format::kitti,
          "duet: save_table: only KITTI files have times in a separate file");
  const std::string text = text_of(table, format);
  if (!times.empty()) {
    if (is_same_file(times, path)) {
      raise(file_error(path, "is the same file as " + times));
    }
    // Numbers that would be read as another unit by their size are below a header with theirs.
    const bool needs_unit =
        !table.parameters.empty() && std::abs(table.parameters.front()) >= least_guessed_time;
    std::string column = needs_unit ? "t [s]\n" : "";
    for (const double u : table.parameters) {
      column += csv_line({u});
    }
    write_file(times, column);
  }
  write_file(path, text);
}

} // namespace

DUET_ABI_BEGIN

void write_table(const std::string& path, const lookup_table<double>& table, table_format format,
                 const std::string& times) {
  write_any_table(path, table, format, times);
}

void write_table(const std::string& path, const lookup_table<screw_dual<double>>& table,
                 table_format format, const std::string& times) {
  write_any_table(path, table, format, times);
}

template <class T>
lookup_table<T> loaded_table(const std::string& path, const std::string& times,
                             const table_columns& columns) {
  lookup_table<T> table;
  for_each_table_row(path, times, !std::is_same_v<T, double>, columns, [&](const table_row& row) {
    if (!row.issue.empty()) {
      raise(file_error(path, row.line, row.issue));
    }
    const double u = row.time.seconds();
    if (!table.parameters.empty() && !(u > table.parameters.back())) {
      raise(file_error(path, row.line,
                       "parameter " + to_text(u) + " does not increase, the row before has " +
                           to_text(table.parameters.back())));
    }
    table.parameters.push_back(u);
    table.elements.push_back(detail::element_of<T>(row));
  });
  if (table.parameters.empty()) {
    raise(file_error(path, "holds no rows"));
  }
  return table;
}
template lookup_table<double> loaded_table(const std::string&, const std::string&,
                                           const table_columns&);
template lookup_table<screw_dual<double>> loaded_table(const std::string&, const std::string&,
                                                       const table_columns&);

DUET_ABI_END
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

euler_columns::euler_columns(euler_sequence sequence, std::array<std::string, 3> names,
                             angle_unit unit)
    : sequence_(sequence), names_(std::move(names)), unit_(unit) {
  const auto is_axis = [](int i) { return i >= 0 && i < 3; };
  detail::require(is_axis(sequence.first) && is_axis(sequence.second) && is_axis(sequence.third) &&
                      sequence.first != sequence.second && sequence.second != sequence.third,
                  "duet: euler_columns: the axes are ", sequence.first, ", ", sequence.second, ", ",
                  sequence.third, " (expected 0, 1 or 2 each, neighbours different)");
  for (std::size_t i = 0; i < 3; ++i) {
    detail::require(!names_[i].empty() && names_[i] != names_[(i + 1) % 3],
                    "duet: euler_columns: the columns of two angles are '", names_[i], "' and '",
                    names_[(i + 1) % 3], "' (expected three different names)");
  }
}

quaternion<double> euler_columns::rotation(const std::array<double, 3>& angles) const {
  const double size = unit_ == angle_unit::degree ? std::numbers::pi / 180 : 1;
  return detail::axis_rotation(sequence_.first, size * angles[0]) *
         detail::axis_rotation(sequence_.second, size * angles[1]) *
         detail::axis_rotation(sequence_.third, size * angles[2]);
}

DUET_ABI_END
} // namespace duet
