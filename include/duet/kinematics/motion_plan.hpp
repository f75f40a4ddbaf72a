// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/select.hpp>
#include <duet/core/structure.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Plans and trajectories: options and result of the path planners, and joint coordinates as a
/// function of time.

namespace duet {

/// Error of a pose relative to another: distance of the origins and rotation angle.
struct pose_error {
  double translation = 0; ///< distance of the origins, in units of length
  double rotation = 0;    ///< rotation angle between the axes, radians

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("translation", translation);
    f("rotation", rotation);
  }
};

/// Tolerance of a pose, with separate bounds for lengths and angles: `{.1, 1e-3}` is a tenth of a
/// unit of length and a milliradian. A single number sets both.
struct pose_tolerance {
  double translation; ///< maximum distance of the origins, in units of length
  double rotation;    ///< maximum rotation angle between the axes, radians

  constexpr pose_tolerance(double both) : translation(both), rotation(both) {}
  constexpr pose_tolerance(double of_translation, double of_rotation)
      : translation(of_translation), rotation(of_rotation) {}

  /// Ratio of an error to the tolerance, the larger one of length and angle; at most 1 within it.
  [[nodiscard]] double ratio(const pose_error& error) const {
    return std::max(error.translation / translation, error.rotation / rotation);
  }
};

/// Options of `follow_path` and `plan_screw_motion`. Steps along the path are fractions of it.
struct plan_options {
  /// Maximum error of the tip relative to the path at waypoints.
  pose_tolerance tolerance = 1e-6;
  /// Maximum error of the tip relative to the path between waypoints, where joints move straight
  /// on.
  pose_tolerance deviation = 1e-5;
  /// Maximum step along the path from one waypoint to the next.
  double largest_step = .1;
  /// Minimum step along the path; below it the plan only continues by a self-motion.
  double smallest_step = 1e-6;
  /// Gain of joint-limit avoidance (joint centring): largest rate at which joints move away from
  /// their limits without moving the tip (in the null space of the Jacobian), in coordinates per
  /// path.
  double centring = 1;
  /// Step along the path between the poses at which the tip may stop for a self-motion; 0: none.
  double search_step = .02;
  /// Step of the joints from one configuration of a self-motion to the next, in coordinates.
  double self_motion_step = .1;
  /// Maximum number of iterations of Newton's method in total.
  int max_iterations = 1000000;
};

/// Termination reason of a planner or search. Plans are continued to within 100 `smallest_step` of
/// where they end, 1e-4 of the path: if limits end one closer than that before a singularity does,
/// both block it, and the reason is either of the two.
enum class stop_reason {
  reached,         ///< the tip is at the goal
  joint_limit,     ///< the continuation leads beyond the limits of a joint
  singular,        ///< the continuation leads through a singularity
  obstacle,        ///< the continuation leads too close to an obstacle, or to self-collision
  no_progress,     ///< steps became too small, for none of these reasons
  iteration_limit, ///< the maximum number of iterations is used up
  out_of_reach,    ///< the goal is farther away than the links reach
  no_solution      ///< no joint coordinates take the tip there, within limits or not
};

/// Name of a `stop_reason`.
[[nodiscard]] inline const char* to_text(stop_reason reason) {
  constexpr std::array names{"reached",     "joint_limit",     "singular",     "obstacle",
                             "no_progress", "iteration_limit", "out_of_reach", "no_solution"};
  return names[std::size_t(reason)];
}

/// Error between two poses, length and angle separate; symmetric in a and b.
template <std::floating_point T>
[[nodiscard]] pose_error pose_error_between(const dual_quaternion<T>& a,
                                            const dual_quaternion<T>& b) {
  return {(translation(b) - translation(a)).norm(),
          rotation_vector(quaternion<T>(conj(rotation(a)) * rotation(b))).norm()};
}

/// Path in configuration space from the start on: waypoints, with straight lines in between. If the
/// goal is not reached, the path ends as far as the planner came.
struct motion_plan {
  /// Configuration at each waypoint: radians, or units of length for prismatic joints.
  std::vector<Eigen::VectorXd> joints;
  std::vector<dual_quaternion<double>> poses; ///< pose of the tip at each waypoint
  /// Fraction of the screw motion, or parameter of the path, at each waypoint; equal at successive
  /// waypoints of a self-motion.
  std::vector<double> tau;
  std::vector<pose_error> deviations; ///< error relative to the requested motion at each waypoint
  /// Smallest singular value of the Jacobian in `frame::hybrid` at any waypoint, estimated from
  /// above.
  double smallest_singular_value = std::numeric_limits<double>::infinity();
  /// Smallest distance of any joint from its nearer limit at any waypoint, in coordinates.
  double smallest_limit_margin = std::numeric_limits<double>::infinity();
  /// Smallest clearance at any waypoint, of bodies from obstacles and in pairs; infinite without
  /// any.
  double smallest_clearance = std::numeric_limits<double>::infinity();
  int iterations = 0; ///< number of iterations of Newton's method in total
  /// Termination reason: `reached` if the plan ends at the goal.
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

/// The plan that executes one plan and then another, which starts where the first ends.
///
/// The parameter τ of the second continues from the last one of the first. Margins are the smaller
/// ones, iterations are added, and the reason is that of the second.
///
/// \param tolerance  maximum difference of a coordinate between the end and the start
/// \throws invalid_input if a plan has no waypoints, the numbers of joints differ, or the plans do
/// not meet
[[nodiscard]] inline motion_plan join_plans(const motion_plan& first, const motion_plan& second,
                                            double tolerance = 1e-9) {
  detail::require(!first.joints.empty() && !second.joints.empty(),
                  "duet: join_plans: a plan has no waypoints");
  const Eigen::VectorXd &end = first.joints.back(), &start = second.joints.front();
  detail::require(end.size() == start.size(), "duet: join_plans: the plans have ", end.size(),
                  " and ", start.size(), " joints");
  for (Eigen::Index i = 0; i < end.size(); ++i) {
    detail::require(std::abs(end[i] - start[i]) <= tolerance, "duet: join_plans: joint ", i,
                    " ends at ", to_text(end[i]), ", but starts at ", to_text(start[i]));
  }
  motion_plan plan = first;
  const double shift = first.tau.back() - second.tau.front();
  for (std::size_t k = 1; k < second.joints.size(); ++k) {
    plan.joints.push_back(second.joints[k]);
    plan.poses.push_back(second.poses[k]);
    plan.tau.push_back(second.tau[k] + shift);
    plan.deviations.push_back(second.deviations[k]);
  }
  plan.smallest_singular_value =
      std::min(first.smallest_singular_value, second.smallest_singular_value);
  plan.smallest_limit_margin = std::min(first.smallest_limit_margin, second.smallest_limit_margin);
  plan.smallest_clearance = std::min(first.smallest_clearance, second.smallest_clearance);
  plan.iterations = first.iterations + second.iterations;
  plan.reason = second.reason;
  return plan;
}

namespace detail {

template <class C, class V>
void add_waypoint(motion_plan& plan, const C& chain, const V& theta,
                  const dual_quaternion<double>& pose, double tau, const pose_error& deviation) {
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

/// Coordinates of a chain's joints, in the vector type of the chain.
template <class C, class X>
[[nodiscard]] joint_vector<double, C::joints> to_chain_joints(const C& chain, const X& x) {
  joint_vector<double, C::joints> theta(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    theta[i] = vector_argument<X>::get(x, i);
  }
  return theta;
}

/// Start of a search in a vector of the chain's type.
///
/// \throws invalid_input for another number of coordinates than joints
template <class C, class Start>
[[nodiscard]] joint_vector<double, C::joints> start_of(const C& chain, const Start& start) {
  require_size(chain, start);
  return to_chain_joints(chain, start);
}

/// \throws invalid_input for a start of another size, not finite or outside the limits
template <class C, class Start>
void require_start(const C& chain, const Start& start, const char* caller) {
  require_size(chain, start);
  for (int i = 0; i < chain.size(); ++i) {
    const double x = vector_argument<Start>::get(start, i);
    const auto& limits = chain.limits(i);
    require(x >= limits.lower && x <= limits.upper && x - x == 0, "duet: ", caller, ": joint ", i,
            " of the start is ", x, " (expected a finite number from ", limits.lower, " to ",
            limits.upper, ")");
  }
}

/// \throws invalid_input for an argument that is not a pose
inline void require_pose(const dual_quaternion<double>& a, const char* caller,
                         const std::string& name) {
  if (is_unit(a, 1e-6)) {
    return;
  }
  // If one entry of a translation is not finite, no entry of q is: each depends on all of them.
  const auto rotation_part = rotation(a);
  const auto translation_part = translation(a);
  const auto entry = [](double x) { return x == x ? to_text(x) : "nan"; }; // nan without a sign
  require(is_all_finite(rotation_part), "duet: ", caller, ": the rotation of ", name,
          " is not finite: (", entry(rotation_part.w()), ", ", entry(rotation_part.x()), ", ",
          entry(rotation_part.y()), ", ", entry(rotation_part.z()), ")");
  require(is_all_finite(dual_part(a)), "duet: ", caller, ": the translation of ", name,
          " is not finite: (", entry(translation_part[0]), ", ", entry(translation_part[1]), ", ",
          entry(translation_part[2]), ")");
  const auto square = squared_norm(a);
  raise(invalid_input(message("duet: ", caller, ": ", name,
                              " is not a unit dual quaternion: |p|^2 = ", square.value(),
                              ", p.q = ", square.epsilon() / 2, " (expected 1 and 0)")));
}

} // namespace detail

/// State of the joints: coordinates, velocities and accelerations.
template <class V>
struct joint_state {
  V value = detail::zero_initialized<V>();        ///< θ: radians, or units of length if prismatic
  V velocity = detail::zero_initialized<V>();     ///< θ̇, per unit of time
  V acceleration = detail::zero_initialized<V>(); ///< θ̈, per unit of time squared

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("value", value);
    f("velocity", velocity);
    f("acceleration", acceleration);
  }
};

namespace detail {

/// c0 + c1 s + c2 s² + c3 s³, 0 ≤ s ≤ length.
struct joint_cubic {
  Eigen::VectorXd c0, c1, c2, c3;
  double length;

  // Coordinates are computed one by one: expressions of vectors would cost every program that
  // includes this header more than its parsing.
  [[nodiscard]] double value(Eigen::Index i, double s) const {
    return c0[i] + s * (c1[i] + s * (c2[i] + s * c3[i]));
  }
  [[nodiscard]] double first(Eigen::Index i, double s) const {
    return c1[i] + s * (2 * c2[i] + 3 * s * c3[i]);
  }
  [[nodiscard]] double second(Eigen::Index i, double s) const { return 2 * c2[i] + 6 * s * c3[i]; }
  [[nodiscard]] Eigen::VectorXd value(double s) const {
    return each([&](Eigen::Index i) { return value(i, s); });
  }
  [[nodiscard]] Eigen::VectorXd first(double s) const {
    return each([&](Eigen::Index i) { return first(i, s); });
  }
  [[nodiscard]] Eigen::VectorXd second(double s) const {
    return each([&](Eigen::Index i) { return second(i, s); });
  }
  /// This cubic from s on, as a cubic with the parameter counted from there.
  [[nodiscard]] joint_cubic part(double s, double its_length) const {
    return {value(s), first(s), each([&](Eigen::Index i) { return second(i, s) / 2; }), c3,
            its_length};
  }
  /// Column of the numbers f(i) of all coordinates.
  [[nodiscard]] Eigen::VectorXd each(const auto& f) const {
    Eigen::VectorXd result(c0.size());
    for (Eigen::Index i = 0; i < result.size(); ++i) {
      result[i] = f(i);
    }
    return result;
  }
};

/// Position on a segment of a path, with derivatives with respect to time.
struct path_state {
  double s, speed, acceleration, jerk;
};

/// Time scaling of a segment of a path: s = a τ + b τ² + c τ³, where τ starts with a speed and an
/// acceleration and τ⃛ = growth τ̇; so τ̈ = acceleration + growth τ.
struct time_scaling {
  double time;         ///< time at the beginning
  double speed;        ///< τ̇ at the beginning
  double acceleration; ///< τ̈ at the beginning
  double growth = 0;
  double a = 1, b = 0, c = 0;

  /// Position at time t, not beyond the end of a segment of that length.
  [[nodiscard]] path_state at(double t, double length) const {
    const double since = t - time;
    double tau = since * (speed + since * acceleration / 2);
    double rate = speed + since * acceleration;
    if (growth != 0) {
      // τ = speed sinh(ω t) / ω + acceleration (cosh(ω t) − 1) / ω², ω² = growth.
      const double omega = std::sqrt(std::abs(growth)), angle = omega * since / 2;
      const double half = (growth > 0 ? std::sinh(angle) : std::sin(angle)) / omega;
      const double cosine = std::sqrt(std::max(0.0, 1 + growth * half * half));
      const double sine = 2 * half * cosine, rise = 2 * half * half;
      tau = speed * sine + acceleration * rise;
      rate = speed * (1 + growth * rise) + acceleration * sine;
    }
    rate = std::max(0.0, rate);
    const double change = acceleration + growth * tau;
    const double slope = a + tau * (2 * b + 3 * c * tau), bend = 2 * b + 6 * c * tau;
    return {std::clamp(tau * (a + tau * (b + tau * c)), 0.0, length), slope * rate,
            bend * (rate * rate) + slope * change,
            rate * (6 * c * (rate * rate) + 3 * bend * change + slope * growth)};
  }
};

/// Segment of a path with its time scaling.
struct timed_piece {
  time_scaling scaling;
  joint_cubic path;
};

} // namespace detail

/// Joint coordinates as a function of time, once continuously differentiable; twice with jerk
/// limits.
class joint_trajectory {
public:
  joint_trajectory(std::vector<detail::timed_piece> pieces, std::vector<double> times)
      : pieces_(std::move(pieces)), times_(std::move(times)) {}

  /// Duration, in seconds if limits are per second.
  [[nodiscard]] double duration() const { return times_.back(); }
  /// Times at which the waypoints are passed.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// Coordinates, velocities and accelerations at time t; at a jump of the acceleration, one of
  /// both values. A t up to 8 ulp of the duration beyond an end counts as that end.
  ///
  /// \throws invalid_input for t outside 0 … duration()
  [[nodiscard]] joint_state<Eigen::VectorXd> operator()(double t) const {
    joint_state<Eigen::VectorXd> state;
    (*this)(t, state);
    return state;
  }
  /// As above, in memory of the caller: no heap from the second call on.
  void operator()(double t, joint_state<Eigen::VectorXd>& state) const {
    const auto& [scaling, path] = piece_at(t);
    const auto [s, speed, acceleration, jerk] = scaling.at(t, path.length);
    const Eigen::Index size = path.c0.size();
    state.value.resize(size);
    state.velocity.resize(size);
    state.acceleration.resize(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      const double slope = path.first(i, s);
      state.value[i] = path.value(i, s);
      state.velocity[i] = slope * speed;
      state.acceleration[i] = acceleration * slope + speed * speed * path.second(i, s);
    }
  }
  /// Jerk at time t, the derivative of the acceleration; at a jump, one of both values.
  ///
  /// \throws invalid_input as `operator()`
  [[nodiscard]] Eigen::VectorXd jerk(double t) const {
    const detail::timed_piece& piece = piece_at(t);
    const detail::joint_cubic& path = piece.path;
    const detail::path_state at = piece.scaling.at(t, path.length);
    return path.each([&](Eigen::Index i) {
      return at.jerk * path.first(i, at.s) + 3 * at.speed * at.acceleration * path.second(i, at.s) +
             at.speed * at.speed * at.speed * 6 * path.c3[i];
    });
  }

private:
  /// Segment that contains t, which is moved to an end if it is beyond that by round-off.
  [[nodiscard]] const detail::timed_piece& piece_at(double& t) const {
    if (!(t >= 0 && t <= duration())) {
      t = detail::clamp_rounding(t, 0.0, duration());
      if (!(t >= 0 && t <= duration())) {
        detail::raise(invalid_input("duet: joint_trajectory: t is " + to_text(t) +
                                    " (expected 0 to " + to_text(duration()) +
                                    "; std::clamp gives the state at an end)"));
      }
    }
    const auto next =
        std::upper_bound(pieces_.begin() + 1, pieces_.end(), t,
                         [](double at, const auto& piece) { return at < piece.scaling.time; });
    return *(next - 1);
  }

  std::vector<detail::timed_piece> pieces_;
  std::vector<double> times_; ///< times of the waypoints
};

} // namespace duet
