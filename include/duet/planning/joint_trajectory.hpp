// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/rounding.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/mechanism/serial_chain.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Joint coordinates over time.

namespace duet {

/// Joint coordinates with their rates.
template <class V>
struct joint_motion {
  V value;        ///< θ: radians, or units of length where joints slide
  V velocity;     ///< θ̇, per unit of time
  V acceleration; ///< θ̈, per unit of time squared

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("value", value);
    f("velocity", velocity);
    f("acceleration", acceleration);
  }
};

namespace detail {

/// c0 + c1 s + c2 s² + c3 s³, 0 ≤ s ≤ length.
template <class V>
struct joint_cubic {
  V c0, c1, c2, c3;
  double length;

  [[nodiscard]] V value(double s) const { return c0 + s * (c1 + s * (c2 + s * c3)); }
  [[nodiscard]] V first(double s) const { return c1 + s * (2 * c2 + 3 * s * c3); }
  [[nodiscard]] V second(double s) const { return 2 * c2 + 6 * s * c3; }
  /// This cubic from s on, as one of its own with the parameter counted from there.
  [[nodiscard]] joint_cubic part(double s, double its_length) const {
    return {value(s), first(s), V(second(s) / 2), c3, its_length};
  }
};

/// A part of a path, and when it is where: s = ṡ t + ½ s̈ t² from its beginning on.
template <class V>
struct timed_piece {
  double time;
  double speed;        ///< ṡ
  double acceleration; ///< s̈
  joint_cubic<V> path;
};

} // namespace detail

/// Joint coordinates as a function of time, once continuously differentiable.
///
/// \tparam N  as of `serial_chain`
template <int N>
class joint_trajectory {
public:
  using vector = detail::joint_vector<double, N>;

  joint_trajectory(std::vector<detail::timed_piece<vector>> pieces, std::vector<double> times)
      : pieces_(std::move(pieces)), times_(std::move(times)) {}

  /// In seconds, if limits are per second.
  [[nodiscard]] double duration() const { return times_.back(); }
  /// When it passes each of the waypoints.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  /// Coordinates, rates and accelerations at time t; where the acceleration jumps, one of the two.
  /// Up to 8 ulp of the duration beyond an end is that end.
  /// \throws invalid_input for t outside 0 … duration()
  [[nodiscard]] joint_motion<vector> operator()(double t) const {
    if (!(t >= 0 && t <= duration())) {
      t = detail::rounded_into(t, 0.0, duration());
      if (!(t >= 0 && t <= duration())) {
        detail::raise(invalid_input("duet: joint_trajectory: t is " + to_text(t) +
                                    ", outside 0 to " + to_text(duration()) +
                                    "; std::clamp makes it stay at its end"));
      }
    }
    const auto next = std::upper_bound(pieces_.begin() + 1, pieces_.end(), t,
                                       [](double a, const auto& piece) { return a < piece.time; });
    const auto& piece = *(next - 1);
    const double since = t - piece.time;
    const double s =
        std::clamp(since * (piece.speed + since * piece.acceleration / 2), 0.0, piece.path.length);
    const double s_dot = std::max(0.0, piece.speed + since * piece.acceleration);
    const vector slope = piece.path.first(s);
    return {piece.path.value(s), vector(s_dot * slope),
            vector(piece.acceleration * slope + s_dot * s_dot * piece.path.second(s))};
  }

private:
  std::vector<detail::timed_piece<vector>> pieces_;
  std::vector<double> times_; ///< of the waypoints
};

} // namespace duet
