// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/text/file.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/orientations.hpp>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

/// \file
/// Files of rotations and poses: CSV, TUM, EuRoC, KITTI. Files that may have bad rows:
/// io/recording.hpp. The format of a file is detected from
///
/// - a header, a first line of names or a comment before the first row: columns by their names,
///   others ignored. A comment counts if its names and their number fit the columns. Times are in
///   the unit given there, in nanoseconds in files with the names of the EuRoC data set, else in
///   seconds; integers that as seconds would be later than the year 5000 are read as milliseconds
///   (from 1e11 on), microseconds (1e14) or nanoseconds (1e17). Times of rostopic (%time, or
///   field.header.stamp if present) are nanoseconds if they are integers, seconds if they have a
///   decimal point, as it prints them. Columns sec and nanosec (secs, nsecs, header.stamp.sec ...)
///   hold one time together. Columns u and tau are not times and are read unchanged;
/// - 8 numbers separated by blanks: TUM's `timestamp tx ty tz qx qy qz qw`, times by the same rule;
/// - 8 numbers separated by commas, the first 1e17 or more: EuRoC's `timestamp,x,y,z,qw,qx,qy,qz`.
///   Smaller ones are rejected, as w may be first or last (likewise with semicolons instead of
///   commas);
/// - a header that the program states as `table_columns`, for any order of columns;
/// - 12 numbers: KITTI's matrix [R t], row by row; the time is the row's index from 0 on, or in a
///   file of times.

namespace duet {
DUET_ABI_BEGIN

/// File format in which a table is written. Reading detects it from the file.
enum class table_format {
  csv,         ///< `u,x,y,z,qw,qx,qy,qz`, for rotations `u,qw,qx,qy,qz`, under a header
  csv_seconds, ///< as `csv`, with `t [s]` for `u`: for recordings, whose parameters are times
  tum,         ///< `timestamp tx ty tz qx qy qz qw`, in seconds and metres
  euroc,       ///< `timestamp,x,y,z,qw,qx,qy,qz` under the data set's header, integer nanoseconds
  kitti        ///< matrix [R t] row by row, 12 numbers; the parameters in a separate file
};

/// Unit of angles in a file.
enum class angle_unit {
  radian, ///< radian, as everywhere else in duet
  degree  ///< degree, 180 to π
};

/// Columns of a file that hold intrinsic Euler angles, with their sequence and unit.
///
/// Example, for an aircraft's log: `euler_columns(zyx, {"yaw", "pitch", "roll"},
/// angle_unit::degree)`
class euler_columns {
public:
  /// \param sequence  axes of the moving body, rotated about one after the other (intrinsic)
  /// \param names     names of the columns with the angles about these axes, in the same order
  /// \param unit      unit of the angles
  /// \throws invalid_input for an invalid sequence, and for names that are empty or equal
  euler_columns(euler_sequence sequence, std::array<std::string, 3> names, angle_unit unit);

  /// Names of the columns, in the order of the sequence.
  [[nodiscard]] const std::array<std::string, 3>& names() const { return names_; }
  /// Unit of the angles.
  [[nodiscard]] angle_unit unit() const { return unit_; }
  /// Rotation by angles in this unit, in the order of the sequence: R_first R_second R_third.
  [[nodiscard]] quaternion<double> rotation(const std::array<double, 3>& angles) const;

private:
  euler_sequence sequence_;
  std::array<std::string, 3> names_;
  angle_unit unit_;
};

/// Columns of a file, stated by the program where the file does not name them in full.
///
/// Example, for rows without a header: `table_columns{.header = "t x y z qx qy qz qw"}`
struct table_columns {
  /// Names of all columns in their order, as a header of the file would have them; other names for
  /// columns to ignore. Empty: names of the file.
  std::string header = {};
  /// Beginning of the names of one pose among several in the file, as `left.pose`; times may be
  /// without it. Empty: detected if the names are complete for one prefix alone.
  std::string prefix = {};
  /// Columns of Euler angles instead of a quaternion; empty: quaternions or matrices.
  std::optional<euler_columns> angles = {};
};

/// Tolerance for R Rᵀ = 1 of a matrix in a file, entry by entry; loose, as files are printed with
/// few digits.
inline constexpr double rotation_matrix_tolerance = 1e-3;

DUET_ABI_END
} // namespace duet

namespace duet::detail {
DUET_ABI_BEGIN

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

/// \throws as `save_table`
void write_table(const std::string& path, const lookup_table<double>& table, table_format format,
                 const std::string& times);
void write_table(const std::string& path, const lookup_table<screw_dual<double>>& table,
                 table_format format, const std::string& times);

/// \throws as `load_table`
template <class T>
[[nodiscard]] lookup_table<T> loaded_table(const std::string& path, const std::string& times,
                                           const table_columns& columns);
extern template lookup_table<double> loaded_table(const std::string&, const std::string&,
                                                  const table_columns&);
extern template lookup_table<screw_dual<double>>
loaded_table(const std::string&, const std::string&, const table_columns&);

DUET_ABI_END
} // namespace duet::detail

namespace duet {
DUET_ABI_BEGIN

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
/// \param times  file for the parameters of KITTI's format, one a line, below `t [s]` if the first
/// would be read as another unit by its size; empty: not written
/// \throws invalid_input if the numbers of parameters and elements differ, for rotations in a
/// format of poses, for `times` with another format than KITTI's, and for times that EuRoC's format
/// cannot distinguish
/// \throws file_error if a file cannot be written, or if both are the same file
template <class T>
void save_table(const std::string& path, const lookup_table<T>& table,
                table_format format = table_format::csv, const std::string& times = {}) {
  detail::write_table(path, table, format, times);
}

/// Reads a lookup table of rotations (T = double) or poses (T = screw_dual<double>) from any format
/// that `save_table` writes; `quaternion<double>` and `dual_quaternion<double>` are accepted for T,
/// too. Also reads files of `rostopic echo -p`, and semicolons instead of commas. Rotations are
/// read from files of poses, too, ignoring the positions. The format and the order of columns are
/// detected as the beginning of io/table_file.hpp says.
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
                                                                  std::string_view times = {}) {
  return detail::loaded_table<detail::table_numbers_t<T>>(path, std::string(times), {});
}

/// Reads a lookup table whose columns are stated: by a header for a file without one, a prefix of
/// their names, or Euler angles. Otherwise as above.
///
/// \return `lookup_table<double>` or `lookup_table<screw_dual<double>>`
/// \throws file_error as above, for a stated header without all columns, and for one with another
/// order than the names in the file
template <class T>
[[nodiscard]] lookup_table<detail::table_numbers_t<T>> load_table(const std::string& path,
                                                                  const table_columns& columns) {
  return detail::loaded_table<detail::table_numbers_t<T>>(path, {}, columns);
}

/// Reads a lookup table whose rotations are Euler angles, in the given columns, sequence and unit.
/// Otherwise as above; the file needs a header.
///
/// \return `lookup_table<double>` or `lookup_table<screw_dual<double>>`
template <class T>
[[nodiscard]] lookup_table<detail::table_numbers_t<T>> load_table(const std::string& path,
                                                                  const euler_columns& angles) {
  return detail::loaded_table<detail::table_numbers_t<T>>(path, {}, {.angles = angles});
}

template <class T = void, class... More>
  requires(!requires { typename detail::table_numbers_t<T>; })
DUET_REFUSED("load_table<double> reads rotations, load_table<screw_dual<double>> poses")
lookup_table<double> load_table(const std::string&, const More&...);

DUET_ABI_END
} // namespace duet
