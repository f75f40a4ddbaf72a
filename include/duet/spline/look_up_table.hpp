// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/csv.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/orientations.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <vector>

/// \file
/// Look-up tables of rotations and poses, in memory and as files.

namespace duet {

/// Rotations (T = double) or poses (T = dual<double, 1, screw_tag>) at increasing parameters.
template <class T>
struct look_up_table {
  std::vector<real_type_t<T>> parameters;
  std::vector<quaternion<T>> elements;
};

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

/// Reads what `save_table` writes; a header and comments from `#` on are passed over.
/// \throws file_error with the line of a row that is ragged, not finite, not a unit or does not
/// follow the one before
template <class T>
[[nodiscard]] look_up_table<T> load_table(const std::string& path) {
  constexpr bool is_rotation = detail::is_rotation_scalar<T>;
  const csv_file file(path, is_rotation ? 5 : 8);
  look_up_table<T> table;
  std::vector<quaternion<double>> rotations;
  for (const csv_row& row : file.rows()) {
    const auto* q = &row.numbers[is_rotation ? 1 : 4];
    table.parameters.push_back(row.numbers[0]);
    rotations.emplace_back(q[0], q[1], q[2], q[3]);
  }
  try {
    detail::check_rows(table.parameters, rotations.size(), 0);
    static_cast<void>(unit_quaternions(rotations));
  } catch (const invalid_row& error) {
    throw file_error(path, file.rows()[error.row()].line, error.reason());
  }
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const quaternion<double> q = detail::unit_of_file(rotations[i]);
    if constexpr (is_rotation) {
      table.elements.push_back(q);
    } else {
      const auto& x = file.rows()[i].numbers;
      table.elements.push_back(pose(q, vector3<double>(x[1], x[2], x[3])));
    }
  }
  return table;
}

} // namespace duet
