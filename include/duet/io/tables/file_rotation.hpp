// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/text/number_text.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>
#include <string>

/// \file
/// Rotations in files: quaternions with all digits, and matrices printed with few.

namespace duet {

/// Tolerance for R Rᵀ = 1 of a matrix in a file, entry by entry; loose, as files are printed with
/// few digits.
inline constexpr double rotation_matrix_tolerance = 1e-3;

} // namespace duet

namespace duet::detail {

/// Normalised quaternion. A quaternion that is a unit to round-off is returned unchanged, because
/// files preserve all digits.
[[nodiscard]] inline quaternion<double> unit_of_file(const quaternion<double>& q) {
  return std::abs(norm(q) - 1) <= 4e-16 ? q : normalized(q);
}

/// Reads the rotation nearest to a matrix, by Newton's method for the polar factor, R ← ½(R + R⁻ᵀ):
/// from `rotation_matrix_tolerance` three steps reach round-off.
///
/// \return problem with the matrix, empty if valid
[[nodiscard]] inline std::string read_rotation(matrix3<double> r, quaternion<double>& q) {
  const double defect = (r * r.transpose() - matrix3<double>::Identity()).cwiseAbs().maxCoeff();
  if (!(defect <= rotation_matrix_tolerance)) {
    return "the matrix is not a rotation: |R R^T - 1| = " + to_text(defect);
  }
  if (const double determinant = r.determinant(); determinant < 0) {
    return "the matrix is a reflection: det R = " + to_text(determinant);
  }
  for (int step = 0; step < 3; ++step) {
    r = (r + r.inverse().transpose().eval()) / 2;
  }
  q = normalized(from_rotation_matrix(r));
  return {};
}

} // namespace duet::detail
