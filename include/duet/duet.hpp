// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// Everything in the headers of duet::duet except those that take long to compile or are rarely
/// needed, which programs include explicitly: the judge of handwritten Jacobians
/// (comparison/judge_jacobian.hpp), sparse Jacobians and Hessians (derivative/sparse.hpp),
/// kinematic trees (kinematics/tree_jacobian.hpp), loops of trees (kinematics/tree_loop.hpp),
/// distances of shapes (kinematics/closest_points.hpp), plans and trajectories of joints
/// (kinematics/motion_plan.hpp), sweeps over configurations (kinematics/sweep.hpp), chains of all
/// types as one type (kinematics/chain_view.hpp), chains with user-defined joints
/// (kinematics/joined_chain.hpp), fits (spline/fit.hpp), curves in the caller's
/// memory (spline/bspline_segment.hpp, quaternion/quaternion_order.hpp), split curves
/// (spline/split_bspline.hpp), CSV (core/text/csv.hpp), the planner of the lecture notes
/// (motion/printed_plan.hpp), the nearest pose on a screw motion (dual_quaternion/nearest.hpp),
/// formulas as data (expression/graph/trace.hpp, expression/graph/reverse.hpp), from text and as
/// text and LaTeX (expression/graph/read_formula.hpp, expression/graph/formula_from.hpp,
/// expression/graph/formula_text.hpp, expression/graph/formula_latex.hpp), their derivatives
/// (expression/graph/formula_derivative.hpp) and proofs of equality
/// (expression/graph/is_equal.hpp), their components, derivations and documents in LaTeX
/// (expression/graph/components.hpp, expression/graph/derivation.hpp,
/// expression/graph/document.hpp), formulas as code of C, C++, Python and MATLAB
/// (expression/code/c.hpp, expression/code/cpp.hpp, expression/code/python.hpp,
/// expression/code/matlab.hpp), chains and curves as formulas (kinematics/chain_formula.hpp,
/// spline/curve_formula.hpp), and `interop/`. The headers of the compiled libraries are in
/// duet/io.hpp and duet/robotics.hpp.

#include <duet/comparison/compare.hpp>
#include <duet/comparison/numeric_derivative.hpp>
#include <duet/comparison/rigid_motions.hpp>
#include <duet/comparison/rotations.hpp>
#include <duet/core/batch/evaluate_each.hpp>
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
#include <duet/derivative/nonlinear_least_squares.hpp>
#include <duet/derivative/scalar_type.hpp>
#include <duet/derivative/svd.hpp>
#include <duet/derivative/symmetric_eigen.hpp>
#include <duet/derivative/tangent_coordinates.hpp>
#include <duet/derivative/with_derivative.hpp>
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
#include <duet/kinematics/chain_parameters.hpp>
#include <duet/kinematics/constrained_mechanism.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/jacobian_rate.hpp>
#include <duet/kinematics/manipulability.hpp>
#include <duet/kinematics/robots.hpp>
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
#include <duet/spline/adaptive_table.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/evaluate.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/printed.hpp>
#include <duet/spline/rotation_vector_spline.hpp>
