// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/planning/joint_trajectory.hpp>
#include <duet/planning/timing/jerk_limited.hpp>
#include <duet/planning/timing/path_speeds.hpp>
#include <duet/planning/timing/timing_problem.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// From curves to trajectories. For those who extend duet.

namespace duet::detail {

/// The parts of a curve that have an s̈ of their own: in proportion to the length, but sixteen on
/// each edge; there shorter towards the ends, where the second derivative or its slope jumps.
template <class V>
[[nodiscard]] std::vector<joint_cubic<V>> parts_of(const std::vector<joint_cubic<V>>& curve,
                                                   double length, int parts) {
  std::vector<joint_cubic<V>> result;
  for (const auto& edge : curve) {
    const double count = std::max(16.0, std::ceil(edge.length / length * parts));
    const auto place = [&](double k) {
      const double u = k / count;
      return edge.length * (u * u * (3 - 2 * u));
    };
    for (double k = 0; k < count; ++k) {
      result.push_back(edge.part(place(k), place(k + 1) - place(k)));
    }
  }
  return result;
}

/// \throws invalid_input if there is a refusal, with the part of the rates that is allowed
inline void require_rates(const speed_refusal& refusal, double first, double last) {
  if (refusal.at_start || refusal.at_end) {
    const double asked = refusal.at_start ? first : last;
    raise(invalid_input(message(
        "duet: time_parametrised: the ", refusal.at_start ? "initial" : "final",
        " rates are too fast: at most ",
        std::floor(9999 * std::sqrt(refusal.largest) / asked) / 1e4, " of them can be kept")));
  }
}

/// The fastest motion along a curve with constant s̈ in each part.
template <int N>
[[nodiscard]] auto
timed_by_accelerations(const timing_problem<N>& problem,
                       const std::vector<joint_cubic<joint_vector<double, N>>>& curve) {
  const auto parts = parts_of(curve, problem.polygon.s.back(), problem.parts);
  path_bounds bounds(problem.velocity.size());
  bounds.reserve(parts.size());
  for (const auto& part : parts) {
    bounds.add(part, problem.velocity, problem.acceleration);
  }
  const double first = problem.initial_speed, last = problem.final_speed;
  speed_refusal refusal;
  const std::vector<double> squares = path_speeds(bounds, first * first, last * last, refusal);
  require_rates(refusal, first, last);
  timed_path<joint_vector<double, N>> result;
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

/// The fastest motion along a curve, as `joint_trajectory`.
template <int N>
[[nodiscard]] joint_trajectory<N>
timed(const timing_problem<N>& problem,
      const std::vector<joint_cubic<joint_vector<double, N>>>& curve) {
  auto path = timed_by_accelerations(problem, curve);
  if (!problem.jerk.array().isInf().all()) {
    path = timed_by_jerks(problem, curve, path);
  }
  std::vector<double> times; // of the waypoints
  double s = 0;
  for (const auto& piece : path.pieces) {
    const double h = piece.path.length;
    // Pieces end where edges do, to rounding.
    while (times.size() < problem.waypoints && problem.polygon.given_at[times.size()] < s + h / 2) {
      times.push_back(piece.law.time);
    }
    s += h;
  }
  times.resize(problem.waypoints, path.duration);
  return joint_trajectory<N>(std::move(path.pieces), std::move(times));
}

} // namespace duet::detail
