// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>

/// \file
/// Goals in part: positions, directions, regions of poses.

namespace duet {

/// What a goal asks of a tip that stands at some pose: the twists ξ = [v; ω] of it, in
/// `frame::hybrid`, that take it to the goal to first order, least ≤ M ξ ≤ most. The first three
/// rows count lengths, the others radians; rows that are zero ask for nothing.
struct wanted_twist {
  Eigen::Matrix<double, 6, 6> rows = Eigen::Matrix<double, 6, 6>::Zero(); ///< M
  vector6<double> least = vector6<double>::Zero(); ///< of M ξ; −∞ where there is no least
  vector6<double> most = vector6<double>::Zero();  ///< of M ξ; the same as `least` in equations
};

/// What can be a goal of `inverse_kinematics`: `wanted(tip)`, of a pose of the tip, says which
/// twist of it is still missing.
///
/// It may have a `distance_from(point)`, a length that any tip at the goal is at least away from a
/// point of the base's frame, by which goals out of reach are told for certain.
template <class G>
concept TipGoal = requires(const G& goal, const dual_quaternion<double>& tip) {
  { goal.wanted(tip) } -> std::same_as<wanted_twist>;
};

/// Poses in a box, about an axis: what is left of a pose where some of it does not matter.
///
/// In `frame`, the origin of the tip lies between `lower` and `upper`. The rotation R of the tip in
/// that frame is a turn about `axis` by an angle between `turn_lower` and `turn_upper`, and then a
/// turn by no more than `tilt` about an axis orthogonal to it. So the axis, carried along by the
/// tip, is within a cone of half the angle `tilt` about where it is in `frame`. (Regions of task
/// space as in Berenson, Srinivasa, Kuffner, Task space regions, 2011, whose ranges of roll, pitch
/// and yaw depend on the order of turns.) Other points and axes of the tip: `with_tool`.
struct pose_region {
  dual_quaternion<double> frame;           ///< where the region is: a pose of it in the base
  std::array<double, 3> lower = {0, 0, 0}; ///< corner of the box in `frame`, may be −∞
  std::array<double, 3> upper = {0, 0, 0}; ///< the other corner, may be ∞
  std::array<double, 3> axis = {0, 0, 1};  ///< a unit vector in the tip, and in `frame`
  double tilt = 0;                         ///< of the axis at most, radians; π is any
  double turn_lower = 0;                   ///< about the axis at least, radians
  double turn_upper = 0;                   ///< about the axis at most; by 2π more is any

  /// For those who extend duet: what `TipGoal` asks for.
  [[nodiscard]] wanted_twist wanted(const dual_quaternion<double>& tip) const;
  /// For those who extend duet: as `TipGoal` may have it.
  [[nodiscard]] double distance_from(const vector3<double>& point) const;
};

/// The origin of the tip at a position in the base's frame, its rotation as it may be.
[[nodiscard]] inline pose_region position_goal(const vector3<double>& position) {
  return {.frame = pose(quaternion<double>(1), position),
          .tilt = std::numbers::pi,
          .turn_lower = -std::numbers::pi,
          .turn_upper = std::numbers::pi};
}

/// A pose but for turns about an axis of the tip, a unit vector in its frame.
[[nodiscard]] inline pose_region free_axis_goal(const dual_quaternion<double>& a,
                                                const vector3<double>& axis) {
  return {.frame = a,
          .axis = detail::components(axis),
          .turn_lower = -std::numbers::pi,
          .turn_upper = std::numbers::pi};
}

namespace detail {

/// \throws invalid_input for what is no unit vector
inline void require_unit(const vector3<double>& n, const char* function, const char* name) {
  require(std::abs(n.squaredNorm() - 1) <= 1e-6, "duet: ", function, ": the ", name, " (", n[0],
          ", ", n[1], ", ", n[2], ") is no unit vector");
}

/// A rotation that takes one unit vector to another: a half turn about the vector in their middle.
[[nodiscard]] inline quaternion<double> turn_between(const vector3<double>& from,
                                                     const vector3<double>& to) {
  vector3<double> middle = from + to;
  if (!(middle.norm() > 1e-8)) { // opposite: any orthogonal one
    int least = 0;
    from.cwiseAbs().minCoeff(&least);
    middle = from.cross(vector3<double>::Unit(least));
  }
  middle.normalize();
  return {0, middle[0], middle[1], middle[2]};
}

} // namespace detail

/// An axis of the tip, a unit vector in its frame, pointing along a unit vector in the base's
/// frame, wherever the tip is.
/// \param tilt  how far the axis may be from there, radians
/// \throws invalid_input for what are no unit vectors
[[nodiscard]] inline pose_region pointing_goal(const vector3<double>& axis,
                                               const vector3<double>& direction, double tilt = 0) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  detail::require_unit(axis, "pointing_goal", "axis");
  detail::require_unit(direction, "pointing_goal", "direction");
  auto result = free_axis_goal(
      pose(detail::turn_between(axis, direction), vector3<double>(vector3<double>::Zero())), axis);
  result.lower = {-infinity, -infinity, -infinity};
  result.upper = {infinity, infinity, infinity};
  result.tilt = tilt;
  return result;
}

/// The origin of the tip at a position, and an axis of it pointing along a direction.
/// \param tilt  how far the axis may be from there, radians
/// \throws invalid_input for what are no unit vectors
[[nodiscard]] inline pose_region position_and_pointing_goal(const vector3<double>& position,
                                                            const vector3<double>& axis,
                                                            const vector3<double>& direction,
                                                            double tilt = 0) {
  detail::require_unit(axis, "position_and_pointing_goal", "axis");
  detail::require_unit(direction, "position_and_pointing_goal", "direction");
  auto result = free_axis_goal(pose(detail::turn_between(axis, direction), position), axis);
  result.tilt = tilt;
  return result;
}

namespace detail {

/// \throws invalid_input for a region that holds no pose
inline void require_goal(const pose_region& r, const std::string& name) {
  require_pose(r.frame, "inverse_kinematics", "the frame of " + name);
  for (std::size_t i = 0; i < 3; ++i) {
    require(r.upper[i] - r.lower[i] >= 0, "duet: inverse_kinematics: ", name, " goes from ",
            r.lower[i], " to ", r.upper[i], " along axis ", i, " of its frame");
  }
  const auto n = components(r.axis);
  require(std::abs(dot(n, n) - 1) <= 1e-6, "duet: inverse_kinematics: the axis of ", name, " (",
          n.x, ", ", n.y, ", ", n.z, ") is no unit vector");
  require(r.tilt >= 0, "duet: inverse_kinematics: the tilt of ", name, " is ", r.tilt);
  require(r.turn_upper - r.turn_lower >= 0, "duet: inverse_kinematics: the turns of ", name,
          " go from ", r.turn_lower, " to ", r.turn_upper);
}

/// A row of `wanted_twist`: least ≤ n·ω ≤ most.
inline void want_turn(wanted_twist& wanted, Eigen::Index row, const vector3<double>& n,
                      double least, double most) {
  wanted.rows.block<1, 3>(row, 3) = n.transpose();
  wanted.least[row] = least;
  wanted.most[row] = most;
}

/// How an axis a of the tip is to turn towards b: to it, or to no more than `tilt` from it.
inline void want_axis(wanted_twist& wanted, const vector3<double>& a, const vector3<double>& b,
                      double tilt) {
  int least = 0;
  a.cwiseAbs().minCoeff(&least);
  const vector3<double> across = a.cross(b), any = a.cross(vector3<double>::Unit(least));
  const vector3<double> t = any / any.norm();
  const double sine = across.norm(), angle = std::atan2(sine, a.dot(b));
  const vector3<double> u = sine > 0 ? vector3<double>(across / sine) : t;
  if (tilt > 0) {
    // The angle grows by −u·ω.
    want_turn(wanted, 3, -u, -std::numeric_limits<double>::infinity(), tilt - angle);
    return;
  }
  const vector3<double> s = a.cross(t);
  want_turn(wanted, 3, t, angle * u.dot(t), angle * u.dot(t));
  want_turn(wanted, 4, s, angle * u.dot(s), angle * u.dot(s));
}

} // namespace detail

inline wanted_twist pose_region::wanted(const dual_quaternion<double>& tip) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double pi = std::numbers::pi;
  wanted_twist result;
  const quaternion<double> r = rotation(frame);
  const matrix3<double> axes = rotation_matrix(r);
  const vector3<double> at = axes.transpose() * (translation(tip) - translation(frame));
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double least = lower[std::size_t(i)], most = upper[std::size_t(i)];
    if (least > -infinity || most < infinity) {
      result.rows.block<1, 3>(i, 0) = axes.col(i).transpose();
      result.least[i] = least - at[i];
      result.most[i] = most - at[i];
    }
  }
  const vector3<double> n(axis[0], axis[1], axis[2]);
  const vector3<double> a = rotate(rotation(tip), n), b = rotate(r, n);
  if (tilt < pi) {
    detail::want_axis(result, a, b, tilt);
  }
  const double range = turn_upper - turn_lower;
  if (range < 2 * pi) {
    // With R = s t, t a turn about n and s one about an axis orthogonal to it, the angle of t is
    // that of the quaternion's part along n, and grows by (a + b)·ω / (1 + a·b).
    const quaternion<double> q = conj(r) * rotation(tip);
    const double turn = 2 * std::atan2(n.dot(vector3<double>(q.x(), q.y(), q.z())), q.w());
    const double middle = turn_lower + range / 2;
    const double nearest = middle + std::remainder(turn - middle, 2 * pi);
    detail::want_turn(result, 5, (a + b) / std::max(1 + a.dot(b), 1e-9), turn_lower - nearest,
                      turn_upper - nearest);
  }
  return result;
}

inline double pose_region::distance_from(const vector3<double>& point) const {
  const vector3<double> at =
      rotation_matrix(rotation(frame)).transpose() * (point - translation(frame));
  vector3<double> gap;
  for (Eigen::Index i = 0; i < 3; ++i) {
    gap[i] = at[i] - std::clamp(at[i], lower[std::size_t(i)], upper[std::size_t(i)]);
  }
  return gap.norm();
}

} // namespace duet
