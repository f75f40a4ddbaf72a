// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/pose.hpp>
#include <duet/io/table_file.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>

/// \file
/// Rows of files of rotations or poses of any format.

namespace duet::detail {
DUET_ABI_BEGIN

/// Smallest time without a unit that may be read as another unit than seconds.
inline constexpr double least_guessed_time = 1e11;

/// Time in seconds. Adjacent doubles for seconds since 1970 differ by 2.4e-7 s, so the integer and
/// the fractional part are stored as well: differences of times have all digits of the file.
class file_time {
public:
  explicit file_time(double seconds = 0)
      : seconds_(seconds), integral_(std::trunc(seconds)), fraction_(seconds - integral_) {}

  /// Time in a cell that holds a finite number, decimal or with an exponent, in units of 10^−digits
  /// s. The decimal point is moved in the text, because divisions round.
  file_time(std::string_view cell, std::size_t digits);

  /// Nearest double, in seconds.
  [[nodiscard]] double seconds() const { return seconds_; }
  /// Seconds since another time, to 1e-16 s and round-off; since 0 the nearest double.
  [[nodiscard]] double since(const file_time& start) const {
    return start.seconds_ == 0 ? seconds_
                               : (integral_ - start.integral_) + (fraction_ - start.fraction_);
  }
  [[nodiscard]] bool operator<(const file_time& other) const {
    return integral_ < other.integral_ ||
           (integral_ == other.integral_ && fraction_ < other.fraction_);
  }

private:
  double seconds_ = 0, integral_ = 0, fraction_ = 0;
};

/// Row of a file.
struct table_row {
  std::size_t line = 0;
  std::string issue; ///< problem with the row; if empty, the other fields are valid
  file_time time;
  vector3<double> position = vector3<double>::Zero();
  quaternion<double> rotation{1};
};

/// Rotation or pose of a row in a file, depending on T.
template <class T>
[[nodiscard]] quaternion<T> element_of(const table_row& row) {
  if constexpr (std::is_same_v<T, double>) {
    return row.rotation;
  } else {
    return pose(row.rotation, row.position);
  }
}

/// Calls row(r) for every `table_row` of a file.
///
/// \return assumptions about the format, empty if there were none
/// \throws file_error as `table_row_reader`
std::string for_each_table_row(const std::string& path, const std::string& times_path,
                               bool has_position, const table_columns& columns,
                               const std::function<void(const table_row&)>& row);

DUET_ABI_END
} // namespace duet::detail
