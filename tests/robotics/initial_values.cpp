// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/comparison/judge_jacobian.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/dual_quaternion/nearest.hpp>
#include <duet/duet.hpp>
#include <duet/io.hpp>
#include <duet/kinematics/chain_formula.hpp>
#include <duet/kinematics/joined_chain.hpp>
#include <duet/motion/printed_plan.hpp>
#include <duet/robotics.hpp>
#include <duet/spline/fit.hpp>
#include <duet/spline/split_bspline.hpp>

#include <Eigen/Core>

#include <cstring>
#include <new>

// No public aggregate keeps the previous contents of memory: each is default-initialized, as by
// `T x;`, on memory that is filled with a pattern. house/initial_values finds those that are
// missing here; equation_goal holds the user's function alone.

namespace test_robotics_initial_values {

struct anything {
  template <class T>
  operator T() const;
};

namespace {

using namespace duet;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using twist = Eigen::Matrix<double, 6, 1>;
using curve = cumulative_bspline<double, 4>;

constexpr unsigned char pattern = 0xA7;

template <class T, class... Field>
consteval int field_count() {
  if constexpr (requires { T{Field{}..., anything{}}; }) {
    return field_count<T, Field..., anything>();
  } else {
    return sizeof...(Field);
  }
}

/// True if any number in x, or in a field of x, has the previous contents of memory.
template <class T>
bool is_uninitialized(T& x) {
  const auto any = [](auto&... field) { return (is_uninitialized(field) || ...); };
  if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_pointer_v<T>) {
    const auto* const bytes = reinterpret_cast<const unsigned char*>(&x);
    return std::all_of(bytes, bytes + sizeof(T), [](unsigned char b) { return b == pattern; });
  } else if constexpr (requires { T::SizeAtCompileTime; }) {
    return std::any_of(x.data(), x.data() + x.size(), [](auto& e) { return is_uninitialized(e); });
  } else if constexpr (requires { x.block(x.size()); }) {
    bool result = false;
    for (int i = 0; i < x.size(); ++i) {
      auto block = x.block(i);
      result = result || is_uninitialized(block);
    }
    return result;
  } else if constexpr (requires { std::tuple_size<T>::value; }) {
    return std::any_of(x.begin(), x.end(), [](auto& e) { return is_uninitialized(e); });
  } else if constexpr (std::is_aggregate_v<T>) {
    constexpr int n = field_count<T>();
    static_assert(n <= 9);
    if constexpr (n == 1) {
      auto& [a] = x;
      return any(a);
    } else if constexpr (n == 2) {
      auto& [a, b] = x;
      return any(a, b);
    } else if constexpr (n == 3) {
      auto& [a, b, c] = x;
      return any(a, b, c);
    } else if constexpr (n == 4) {
      auto& [a, b, c, d] = x;
      return any(a, b, c, d);
    } else if constexpr (n == 5) {
      auto& [a, b, c, d, e] = x;
      return any(a, b, c, d, e);
    } else if constexpr (n == 6) {
      auto& [a, b, c, d, e, f] = x;
      return any(a, b, c, d, e, f);
    } else if constexpr (n == 7) {
      auto& [a, b, c, d, e, f, g] = x;
      return any(a, b, c, d, e, f, g);
    } else if constexpr (n == 8) {
      auto& [a, b, c, d, e, f, g, h] = x;
      return any(a, b, c, d, e, f, g, h);
    } else if constexpr (n == 9) {
      auto& [a, b, c, d, e, f, g, h, i] = x;
      return any(a, b, c, d, e, f, g, h, i);
    }
    return false;
  } else {
    return false; // a class with constructors
  }
}

template <class T>
bool is_initialized() {
  alignas(T) static unsigned char memory[sizeof(T)];
  std::memset(memory, pattern, sizeof(T));
  T* const x = new (memory) T;
  const bool has_values = !is_uninitialized(*x);
  x->~T();
  return has_values;
}

struct without_value {
  Vector3d direction;
  int count = 0;
};

TEST_CASE("default-initialized aggregates have the documented default values") {
  CHECK_FALSE(is_initialized<without_value>());

#define DUET_CHECK(...) CHECK_MESSAGE((is_initialized<__VA_ARGS__>()), #__VA_ARGS__)
  DUET_CHECK(comparison_options);
  DUET_CHECK(jacobian_options);
  DUET_CHECK(jacobian_judgement);
  DUET_CHECK(jacobian_slip);
  DUET_CHECK(jacobian_counterexample);
  DUET_CHECK(worst_errors);
  DUET_CHECK(counterexample);
  DUET_CHECK(comparison);
  DUET_CHECK(real_numbers);
  DUET_CHECK(vectors<3>);
  DUET_CHECK(arrays<2, real_numbers>);
  DUET_CHECK(derivative_and_error<double>);
  DUET_CHECK(derivative_and_error<Vector3d>);
  DUET_CHECK(rotations);
  DUET_CHECK(quaternions);
  DUET_CHECK(rigid_motions);
  DUET_CHECK(execution);
  DUET_CHECK(progress);
  DUET_CHECK(csv_row);
  DUET_CHECK(value_and_derivative<Vector3d, Vector3d>);
  DUET_CHECK(value_and_gradient<double, Vector3d>);
  DUET_CHECK(value_gradient_and_hessian<double, Vector3d, Matrix3d>);
  DUET_CHECK(newton_options);
  DUET_CHECK(loss_function);
  DUET_CHECK(nonlinear_least_squares_options);
  DUET_CHECK(nonlinear_least_squares_result<Vector3d>);
  DUET_CHECK(value_and_jacobian<Vector3d, Matrix3d>);
  DUET_CHECK(value_gradient_and_product<double, Vector3d>);
  DUET_CHECK(value_and_mixed_hessian<double, Matrix3d>);
  DUET_CHECK(symmetric_eigen_result<Vector3d, Matrix3d>);
  DUET_CHECK(singular_value_decomposition<Matrix3d, Vector3d, Matrix3d>);
  DUET_CHECK(scaled_pose<double>);
  DUET_CHECK(nearest_result<double>);
  DUET_CHECK(plane<double>);
  DUET_CHECK(screw_motion<double>);
  DUET_CHECK(constrained_mechanism_options);
  DUET_CHECK(collision_box);
  DUET_CHECK(collision_cylinder);
  DUET_CHECK(collision_capsule);
  DUET_CHECK(collision_sphere);
  DUET_CHECK(collision_mesh);
  DUET_CHECK(collision_shape);
  DUET_CHECK(euler_sequence);
  DUET_CHECK(dh_row<double>);
  DUET_CHECK(jacobian_and_rate<Matrix3d>);
  DUET_CHECK(placement<double>);
  DUET_CHECK(joint_limits<double>);
  DUET_CHECK(joint<double>);
  DUET_CHECK(custom_joint<std::identity>);
  DUET_CHECK(attached_frame<double>);
  DUET_CHECK(relative_frame);
  DUET_CHECK(driven_motion_options);
  DUET_CHECK(assembly_configuration);
  DUET_CHECK(assembly_search_result);
  DUET_CHECK(assembly_search_options);
  DUET_CHECK(dead_point);
  DUET_CHECK(branch_point);
  DUET_CHECK(motion_trace);
  DUET_CHECK(trace_options);
  DUET_CHECK(triangle_mesh);
  DUET_CHECK(mobility_result);
  DUET_CHECK(link_inertia);
  DUET_CHECK(tree_link);
  DUET_CHECK(joint_mimic);
  DUET_CHECK(tree_joint);
  DUET_CHECK(robot_description);
  DUET_CHECK(constraint_frame);
  DUET_CHECK(loop_constraint);
  DUET_CHECK(loop_constraints);
  DUET_CHECK(urdf_joint);
  DUET_CHECK(urdf_unknown_element);
  DUET_CHECK(urdf_summary);
  DUET_CHECK(link_pair);
  DUET_CHECK(urdf_link);
  DUET_CHECK(inverse_kinematics_solution);
  DUET_CHECK(all_inverse_kinematics_result);
  DUET_CHECK(bounding_capsules_result);
  DUET_CHECK(collision_pair);
  DUET_CHECK(scene);
  DUET_CHECK(chain_clearance<double>);
  DUET_CHECK(proximity<double>);
  DUET_CHECK(inverse_kinematics_options);
  DUET_CHECK(inverse_kinematics_result);
  DUET_CHECK(joint_state<Vector3d>);
  DUET_CHECK(pose_error);
  DUET_CHECK(plan_options);
  DUET_CHECK(motion_plan);
  DUET_CHECK(preferred_posture<Vector3d>);
  DUET_CHECK(twist_constraint);
  DUET_CHECK(task_space_region);
  DUET_CHECK(printed_plan_options);
  DUET_CHECK(self_motion_options);
  DUET_CHECK(self_motion_curve);
  DUET_CHECK(sphere<double>);
  DUET_CHECK(box<double>);
  DUET_CHECK(half_space<double>);
  DUET_CHECK(start_options);
  DUET_CHECK(start_search_result);
  DUET_CHECK(time_parametrisation_options);
  DUET_CHECK(adaptive_table_options);
  DUET_CHECK(clamped<>);
  DUET_CHECK(clamped<twist>);
  DUET_CHECK(end_acceleration<>);
  DUET_CHECK(fully_clamped<>);
  DUET_CHECK(fit_options);
  DUET_CHECK(chain_formula_options);
  DUET_CHECK(motion_covariance<double, 3>);
  DUET_CHECK(interpolation_report);
  DUET_CHECK(span_hint);
  DUET_CHECK(lookup_table<double>);
  DUET_CHECK(bspline_span<4, double>);
  DUET_CHECK(knot_jacobian_result<double, 4>);
  DUET_CHECK(curve_jacobian<double, 4, 3, body_frame>);
  DUET_CHECK(point_jacobian_result<double, 4>);
  DUET_CHECK(split_jacobian<double, 4, 3, body_frame>);
  DUET_CHECK(motion<double>);
  DUET_CHECK(motion<dual<double, 1, screw_tag>>);
  DUET_CHECK(printed_derivatives<double>);
  DUET_CHECK(recording_issue);
  DUET_CHECK(table_columns);
  DUET_CHECK(recording<double>);
  DUET_CHECK(lane_mask<double, 4>);
#undef DUET_CHECK

  // These cannot be made without values.
  static_assert(!std::is_default_constructible_v<capsule<double>>);
  static_assert(!std::is_default_constructible_v<collision_body>);
  static_assert(!std::is_default_constructible_v<pose_tolerance>);
  static_assert(!std::is_default_constructible_v<joint_screw<double>>);
  static_assert(!std::is_default_constructible_v<curve_ends<double>>);
  static_assert(!std::is_default_constructible_v<adaptive_table_result<curve>>);
  static_assert(!std::is_default_constructible_v<fit_result<curve>>);
  static_assert(!std::is_default_constructible_v<manipulability_objective<serial_chain<7>>>);
}

TEST_CASE("default values of ends, shapes and planes are as documented") {
  const std::vector<double> u = {0, 1, 2, 3};
  const std::vector<quaternion<double>> q = {
      from_rotation_vector(Vector3d(0, 0, 0)), from_rotation_vector(Vector3d(.2, 0, .1)),
      from_rotation_vector(Vector3d(.3, .2, .1)), from_rotation_vector(Vector3d(.3, .3, 0))};
  const auto at_rest = interpolate<cumulative_bspline<double>>(u, q, clamped{});
  CHECK(at_rest.motion(0.0, frame::spatial).velocity.norm() < 1e-14);
  CHECK(at_rest.motion(3.0, frame::spatial).velocity.norm() < 1e-14);

  const capsule<> body({1, 0, 2}, {1, 0, 3}, .5);
  CHECK(closest_points(body, half_space<>{}).distance == doctest::Approx(1.5));
  CHECK(closest_points(body, sphere<>{.radius = .25}).distance ==
        doctest::Approx(std::sqrt(5.) - .75));
  CHECK(closest_points(body, box<>{.half_extents = {.5, .5, .5}}).distance ==
        doctest::Approx(std::hypot(.5, 1.5) - .5));
  CHECK(plane<double>{}.normal == Vector3d(0, 0, 1));
  CHECK(progress{}.share() == 1);
}

} // namespace
} // namespace test_robotics_initial_values
