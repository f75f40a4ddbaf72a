// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// Everything in duet except headers that take long to compile or are rarely needed, which programs
/// include explicitly: sparse Jacobians and Hessians (derivative/sparse.hpp), robot descriptions
/// (io/urdf.hpp, io/srdf.hpp, io/mesh_file.hpp), kinematic trees (kinematics/tree_jacobian.hpp,
/// kinematics/centre_of_mass.hpp, kinematics/tree_limits.hpp), closed chains (io/loop_file.hpp,
/// robotics/loop_positions.hpp, robotics/loop_trace.hpp, robotics/mobility.hpp), sweeps over
/// configurations (kinematics/sweep.hpp), fits (spline/fit.hpp), all solutions of inverse
/// kinematics (robotics/all_inverse_kinematics.hpp, robotics/differentiable_branch.hpp,
/// robotics/self_motion_curves.hpp), partial goals, objectives and start configurations
/// (robotics/goals.hpp, robotics/choose_start.hpp), self-collision
/// pairs and bounding capsules (robotics/pairs_apart.hpp, robotics/bounding_capsules.hpp), time
/// parametrisation (robotics/time_parametrised.hpp), tables, recordings and plans as files
/// (io/table_file.hpp, io/recording.hpp, io/save_plan.hpp, core/text/csv.hpp), the planner of the
/// lecture notes (motion/printed_plan.hpp), the nearest pose on a screw motion
/// (dual_quaternion/nearest.hpp), and `interop/`.

#include <duet/comparison/compare.hpp>
#include <duet/comparison/numeric_derivative.hpp>
#include <duet/comparison/rotations.hpp>
#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/core/parallel_for.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/core/text/result_text.hpp>
#include <duet/core/version.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/implicit_function.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/least_squares.hpp>
#include <duet/derivative/linear_solve.hpp>
#include <duet/derivative/matrix_exponential.hpp>
#include <duet/derivative/nearest_rotation.hpp>
#include <duet/derivative/second_order.hpp>
#include <duet/derivative/svd.hpp>
#include <duet/derivative/symmetric_eigen.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/dual/complex.hpp>
#include <duet/dual/dynamic_dual.hpp>
#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual_quaternion/distance.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/exponential_jacobian.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/dual_quaternion/register_points.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/expression/condition.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/functions_of_many.hpp>
#include <duet/expression/gradient.hpp>
#include <duet/expression/jacobian.hpp>
#include <duet/expression/matrix.hpp>
#include <duet/expression/motion.hpp>
#include <duet/expression/rotation_matrix.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/special_functions.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/expression/text.hpp>
#include <duet/kinematics/adapted.hpp>
#include <duet/kinematics/analytic_jacobian.hpp>
#include <duet/kinematics/closed_loop.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/jacobian_rate.hpp>
#include <duet/kinematics/joint_efforts.hpp>
#include <duet/kinematics/limits.hpp>
#include <duet/kinematics/manipulability.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/kinematics/screw_axes.hpp>
#include <duet/quaternion/average.hpp>
#include <duet/quaternion/curves.hpp>
#include <duet/quaternion/distance.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/plan_screw_motion.hpp>
#include <duet/spline/adaptive_table.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/evaluate.hpp>
#include <duet/spline/hermite.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/lookup_table.hpp>
#include <duet/spline/printed.hpp>
#include <duet/spline/rotation_vector_spline.hpp>
