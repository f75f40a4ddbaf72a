// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/core/errors.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/goals.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>

namespace duet {
namespace {

using detail::components, detail::require;

/// \throws invalid_input for a vector that is not a unit vector
void require_unit(const vector3<double>& n, const char* function, const auto&... name) {
  require(std::abs(n.squaredNorm() - 1) <= 1e-6, "duet: ", function, ": the ", name..., " (", n[0],
          ", ", n[1], ", ", n[2], ") is not a unit vector");
}

/// A vector that is orthogonal to a unit vector.
[[nodiscard]] vector3<double> orthogonal_to(const vector3<double>& n) {
  int smallest = 0;
  n.cwiseAbs().minCoeff(&smallest);
  return n.cross(vector3<double>::Unit(smallest));
}

/// Goal at a position, with a rotation that takes one unit vector to another: a half turn about
/// their bisector.
[[nodiscard]] task_space_region pointing_at(const char* function, const vector3<double>& position,
                                            const vector3<double>& from, const vector3<double>& to,
                                            double tilt) {
  require_unit(from, function, "axis");
  require_unit(to, function, "direction");
  vector3<double> bisector = from + to;
  if (!(bisector.norm() > 1e-8)) { // opposite vectors: any orthogonal one
    bisector = orthogonal_to(from);
  }
  bisector.normalize();
  auto result = free_axis_goal(
      pose(quaternion<double>(0, bisector[0], bisector[1], bisector[2]), position), from);
  result.max_tilt = tilt;
  return result;
}

/// Sets a row of `twist_constraint`: lower ≤ n·ω ≤ upper.
void constrain_rotation(twist_constraint& constraint, Eigen::Index row, const vector3<double>& n,
                        double lower, double upper) {
  constraint.matrix.block<1, 3>(row, 3) = n.transpose();
  constraint.lower[row] = lower;
  constraint.upper[row] = upper;
}

/// Constrains the rotation that takes an axis a of the tip to b, exactly or to within `max_tilt`.
void constrain_axis(twist_constraint& constraint, const vector3<double>& a,
                    const vector3<double>& b, double tilt) {
  const vector3<double> across = a.cross(b), any = orthogonal_to(a), t = any / any.norm();
  const double sine = across.norm(), angle = std::atan2(sine, a.dot(b));
  const vector3<double> u = sine > 0 ? vector3<double>(across / sine) : t;
  if (tilt > 0) {
    // The angle grows by −u·ω.
    constrain_rotation(constraint, 3, -u, -std::numeric_limits<double>::infinity(), tilt - angle);
    return;
  }
  const vector3<double> s = a.cross(t);
  constrain_rotation(constraint, 3, t, angle * u.dot(t), angle * u.dot(t));
  constrain_rotation(constraint, 4, s, angle * u.dot(s), angle * u.dot(s));
}

} // namespace

DUET_ABI_BEGIN

task_space_region position_goal(const vector3<double>& position) {
  return {.frame = pose(quaternion<double>(1), position),
          .max_tilt = std::numbers::pi,
          .rotation_lower = -std::numbers::pi,
          .rotation_upper = std::numbers::pi};
}

task_space_region pose_goal(const dual_quaternion<double>& a, const pose_tolerance& tolerance) {
  const double side = tolerance.translation / std::sqrt(3),
               angle = tolerance.rotation / std::sqrt(2);
  detail::require(side >= 0 && angle >= 0 && side - side == 0 && angle - angle == 0,
                  "duet: pose_goal: the tolerance is ", tolerance.translation, ", ",
                  tolerance.rotation, " (expected finite numbers, not negative)");
  return {.frame = a,
          .lower = {-side, -side, -side},
          .upper = {side, side, side},
          .max_tilt = angle,
          .rotation_lower = -angle,
          .rotation_upper = angle};
}

task_space_region free_axis_goal(const dual_quaternion<double>& a, const vector3<double>& axis) {
  return {.frame = a,
          .axis = components(axis),
          .rotation_lower = -std::numbers::pi,
          .rotation_upper = std::numbers::pi};
}

task_space_region pointing_goal(const vector3<double>& axis, const vector3<double>& direction,
                                double tilt) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  auto result = pointing_at("pointing_goal", {0, 0, 0}, axis, direction, tilt);
  result.lower = {-infinity, -infinity, -infinity};
  result.upper = {infinity, infinity, infinity};
  return result;
}

task_space_region position_and_pointing_goal(const vector3<double>& position,
                                             const vector3<double>& axis,
                                             const vector3<double>& direction, double tilt) {
  return pointing_at("position_and_pointing_goal", position, axis, direction, tilt);
}

twist_constraint task_space_region::constraint(const dual_quaternion<double>& tip) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double pi = std::numbers::pi;
  twist_constraint result;
  const quaternion<double> r = rotation(frame);
  const matrix3<double> axes = rotation_matrix(r);
  const vector3<double> at = axes.transpose() * (translation(tip) - translation(frame));
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double from = lower[std::size_t(i)], to = upper[std::size_t(i)];
    if (from > -infinity || to < infinity) {
      result.matrix.block<1, 3>(i, 0) = axes.col(i).transpose();
      result.lower[i] = from - at[i];
      result.upper[i] = to - at[i];
    }
  }
  const vector3<double> n(axis[0], axis[1], axis[2]);
  const vector3<double> a = rotate(rotation(tip), n), b = rotate(r, n);
  if (max_tilt < pi) {
    constrain_axis(result, a, b, max_tilt);
  }
  const double range = rotation_upper - rotation_lower;
  if (range < 2 * pi) {
    // With R = s t, t a rotation about n and s one about an axis orthogonal to it, the angle of t
    // is that of the quaternion's component along n, and grows by (a + b)·ω / (1 + a·b).
    const quaternion<double> q = conj(r) * rotation(tip);
    const double angle = 2 * std::atan2(n.dot(vector3<double>(q.x(), q.y(), q.z())), q.w());
    const double centre = rotation_lower + range / 2;
    const double nearest = centre + std::remainder(angle - centre, 2 * pi);
    constrain_rotation(result, 5, (a + b) / std::max(1 + a.dot(b), 1e-9), rotation_lower - nearest,
                       rotation_upper - nearest);
  }
  return result;
}

double task_space_region::distance_from(const vector3<double>& point) const {
  const vector3<double> at =
      rotation_matrix(rotation(frame)).transpose() * (point - translation(frame));
  vector3<double> outside;
  for (Eigen::Index i = 0; i < 3; ++i) {
    outside[i] = at[i] - std::clamp(at[i], lower[std::size_t(i)], upper[std::size_t(i)]);
  }
  return outside.norm();
}

DUET_ABI_END
namespace detail {
DUET_ABI_BEGIN

void require_goal(const task_space_region& r, const std::string& name) {
  require_pose(r.frame, "inverse_kinematics", "the frame of " + name);
  for (std::size_t i = 0; i < 3; ++i) {
    require(r.upper[i] - r.lower[i] >= 0, "duet: inverse_kinematics: ", name, " goes from ",
            r.lower[i], " to ", r.upper[i], " along axis ", i,
            " of its frame (expected lower <= upper)");
  }
  require_unit(components(r.axis), "inverse_kinematics", "axis of ", name);
  require(r.max_tilt >= 0, "duet: inverse_kinematics: max_tilt of ", name, " is ", r.max_tilt,
          " (expected a non-negative number)");
  require(r.rotation_upper - r.rotation_lower >= 0,
          "duet: inverse_kinematics: the rotation angle of ", name, " goes from ", r.rotation_lower,
          " to ", r.rotation_upper, " (expected lower <= upper)");
}

goal_view::goal_view(const dual_quaternion<double>& goal)
    : pose(&goal),
      check([&goal](const std::string& name) { require_pose(goal, "inverse_kinematics", name); }) {}

DUET_ABI_END
} // namespace detail
} // namespace duet
