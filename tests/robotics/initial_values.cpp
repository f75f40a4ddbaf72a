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

/// Checks each, and names it.
template <class... T>
void check() {
  const auto check_one = []<class U>(const U*) {
    INFO(static_cast<const char*>(__PRETTY_FUNCTION__));
    CHECK(is_initialized<U>());
  };
  (check_one(static_cast<const T*>(nullptr)), ...);
}

struct without_value {
  Vector3d direction;
  int count = 0;
};

TEST_CASE("default-initialized aggregates have the documented default values") {
  CHECK_FALSE(is_initialized<without_value>());

  check<comparison_options, jacobian_options, jacobian_judgement, jacobian_slip,
        jacobian_counterexample, worst_errors, counterexample, comparison, real_numbers, vectors<3>,
        arrays<2, real_numbers>, derivative_and_error<double>, derivative_and_error<Vector3d>,
        rotations, quaternions, rigid_motions, execution, progress, csv_row,
        value_and_derivative<Vector3d, Vector3d>, value_and_gradient<double, Vector3d>,
        value_gradient_and_hessian<double, Vector3d, Matrix3d>, newton_options, loss_function,
        nonlinear_least_squares_options, nonlinear_least_squares_result<Vector3d>,
        value_and_jacobian<Vector3d, Matrix3d>, value_gradient_and_product<double, Vector3d>,
        value_and_mixed_hessian<double, Matrix3d>, symmetric_eigen_result<Vector3d, Matrix3d>,
        singular_value_decomposition<Matrix3d, Vector3d, Matrix3d>, scaled_pose<double>,
        nearest_result<double>, plane<double>, screw_motion<double>, constrained_mechanism_options,
        collision_box, collision_cylinder, collision_capsule, collision_sphere, collision_mesh,
        collision_shape, euler_sequence, dh_row<double>, jacobian_and_rate<Matrix3d>,
        placement<double>, joint_limits<double>, joint<double>, custom_joint<std::identity>,
        attached_frame<double>, relative_frame, driven_motion_options, assembly_configuration,
        assembly_search_result, assembly_search_options, dead_point, branch_point, motion_trace,
        trace_options, triangle_mesh, mobility_result, link_inertia, tree_link, joint_mimic,
        tree_joint, robot_description, constraint_frame, loop_constraint, loop_constraints,
        urdf_joint, urdf_unknown_element, urdf_summary, link_pair, urdf_link,
        inverse_kinematics_solution, all_inverse_kinematics_result, bounding_capsules_result,
        collision_pair, scene, chain_clearance<double>, proximity<double>,
        inverse_kinematics_options, inverse_kinematics_result, joint_state<Vector3d>, pose_error,
        plan_options, motion_plan, preferred_posture<Vector3d>, twist_constraint, task_space_region,
        printed_plan_options, self_motion_options, self_motion_curve, sphere<double>, box<double>,
        half_space<double>, start_options, start_search_result, time_parametrisation_options,
        adaptive_table_options, clamped<>, clamped<twist>, end_acceleration<>, fully_clamped<>,
        fit_options, chain_formula_options, motion_covariance<double, 3>, interpolation_report,
        span_hint, lookup_table<double>, bspline_span<4, double>, knot_jacobian_result<double, 4>,
        curve_jacobian<double, 4, 3, body_frame>, point_jacobian_result<double, 4>,
        split_jacobian<double, 4, 3, body_frame>, motion<double>,
        motion<dual<double, 1, screw_tag>>, printed_derivatives<double>, recording_issue,
        table_columns, recording<double>, lane_mask<double, 4>>();

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
