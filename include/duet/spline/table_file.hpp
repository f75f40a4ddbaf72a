// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/look_up_table.hpp>
#include <duet/spline/table_rows.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <vector>

/// \file
/// Look-up tables of rotations and poses as files.

namespace duet {
namespace detail {

template <class T>
inline constexpr bool is_rotation_scalar = std::is_same_v<T, double>;

/// Files keep all digits, so what is a unit to rounding stays as it is.
[[nodiscard]] inline quaternion<double> unit_of_file(const quaternion<double>& q) {
  return std::abs(norm(q) - 1) <= 4e-16 ? q : normalized(q);
}

} // namespace detail

/// Writes a table as CSV: `u,qw,qx,qy,qz`, of poses `u,x,y,z,qw,qx,qy,qz`, with all digits and
/// independently of the locale; the whole file or none.
/// \throws file_error
template <class T>
void save_table(const std::string& path, const look_up_table<T>& table) {
  constexpr bool is_rotation = detail::is_rotation_scalar<T>;
  std::string text = is_rotation ? "u,qw,qx,qy,qz\n" : "u,x,y,z,qw,qx,qy,qz\n";
  for (std::size_t i = 0; i < table.parameters.size(); ++i) {
    std::vector<double> numbers{table.parameters[i]};
    const quaternion<T>& q = table.elements[i];
    if constexpr (is_rotation) {
      for (const double x : {q.w(), q.x(), q.y(), q.z()}) {
        numbers.push_back(x);
      }
    } else {
      const auto x = pose_coordinates(q);
      numbers.insert(numbers.end(), x.begin(), x.end());
    }
    text += csv_line(numbers);
  }
  write_file(path, text);
}

/// Reads what `save_table` writes, and tables whose header, a first line or a comment, names the
/// columns in another order or in other words: `# timestamp tx ty tz qx qy qz qw`. The numbers are
/// taken as they are, whatever units the header has; columns of other names are passed over.
/// \throws file_error for a file without a header, as nothing else tells qw first from qw last, or
/// with one in doubt; with the line of a row that is ragged, not finite, not a unit or does not
/// follow the one before
template <class T>
[[nodiscard]] look_up_table<T> load_table(const std::string& path) {
  constexpr bool is_rotation = detail::is_rotation_scalar<T>;
  look_up_table<T> table;
  const auto start = [&](std::size_t line, const auto&, const auto& header, bool) {
    if (!header) {
      throw file_error(path, line,
                       std::string("no header before the first row says which column is "
                                   "which, as `") +
                           (is_rotation ? "u,qw,qx,qy,qz" : "u,x,y,z,qw,qx,qy,qz") +
                           "` does: " + detail::known_columns);
    }
    return *header;
  };
  detail::for_each_table_row(
      path, true, !is_rotation, start,
      [&](std::size_t line, const std::array<double, 8>& x, const std::string& fault) {
        if (!fault.empty()) {
          throw file_error(path, line, fault);
        }
        const quaternion<double> q(x[4], x[5], x[6], x[7]);
        if (const double length = norm(q); !(std::abs(length - 1) <= unit_norm_tolerance)) {
          throw file_error(path, line,
                           "the quaternion has norm " + to_text(length) +
                               ", not 1: are its columns what the header says?");
        }
        if (!table.parameters.empty() && !(x[0] > table.parameters.back())) {
          throw file_error(path, line,
                           "parameter " + to_text(x[0]) +
                               " does not increase, the row before has " +
                               to_text(table.parameters.back()));
        }
        table.parameters.push_back(x[0]);
        if constexpr (is_rotation) {
          table.elements.push_back(detail::unit_of_file(q));
        } else {
          table.elements.push_back(
              pose(detail::unit_of_file(q), vector3<double>(x[1], x[2], x[3])));
        }
      });
  if (table.parameters.empty()) {
    throw file_error(path, "holds no rows");
  }
  return table;
}

} // namespace duet
