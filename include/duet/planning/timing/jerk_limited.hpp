// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/planning/joint_trajectory.hpp>
#include <duet/planning/timing/pace_bounds.hpp>
#include <duet/planning/timing/pace_search.hpp>
#include <duet/planning/timing/reference_law.hpp>
#include <duet/planning/timing/timing_problem.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// \file
/// Motions from rest to rest within limits of jerk. For those who extend duet.

namespace duet::detail {

/// Parts of a path one after another, and how long they take together.
template <class V>
struct timed_path {
  std::vector<timed_piece<V>> pieces;
  double duration = 0;
};

/// Where on a path a motion is at n + 1 times that divide it evenly.
template <class V>
[[nodiscard]] std::vector<double> places_of(const timed_path<V>& path, std::size_t n,
                                            double length) {
  std::vector<double> result;
  std::size_t at = 0;
  double s = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = path.duration * double(i) / double(n);
    for (; at + 1 < path.pieces.size() && path.pieces[at + 1].law.time <= t; ++at) {
      s += path.pieces[at].path.length;
    }
    const auto& [law, edge] = path.pieces[at];
    result.push_back(std::min(s + law.at(t, edge.length).s, length));
  }
  result.push_back(length);
  return result;
}

/// How long τ takes over a length where τ̇² is a quadratic polynomial, ∫ dτ / τ̇.
[[nodiscard]] inline double time_over(double length, double first_rate, double last_rate,
                                      double curvature) {
  const double half = length / (first_rate + last_rate);
  const double omega = std::sqrt(std::abs(curvature)), angle = omega * half;
  const double ratio = angle < 1e-9    ? 1
                       : curvature > 0 ? std::atanh(angle) / angle
                                       : std::atan(angle) / angle;
  return 2 * half * ratio;
}

/// \throws invalid_input for rates at ends, and where second derivatives jump
template <int N>
void require_smooth(const timing_problem<N>& problem,
                    const std::vector<joint_cubic<joint_vector<double, N>>>& curve) {
  require(problem.initial_speed == 0 && problem.final_speed == 0,
          "duet: time_parametrised: with limits of jerk motions are from rest to rest, without "
          "rates at ends");
  for (std::size_t k = 1; k < curve.size(); ++k) {
    const auto &before = curve[k - 1], &after = curve[k];
    const auto jump = (after.second(0) - before.second(before.length)).eval();
    Eigen::Index joint = 0;
    const double largest = jump.cwiseAbs().maxCoeff(&joint);
    if (largest * std::min(before.length, after.length) > 1e-9) {
      const auto& at = problem.polygon.given_at;
      const auto given = std::lower_bound(at.begin(), at.end(), problem.polygon.s[k]) - at.begin();
      raise(invalid_input(message("duet: time_parametrised: limits of jerk ask for a curve with "
                                  "continuous second derivatives, as joint_curve::smooth where no "
                                  "joint leaves its range: at waypoint ",
                                  given, " that of joint ", joint, " jumps")));
    }
  }
}

/// The motion along a curve as a pace over n intervals of a path's parameter says.
template <class V>
[[nodiscard]] timed_path<V> timed_by_pace(const std::vector<joint_cubic<V>>& curve,
                                          const std::vector<reference_piece>& path, std::size_t n,
                                          const std::vector<double>& pace) {
  timed_path<V> result;
  result.pieces.reserve(path.size());
  for (const auto& [edge, interval, from, l, start, a, b, c] : path) {
    const auto rows = pace_powers(interval, n);
    const double* of = &pace[interval];
    const double curvature = times(rows[2], of), rise = times(rows[1], of) + 2 * from * curvature;
    const double before = times(rows[0], of) + from * (times(rows[1], of) + from * curvature);
    const double rate = std::sqrt(before),
                 end_rate = std::sqrt(before + l * (rise + l * curvature));
    result.pieces.push_back({{result.duration, rate, rise / 2, curvature, a, b, c},
                             curve[edge].part(start, l * (a + l * (b + l * c)))});
    result.duration += time_over(l, rate, end_rate, curvature);
  }
  return result;
}

/// A fast motion from rest to rest that keeps limits of jerk as well: its pace over a parameter
/// that is in proportion to the times of a motion without them, then to those of what is found.
template <int N>
[[nodiscard]] auto timed_by_jerks(const timing_problem<N>& problem,
                                  const std::vector<joint_cubic<joint_vector<double, N>>>& curve,
                                  timed_path<joint_vector<double, N>> motion) {
  require_smooth(problem, curve);
  const auto& knots = problem.polygon.s;
  for (const int share : {6, 3, 2}) {
    const auto intervals = std::size_t(std::max(16, problem.parts / share));
    const reference_law law(places_of(motion, intervals, knots.back()));
    const auto path = law.pieces(knots);
    const pace_bounds bounds(curve, path, intervals, problem.velocity, problem.acceleration,
                             problem.jerk);
    pace_search search(bounds);
    motion = timed_by_pace(curve, path, intervals, search.quickest());
  }
  return motion;
}

} // namespace duet::detail
