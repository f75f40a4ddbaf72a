// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

/// \file
/// What a planner is told, and what it returns.

namespace duet {

/// How far one pose is from another: its origin in units of length, its axes in radians.
struct pose_deviation {
  double length = 0; ///< from origin to origin, in units of length
  double angle = 0;  ///< between the axes, radians

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("length", length);
    f("angle", angle);
  }
};

/// How far one pose may be from another, lengths and angles apart: `{.1, 1e-3}` is a tenth of a
/// unit of length and a milliradian. One number stands for both.
struct pose_tolerance {
  double length; ///< from origin to origin, in units of length
  double angle;  ///< between the axes, radians

  constexpr pose_tolerance(double both) : length(both), angle(both) {}
  constexpr pose_tolerance(double of_length, double of_angle)
      : length(of_length), angle(of_angle) {}

  /// How many times as far as that is a deviation? Up to 1 it is within.
  [[nodiscard]] double times(const pose_deviation& left) const {
    return std::max(left.length / length, left.angle / angle);
  }
};

/// Settings of `follow_path` and `plan_screw_motion`. Steps along the path are fractions of it.
struct plan_options {
  /// How close waypoints come to the path.
  pose_tolerance tolerance = 1e-6;
  /// How far the tip may be from it where joints move straight on between waypoints.
  pose_tolerance deviation = 1e-5;
  /// From one waypoint to the next.
  double largest_step = .1;
  /// Below it there is no going on without moving in place.
  double smallest_step = 1e-6;
  /// How fast joints move away from their limits where that leaves the tip in place, in coordinates
  /// per path.
  double centring = 1;
  /// Between the places where the tip may stop for the joints to move in place; 0: nowhere.
  double search_step = .02;
  /// How far the joints then move from one configuration to the next, in coordinates.
  double self_motion_step = .1;
  /// Of Newton's method, in all.
  int iterations = 1000000;
};

/// Why a planner stopped. Ways are followed to within 100 `smallest_step` of where they end, 1e-4
/// of the path: where limits end one nearer than that before a singularity does, both are in the
/// way, and it is either of the two.
enum class stop_reason {
  reached,         ///< the tip is at the goal
  joint_limit,     ///< the way on leads beyond the limits of a joint
  singular,        ///< the way on leads through a singularity
  obstacle,        ///< the way on leads too close to an obstacle, or a link to another
  no_progress,     ///< steps became too small, for none of these reasons
  iteration_limit, ///< the number of iterations that was allowed is used up
  out_of_reach,    ///< the goal is farther away than the links reach
  no_solution      ///< no joint coordinates take the tip there, within limits or not
};

/// The name of a `stop_reason`.
[[nodiscard]] inline const char* to_text(stop_reason reason) {
  constexpr std::array names{"reached",     "joint_limit",     "singular",     "obstacle",
                             "no_progress", "iteration_limit", "out_of_reach", "no_solution"};
  return names[std::size_t(reason)];
}

/// How far a pose is from another, length and angle apart; the same for a and b as for b and a.
template <std::floating_point T>
[[nodiscard]] pose_deviation deviation_between(const dual_quaternion<T>& a,
                                               const dual_quaternion<T>& b) {
  return {(translation(b) - translation(a)).norm(),
          rotation_vector(quaternion<T>(conj(rotation(a)) * rotation(b))).norm()};
}

/// A path of joint coordinates from the start on, waypoint by waypoint, joints moving straight on
/// between them. Where the goal is not reached, the path ends as far as the planner came.
///
/// \tparam N  as of `serial_chain`
template <int N>
struct motion_plan {
  /// Joint coordinates at each waypoint: radians, or units of length where joints slide.
  std::vector<detail::joint_vector<double, N>> joints;
  std::vector<dual_quaternion<double>> poses; ///< of the tip, at each waypoint
  /// The fraction of the screw motion, or the parameter of the path, at each waypoint; the same in
  /// successive ones where the joints move with the tip in place.
  std::vector<double> tau;
  std::vector<pose_deviation> deviations; ///< from the motion asked for, at each waypoint
  /// Of the Jacobian in `frame::hybrid`, at any waypoint, estimated from above.
  double smallest_singular_value = std::numeric_limits<double>::infinity();
  /// Of any joint, at any waypoint, to its nearer limit; in coordinates.
  double smallest_limit_margin = std::numeric_limits<double>::infinity();
  /// Of the bodies of the chain from obstacles, at any waypoint; infinite without.
  double smallest_clearance = std::numeric_limits<double>::infinity();
  int iterations = 0; ///< of Newton's method, in all
  /// Why the plan ends where it does: `reached` where that is the goal.
  stop_reason reason = stop_reason::no_progress;

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("joints", joints);
    f("poses", poses);
    f("tau", tau);
    f("deviations", deviations);
    f("smallest_singular_value", smallest_singular_value);
    f("smallest_limit_margin", smallest_limit_margin);
    f("smallest_clearance", smallest_clearance);
    f("iterations", iterations);
    f("reason", reason);
  }
};

namespace detail {

template <int N, class C, class V>
void add_waypoint(motion_plan<N>& plan, const C& chain, const V& theta,
                  const dual_quaternion<double>& pose, double tau,
                  const pose_deviation& deviation) {
  plan.joints.push_back(theta);
  plan.poses.push_back(pose);
  plan.tau.push_back(tau);
  plan.deviations.push_back(deviation);
  for (int i = 0; i < chain.size(); ++i) {
    const auto& limits = chain.limits(i);
    plan.smallest_limit_margin =
        std::min({plan.smallest_limit_margin, theta[i] - limits.lower, limits.upper - theta[i]});
  }
}

/// Coordinates of a chain's joints, as a vector of their own.
template <class C, class X>
[[nodiscard]] joint_vector<double, C::joints> own_joints(const C& chain, const X& x) {
  joint_vector<double, C::joints> theta(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    theta[i] = x[i];
  }
  return theta;
}

/// \throws invalid_input for a start of another size, not finite or outside the limits
template <class C, class Start>
void require_start(const C& chain, const Start& start) {
  require_size(chain, start);
  for (int i = 0; i < chain.size(); ++i) {
    const double x = vector_argument<Start>::get(start, i);
    const auto& limits = chain.limits(i);
    require(x >= limits.lower && x <= limits.upper && x - x == 0, "duet: plan: the start has ", x,
            " for joint ", i, ", whose limits are ", limits.lower, " and ", limits.upper);
  }
}

/// \throws invalid_input for what is no pose: "duet: plan: the goal is …"
inline void require_pose(const dual_quaternion<double>& a, const char* caller,
                         const std::string& name) {
  if (is_unit(a, 1e-6)) {
    return;
  }
  // A translation that is not finite in one entry is so in none: all are in every entry of p + εq.
  const auto turn = rotation(a);
  const auto move = translation(a);
  const auto entry = [](double x) { return x == x ? to_text(x) : "nan"; }; // whatever its sign
  require(is_all_finite(turn), "duet: ", caller, ": ", name, ": its rotation is not finite: (",
          entry(turn.w()), ", ", entry(turn.x()), ", ", entry(turn.y()), ", ", entry(turn.z()),
          ")");
  require(is_all_finite(dual_part(a)), "duet: ", caller, ": ", name,
          ": its translation is not finite: (", entry(move[0]), ", ", entry(move[1]), ", ",
          entry(move[2]), ")");
  const auto square = norm2(a);
  raise(invalid_input(message("duet: ", caller, ": ", name, " is no unit dual quaternion: |p|^2 = ",
                              square.value(), ", p.q = ", square.epsilon() / 2)));
}

/// \throws invalid_input for what is no number above 0, if it is one that is asked for
inline void require_option(const char* caller, const char* name, double value, bool is_good,
                           const char* range) {
  require(is_good && value - value == 0, "duet: ", caller, ": ", name, " is ", value, ", not ",
          range);
}
inline void require_positive(const char* caller, const char* name, double value) {
  require_option(caller, name, value, value > 0, "a number above 0");
}
inline void require_positive(const char* caller, const char* name, const pose_tolerance& value) {
  const bool is_length = !(value.length > 0);
  if (is_length || !(value.angle > 0)) {
    const std::string part = std::string(name) + (is_length ? ".length" : ".angle");
    require_positive(caller, part.c_str(), is_length ? value.length : value.angle);
  }
}

} // namespace detail
} // namespace duet
