// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/select.hpp>
#include <duet/core/structure.hpp>
#include <duet/core/text/number_text.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Joint trajectories: joint coordinates as a function of time.

namespace duet {

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

  [[nodiscard]] Eigen::VectorXd value(double s) const { return c0 + s * (c1 + s * (c2 + s * c3)); }
  [[nodiscard]] Eigen::VectorXd first(double s) const { return c1 + s * (2 * c2 + 3 * s * c3); }
  [[nodiscard]] Eigen::VectorXd second(double s) const { return 2 * c2 + 6 * s * c3; }
  /// This cubic from s on, as a cubic with the parameter counted from there.
  [[nodiscard]] joint_cubic part(double s, double its_length) const {
    return {value(s), first(s), Eigen::VectorXd(second(s) / 2), c3, its_length};
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
    const auto& [scaling, path] = piece_at(t);
    const auto [s, speed, acceleration, jerk] = scaling.at(t, path.length);
    const Eigen::VectorXd slope = path.first(s);
    return {path.value(s), Eigen::VectorXd(speed * slope),
            Eigen::VectorXd(acceleration * slope + speed * speed * path.second(s))};
  }
  /// Jerk at time t, the derivative of the acceleration; at a jump, one of both values.
  ///
  /// \throws invalid_input as `operator()`
  [[nodiscard]] Eigen::VectorXd jerk(double t) const {
    const auto& [scaling, path] = piece_at(t);
    const auto [s, speed, acceleration, jerk] = scaling.at(t, path.length);
    return jerk * path.first(s) + 3 * speed * acceleration * path.second(s) +
           speed * speed * speed * 6 * path.c3;
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
