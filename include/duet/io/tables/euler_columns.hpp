// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <array>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

/// \file
/// Euler angles in files: their columns, sequence and unit, which headers do not state.

namespace duet {

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
  euler_columns(euler_sequence sequence, std::array<std::string, 3> names, angle_unit unit)
      : sequence_(sequence), names_(std::move(names)), unit_(unit) {
    const auto is_axis = [](int i) { return i >= 0 && i < 3; };
    detail::require(is_axis(sequence.first) && is_axis(sequence.second) &&
                        is_axis(sequence.third) && sequence.first != sequence.second &&
                        sequence.second != sequence.third,
                    "duet: euler_columns: the axes are ", sequence.first, ", ", sequence.second,
                    ", ", sequence.third, " (expected 0, 1 or 2 each, neighbours different)");
    for (std::size_t i = 0; i < 3; ++i) {
      detail::require(!names_[i].empty() && names_[i] != names_[(i + 1) % 3],
                      "duet: euler_columns: the columns of two angles are '", names_[i], "' and '",
                      names_[(i + 1) % 3], "' (expected three different names)");
    }
  }

  /// Names of the columns, in the order of the sequence.
  [[nodiscard]] const std::array<std::string, 3>& names() const { return names_; }
  /// Unit of the angles.
  [[nodiscard]] angle_unit unit() const { return unit_; }
  /// Rotation by angles in this unit, in the order of the sequence: R_first R_second R_third.
  [[nodiscard]] quaternion<double> rotation(const std::array<double, 3>& angles) const {
    const double size = unit_ == angle_unit::degree ? std::numbers::pi / 180 : 1;
    return detail::axis_rotation(sequence_.first, size * angles[0]) *
           detail::axis_rotation(sequence_.second, size * angles[1]) *
           detail::axis_rotation(sequence_.third, size * angles[2]);
  }

private:
  euler_sequence sequence_;
  std::array<std::string, 3> names_;
  angle_unit unit_;
};

} // namespace duet
