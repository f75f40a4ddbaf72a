// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/core/text/file.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/io/tables/euler_columns.hpp>
#include <duet/io/tables/row_reader.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/lookup_table.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

/// \file
/// Files of rotations and poses: CSV, TUM, EuRoC, KITTI. Files that may have bad rows:
/// io/recording.hpp.

namespace duet {

/// File format in which a table is written. Reading detects it from the file.
enum class table_format {
  csv,         ///< `u,x,y,z,qw,qx,qy,qz`, for rotations `u,qw,qx,qy,qz`, under a header
  csv_seconds, ///< as `csv`, with `t [s]` for `u`: for recordings, whose parameters are times
  tum,         ///< `timestamp tx ty tz qx qy qz qw`, in seconds and metres
  euroc,       ///< `timestamp,x,y,z,qw,qx,qy,qz` under the data set's header, integer nanoseconds
  kitti        ///< matrix [R t] row by row, 12 numbers; the parameters in a separate file
};

namespace detail {

template <class T>
inline constexpr bool is_rotation_scalar = std::is_same_v<T, double>;

/// Scalar of the rotations or poses that T names: T is the scalar itself or a quaternion over it.
template <class T>
struct table_numbers {};
template <class T>
  requires(std::is_same_v<T, double> || std::is_same_v<T, screw_dual<double>>)
struct table_numbers<T> {
  using type = T;
};
template <class T>
struct table_numbers<quaternion<T>> : table_numbers<T> {};
template <class T>
using table_numbers_t = typename table_numbers<T>::type;

/// Rotation or pose of a row in a file, depending on T.
template <class T>
[[nodiscard]] quaternion<T> element_of(const table_row& row) {
  if constexpr (is_rotation_scalar<T>) {
    return row.rotation;
  } else {
    return pose(row.rotation, row.position);
  }
}

/// Name of the parameter column in CSV files.
[[nodiscard]] inline std::string parameter_name(table_format format) {
  return format == table_format::csv_seconds ? "t [s]" : "u";
}

[[nodiscard]] inline bool is_csv(table_format format) {
  return format == table_format::csv || format == table_format::csv_seconds;
}

[[nodiscard]] inline std::string blank_line(const std::vector<double>& numbers) {
  std::string line = csv_line(numbers);
  std::replace(line.begin(), line.end(), ',', ' ');
  return line;
}

/// Nearest integer number of nanoseconds, for times below 2^63 ns.
[[nodiscard]] inline std::int64_t nanoseconds_of(double seconds) {
  require(std::abs(seconds) < 9.2e9, "duet: save_table: the time ", to_text(seconds),
          " s is beyond 9.2e18 nanoseconds");
  const double integral = std::floor(seconds);
  return std::int64_t(integral) * 1'000'000'000 + std::llround((seconds - integral) * 1e9);
}

/// Header and rows of a file of poses.
[[nodiscard]] inline std::string text_of(const lookup_table<screw_dual<double>>& table,
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
[[nodiscard]] inline std::string text_of(const lookup_table<double>& table, table_format format) {
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
[[nodiscard]] inline bool is_same_file(const std::string& first, const std::string& second) {
  const auto real_path = [](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(link_target(path)));
  };
  return !is_written_directly(first) && !is_written_directly(second) &&
         real_path(first) == real_path(second);
}

} // namespace detail

/// Writes a lookup table of rotations or poses with all digits and independently of the locale.
/// Writes atomically: the complete file or nothing. `times` is written first, and remains if `path`
/// then cannot be written. Parameters are seconds in TUM and EuRoC files and in `csv_seconds`;
/// EuRoC files round them to integer nanoseconds, KITTI files have no parameters.
///
/// Read back, parameters and quaternions have the same bits, and positions differ by round-off, as
/// a dual quaternion holds half the product of both. For EuRoC files this holds for parameters from
/// 2^23 s on and for the nearest doubles to integer nanoseconds; KITTI matrices hold quaternions to
/// round-off, without their sign.
///
/// \param times  file for the parameters of KITTI's format, one a line; empty: not written
/// \throws invalid_input if the numbers of parameters and elements differ, for rotations in a
/// format of poses, for `times` with another format than KITTI's, and for times that EuRoC's format
/// cannot distinguish
/// \throws file_error if a file cannot be written, or if both are the same file
template <class T>
void save_table(const std::string& path, const lookup_table<T>& table,
                table_format format = table_format::csv, const std::string& times = {}) {
  detail::require(table.parameters.size() == table.elements.size(),
                  "duet: save_table: ", table.parameters.size(), " parameters for ",
                  table.elements.size(), " elements");
  detail::require(times.empty() || format == table_format::kitti,
                  "duet: save_table: only KITTI files have times in a separate file");
  const std::string text = detail::text_of(table, format);
  if (!times.empty()) {
    if (detail::is_same_file(times, path)) {
      detail::raise(file_error(path, "is the same file as " + times));
    }
    std::string column;
    for (const double u : table.parameters) {
      column += csv_line({u});
    }
    write_file(times, column);
  }
  write_file(path, text);
}

namespace detail {

template <class T>
[[nodiscard]] lookup_table<T> loaded_table(const std::string& path, const std::string& times,
                                           const euler_columns* angles) {
  lookup_table<T> table;
  for_each_table_row(path, times, !is_rotation_scalar<T>, angles, [&](const table_row& row) {
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

} // namespace detail

/// Reads a lookup table of rotations (T = double) or poses (T = screw_dual<double>) from any format
/// that `save_table` writes; `quaternion<double>` and `dual_quaternion<double>` are accepted for T,
/// too. Also reads files of `rostopic echo -p`, and semicolons instead of commas. Rotations are
/// read from files of poses, too, ignoring the positions. The format and the order of columns are
/// detected from a header (a first line or a comment) or the number of columns, see
/// io/tables/row_format.hpp.
///
/// Parameters are the doubles nearest to the seconds of the file, whatever its unit of time, with
/// positions in metres; columns named u or tau are taken as they are. (Doubles of seconds since
/// 1970 are 2.4e-7 s apart: `load_recording` keeps the digits.) Quaternions with norm 1 to
/// `unit_norm_tolerance` are normalised; matrices with R Rᵀ = 1 to `rotation_matrix_tolerance` are
/// replaced by the nearest rotation.
///
/// \param times  for KITTI files: a file with the time of each row, in seconds; without it, the
///               parameters are 0, 1, 2 …
/// \return `lookup_table<double>` or `lookup_table<screw_dual<double>>`
/// \throws file_error for a file without rows or with ambiguous columns; with line, column and
/// value for a row that is ragged, not finite, not a unit or rotation, or does not follow the one
/// before
template <class T>
[[nodiscard]] lookup_table<detail::table_numbers_t<T>> load_table(const std::string& path,
                                                                  const std::string& times = {}) {
  return detail::loaded_table<detail::table_numbers_t<T>>(path, times, nullptr);
}

/// Reads a lookup table whose rotations are Euler angles, in the given columns, sequence and unit.
/// Otherwise as above; the file needs a header.
///
/// \return `lookup_table<double>` or `lookup_table<screw_dual<double>>`
template <class T>
[[nodiscard]] lookup_table<detail::table_numbers_t<T>> load_table(const std::string& path,
                                                                  const euler_columns& angles) {
  return detail::loaded_table<detail::table_numbers_t<T>>(path, {}, &angles);
}

template <class T = void, class... More>
  requires(!requires { typename detail::table_numbers_t<T>; })
DUET_REFUSED("load_table<double> reads rotations, load_table<screw_dual<double>> poses")
lookup_table<double> load_table(const std::string&, const More&...);

} // namespace duet
