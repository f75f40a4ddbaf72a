// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "accuracy/jet.hpp"

/// \file
/// Definitions of the tested functions, as functions of lists of numbers.

namespace duet_test::accuracy::oracle {

// Functions of dual quaternions, eight numbers each, real part first.
jets dual_exp(const jets& x);
jets dual_log(const jets& x);
jets dual_pow(const jets& x);
jets sclerp(const jets& x);
jets screw_parameters(const jets& x);
jets from_screw(const jets& x);
jets translation(const jets& x);
jets transform_point(const jets& x);
jets adjoint(const jets& x);
jets spatial_twist(const jets& x);
jets body_twist(const jets& x);
jets pose_jacobian(const jets& x);
jets pose_jacobian_inverse(const jets& x);

// Functions of quaternions and vectors.
jets vector_exp(const jets& x);
jets log(const jets& x);
jets pow(const jets& x);
jets slerp(const jets& x);
jets rotation_vector(const jets& x);
jets from_axis_angle(const jets& x);
jets from_two_vectors(const jets& x);
jets rotate(const jets& x);
jets rotation_matrix(const jets& x);
jets jacobian(const jets& x);
jets jacobian_inverse(const jets& x);
jets spatial_velocity(const jets& x);
jets body_velocity(const jets& x);
/// Euler angles in the sequence of these axes, 0 = x, 1 = y, 2 = z.
jets euler(const jets& x, const std::array<std::size_t, 3>& axes);
jets euler_rate_zyx(const jets& x);

/// Quaternion of a 3 × 3 matrix, stored by columns.
jets inverse_of_three(const jets& m);

} // namespace duet_test::accuracy::oracle
