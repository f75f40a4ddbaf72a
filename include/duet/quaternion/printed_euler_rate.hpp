// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/quaternion/quaternion.hpp>

#include <cmath>

/// \file
/// A formula as the copy at hand of the paper has it, kept beside the true one of euler.hpp for
/// comparison.

namespace duet {

/// P5 as the copy at hand has it: the matrix A_K with ω = A_K [φ′, θ′, ψ′]ᵀ in spatial axes, for
/// R = R_z(ψ) R_y(θ) R_x(φ), **with a slip, of the copy or of the print**: its element (3, 1) reads
/// −sin ψ. Columns are axes of rotation, of length 1; with −sin ψ the first is not, so that no
/// sequence of Euler angles has this matrix.
///
/// The true one, −sin θ, is in `euler_rate_matrix<zyx>(psi, theta)`, whose columns are in the
/// order of the letters: ψ′, θ′, φ′. The two agree where sin ψ = sin θ.
/// Source: Houdek, Verlinden, Hajžman, "Derivatives of quaternion spline interpolation function for
/// multibody dynamics", equation (5).
template <class T>
[[nodiscard]] matrix3<T> printed_euler_rate_matrix(const T& psi, const T& theta) {
  using std::cos;
  using std::sin;
  const T zero(0);
  matrix3<T> a;
  a << cos(psi) * cos(theta), -sin(psi), zero, //
      sin(psi) * cos(theta), cos(psi), zero,   //
      -sin(psi), zero, T(1);
  return a;
}

} // namespace duet
