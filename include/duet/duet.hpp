// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// All of duet but `interop/`.

#include <duet/comparison/compare.hpp>
#include <duet/comparison/numeric_derivative.hpp>
#include <duet/core/number_text.hpp>
#include <duet/core/version.hpp>
#include <duet/derivative/chunked.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/implicit_function.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/least_squares.hpp>
#include <duet/derivative/linear_solve.hpp>
#include <duet/derivative/second_order.hpp>
#include <duet/derivative/symmetric_eigen.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/dual/complex.hpp>
#include <duet/dual/dynamic_dual.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual_quaternion/distance.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/exponential_jacobian.hpp>
#include <duet/dual_quaternion/nearest.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/dual_quaternion/wrench.hpp>
#include <duet/quaternion/average.hpp>
#include <duet/quaternion/curves.hpp>
#include <duet/quaternion/domain.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/printed_euler_rate.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/tangent.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/printed.hpp>
