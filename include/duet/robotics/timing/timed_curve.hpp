// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/kinematics/joint_trajectory.hpp>
#include <duet/robotics/timing/jerk_limited.hpp>
#include <duet/robotics/timing/phase_plane_velocities.hpp>
#include <duet/robotics/timing/time_parametrisation_input.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

/// \file
/// Time parametrisation of joint curves. For those who extend duet.

namespace duet::detail {

/// Segments of a curve with constant s̈ each: their number is proportional to the length, but at
/// least sixteen per edge; they are shorter towards the ends of edges, where the second derivative
/// or its slope jumps. Eight are enough on an edge between nearly equal waypoints, as s̈ = (y −
/// x)/(2h) suffers from cancellation in short segments.
template <class V>
[[nodiscard]] std::vector<joint_cubic<V>> parts_of(const std::vector<joint_cubic<V>>& curve,
                                                   double length, int parts) {
  std::vector<joint_cubic<V>> result;
  for (const auto& edge : curve) {
    const double fraction = edge.length / length;
    const double count = fraction < 1e-6 ? 8 : std::max(16.0, std::ceil(fraction * parts));
    const auto boundary = [&](double k) {
      const double u = k / count;
      return edge.length * (u * u * (3 - 2 * u));
    };
    for (double k = 0; k < count; ++k) {
      result.push_back(edge.part(boundary(k), boundary(k + 1) - boundary(k)));
    }
  }
  return result;
}

/// Checks that the boundary velocities are feasible.
///
/// \throws invalid_input if they are not, with the fraction that is feasible
inline void require_feasible_velocities(const infeasible_boundary& infeasible, double first,
                                        double last) {
  if (infeasible.at_start || infeasible.at_end) {
    const double required = infeasible.at_start ? first : last;
    raise(invalid_input(message(
        "duet: time_optimal_trajectory: the ", infeasible.at_start ? "initial" : "final",
        " velocities are infeasible (expected at most ",
        std::floor(9999 * std::sqrt(infeasible.largest) / required) / 1e4, " times as large)")));
  }
}

/// Motion with given squared path velocities ṡ² at the ends of segments.
template <class V>
[[nodiscard]] timed_path<V> timed_by_squares(const std::vector<joint_cubic<V>>& parts,
                                             const std::vector<double>& squares) {
  timed_path<V> result;
  result.pieces.reserve(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double h = parts[i].length;
    const double before = std::sqrt(squares[i]), after = std::sqrt(squares[i + 1]);
    const double change = (squares[i + 1] - squares[i]) / (2 * h);
    result.pieces.push_back({{result.duration, before, change}, parts[i]});
    result.duration += 2 * h / (before + after);
  }
  return result;
}

template <class V>
[[nodiscard]] path_bounds bounds_of(const std::vector<joint_cubic<V>>& parts, const V& velocity,
                                    const V& acceleration) {
  path_bounds result(velocity.size());
  result.reserve(parts.size());
  for (const auto& part : parts) {
    result.add(part, velocity, acceleration);
  }
  return result;
}

/// Largest fraction of an acceleration limit that a motion uses, by Bernstein coefficients.
template <class V>
[[nodiscard]] double largest_fraction(const timed_path<V>& motion, const V& limits) {
  double result = 0;
  for (const auto& [scaling, q] : motion.pieces) {
    const double x = scaling.speed * scaling.speed, y = x + 2 * q.length * scaling.acceleration;
    const V second = q.second(0), last = q.second(q.length);
    for (const V& coefficient :
         {V(scaling.acceleration * q.first(0) + x * second),
          V(scaling.acceleration * (q.c1 + q.length * q.c2) + x / 2 * last + y / 2 * second),
          V(scaling.acceleration * q.first(q.length) + y * last)}) {
      result = std::max(result, coefficient.cwiseQuotient(limits).cwiseAbs().maxCoeff());
    }
  }
  return result;
}

/// Minimum-time motion along a curve with constant s̈ in each segment. If segments are
/// so short that round-off takes accelerations beyond their limits, it is computed
/// again with smaller limits.
///
/// \throws invalid_input for velocities at ends that are too fast
template <int N>
[[nodiscard]] auto
timed_by_accelerations(const time_parametrisation_input<N>& problem,
                       const std::vector<joint_cubic<joint_vector<double, N>>>& curve) {
  const auto parts = parts_of(curve, problem.polygon.s.back(), problem.parts);
  const double first = problem.initial_speed, last = problem.final_speed;
  joint_vector<double, N> limits = problem.acceleration;
  std::optional<timed_path<joint_vector<double, N>>> result;
  for (int round = 0; round < 8; ++round) {
    infeasible_boundary infeasible;
    const std::vector<double> squares = phase_plane_velocities(
        bounds_of(parts, problem.velocity, limits), first * first, last * last, infeasible);
    if (result && (infeasible.at_start || infeasible.at_end)) {
      break; // velocities at their limits
    }
    require_feasible_velocities(infeasible, first, last);
    result = timed_by_squares(parts, squares);
    const double excess = largest_fraction(*result, problem.acceleration) - 1;
    if (!(excess > 1e-13)) {
      break;
    }
    limits /= 1 + 2 * excess;
  }
  return *result;
}

/// Motion with approximately the given velocities at its ends that needs the smallest fraction of
/// the acceleration limits for them, as an initial guess for jerk limits. (Near the minimum-time
/// motion, path velocities near the ends would have to change, and searches that start there stall
/// in a corner of the feasible set.)
template <int N>
[[nodiscard]] auto
min_acceleration_motion(const time_parametrisation_input<N>& problem,
                        const std::vector<joint_cubic<joint_vector<double, N>>>& curve) {
  const auto parts = parts_of(curve, problem.polygon.s.back(), problem.parts);
  std::array<double, 2> ends{problem.initial_speed * problem.initial_speed,
                             problem.final_speed * problem.final_speed};
  infeasible_boundary infeasible;
  std::vector<double> squares;
  const auto is_feasible = [&](double scale) {
    const joint_vector<double, N> acceleration = scale * problem.acceleration;
    infeasible = {};
    squares = phase_plane_velocities(bounds_of(parts, problem.velocity, acceleration), ends[0],
                                     ends[1], infeasible);
    return !infeasible.at_start && !infeasible.at_end;
  };
  while (!is_feasible(1)) {
    ends[infeasible.at_start ? 0 : 1] = infeasible.largest > 0 ? .99 * infeasible.largest : 0;
  }
  if (ends[0] + ends[1] > 0) {
    double low = 1e-4, high = 1;
    for (int i = 0; i < 8; ++i) {
      const double middle = std::sqrt(low * high);
      (is_feasible(middle) ? high : low) = middle;
    }
    (void)is_feasible(high);
  }
  return timed_by_squares(parts, squares);
}

/// Search for motions within jerk limits with given velocities at both ends. It proceeds from a
/// motion with small accelerations by successive refinement, each result being the initial guess
/// (warm start) of the next. If that fails it starts with jerk limits relaxed until it succeeds and
/// tightens them step by step, so that the velocities at the ends are right throughout.
template <int N>
class jerk_search {
public:
  using vector = joint_vector<double, N>;
  using motion = timed_path<vector>;

  jerk_search(const time_parametrisation_input<N>& problem,
              const std::vector<joint_cubic<vector>>& curve)
      : problem_(problem), curve_(curve), gentle_(min_acceleration_motion(problem, curve)) {}

  /// Motion within the limits; empty if none is found.
  [[nodiscard]] std::optional<motion> run() {
    std::optional<motion> result;
    motion last = gentle_;
    for (const double divisor : {6, 3, 2}) {
      auto next = find(last, divisor, 1);
      if (next.is_feasible()) {
        result = next.motion;
      } else if (next.reached[next.end()] > nearest_.reached[nearest_.end()]) {
        nearest_ = next;
      }
      last = std::move(next.motion);
    }
    return result ? result : narrowed();
  }
  /// Motion that comes nearest, among those that violate the limits.
  [[nodiscard]] const jerk_search_result<vector>& nearest() const { return nearest_; }

private:
  /// Searches with jerk limits multiplied by `scale`, coarsely if that is not 1.
  [[nodiscard]] jerk_search_result<vector> find(const motion& from, double divisor, double scale) {
    time_parametrisation_input<N> loose = problem_;
    loose.jerk *= scale;
    return timed_by_jerks(loose, curve_, from,
                          std::size_t(std::max(16.0, problem_.parts / divisor)),
                          scale > 1 ? 200 : 5e4);
  }
  [[nodiscard]] std::optional<motion> narrowed() {
    double scale = 2;
    auto last = find(gentle_, 3, scale);
    while (!last.is_feasible() && scale < 1e4) {
      scale *= 2;
      last = find(gentle_, 3, scale);
    }
    for (double step = 1.5; last.is_feasible() && step > 1.01;) {
      const double narrower = std::max(1.0, scale / step);
      auto next = find(last.motion, 2, narrower);
      if (!next.is_feasible()) {
        next = find(last.motion, 1, narrower);
      }
      if (!next.is_feasible()) {
        step = std::sqrt(step);
      } else if (narrower == 1) {
        return next.motion;
      } else {
        scale = narrower;
        last = std::move(next);
      }
    }
    return {};
  }

  const time_parametrisation_input<N>& problem_;
  const std::vector<joint_cubic<vector>>& curve_;
  motion gentle_;
  jerk_search_result<vector> nearest_;
};

/// Near-minimum-time motion along a curve within velocity, acceleration and jerk limits.
///
/// \throws invalid_input for velocities at ends with which no motion is found
template <int N>
[[nodiscard]] auto
timed_within_jerks(const time_parametrisation_input<N>& problem,
                   const std::vector<joint_cubic<joint_vector<double, N>>>& curve) {
  require_smooth(problem, curve);
  require_feasible_ends(problem, curve);
  jerk_search<N> search(problem, curve);
  if (auto result = search.run()) {
    return *result;
  }
  const auto& nearest = search.nearest();
  const std::size_t end = nearest.end(), joint = nearest.nearest_joint;
  raise(invalid_input(message("duet: time_optimal_trajectory: the ", end == 0 ? "initial" : "final",
                              " velocities are too large for the limits (expected at most ",
                              std::floor(1e4 * nearest.reached[end]) / 1e4, " of them; joint ",
                              joint, ", with the velocity ",
                              end_velocities(problem, curve)[end][Eigen::Index(joint)],
                              ", is nearest to its limits)")));
}

/// Minimum-time motion along a curve, as `joint_trajectory`.
template <int N>
[[nodiscard]] joint_trajectory<N>
timed(const time_parametrisation_input<N>& problem,
      const std::vector<joint_cubic<joint_vector<double, N>>>& curve) {
  auto path = problem.jerk.array().isInf().all() ? timed_by_accelerations(problem, curve)
                                                 : timed_within_jerks(problem, curve);
  std::vector<double> times; // times at the waypoints
  double s = 0;
  for (const auto& piece : path.pieces) {
    const double h = piece.path.length;
    // Segments end where edges do, to round-off.
    while (times.size() < problem.waypoints &&
           problem.polygon.waypoint_s[times.size()] < s + h / 2) {
      times.push_back(piece.scaling.time);
    }
    s += h;
  }
  times.resize(problem.waypoints, path.duration);
  return joint_trajectory<N>(std::move(path.pieces), std::move(times));
}

} // namespace duet::detail
