// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Whether `time_optimal_trajectory` with jerk limits finds motions that are known to exist, with
/// velocities at both ends: along segments of motions from rest to rest, with the velocities of
/// these motions. Prints the table of docs/reference/benchmarks.md. Argument: number of seeds of
/// each family, with four segments each (50); build/bench/bench/duet_jerk_limits_in_motion_bench 50

#include "../src/robotics/timed_curve.hpp"
#include "timing_families.hpp"

#include <duet/core/errors.hpp>
#include <duet/robotics/time_parametrised.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

using namespace timing_bench;
using timing = duet::detail::time_parametrisation_input;
using motion = duet::detail::timed_path;

/// Arc length and path velocity of a motion at a time.
std::array<double, 2> state_at(const motion& path, double t) {
  double s = 0;
  std::size_t i = 0;
  for (; i + 1 < path.pieces.size() && path.pieces[i + 1].scaling.time <= t; ++i) {
    s += path.pieces[i].path.length;
  }
  const auto state = path.pieces[i].scaling.at(t, path.pieces[i].path.length);
  return {s + state.s, state.speed};
}

/// Largest fraction of a limit that is used, at 1000 times.
double max_fraction(const duet::joint_trajectory& q, const timing& limits) {
  double result = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double t = q.duration() * i / 1000;
    const auto now = q(t);
    result = std::max({result, now.velocity.cwiseQuotient(limits.velocity).cwiseAbs().maxCoeff(),
                       now.acceleration.cwiseQuotient(limits.acceleration).cwiseAbs().maxCoeff(),
                       q.jerk(t).cwiseQuotient(limits.jerk).cwiseAbs().maxCoeff()});
  }
  return result;
}

/// Input for the segment of a motion between two times; `path` becomes the curve of the segment.
timing part_of(timing problem, curve& path, const motion& complete, double from, double to) {
  const bool starts = from <= 0, ends = to >= complete.duration;
  auto& s = problem.polygon.s;
  const auto [first, first_speed] = starts ? std::array{0.0, 0.0} : state_at(complete, from);
  const auto [last, last_speed] = ends ? std::array{s.back(), 0.0} : state_at(complete, to);
  curve piece;
  std::vector<double> knots{0};
  for (std::size_t e = 0; e < path.size(); ++e) {
    const double begin = std::max(s[e], first), end = std::min(s[e + 1], last);
    if (end - begin > 1e-12 * s.back()) {
      piece.push_back(path[e].part(begin - s[e], end - begin));
      knots.push_back(knots.back() + end - begin);
    }
  }
  path = piece;
  problem.polygon.s = problem.polygon.waypoint_s = knots;
  problem.waypoints = knots.size();
  problem.initial_speed = first_speed;
  problem.final_speed = last_speed;
  return problem;
}

void compare(unsigned seeds) {
  std::printf("| | pieces | refused | duration | longest (seed) | largest share | ms | longest |\n"
              "|---|---|---|---|---|---|---|---|\n");
  for (const family& kind : families) {
    statistics longer, fraction, slowest;
    stopwatch watch;
    int pieces = 0, infeasible = 0;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      const problem p = problem_of(kind, seed);
      random_source random(seed + 1000);
      std::vector<double> jerk;
      for (Eigen::Index i = 0; i < p.velocity.size(); ++i) {
        jerk.push_back(random.log_uniform(3, 300));
      }
      const timing problem = duet::detail::validated_input(
          duet::detail::waypoints_of(p.waypoints), p.velocity, p.acceleration,
          duet::time_parametrisation_options{.jerk = jerk});
      const curve path = duet::detail::hermite_curve(
          problem.polygon, duet::detail::natural_cubic_slopes(problem.polygon));
      const motion complete = duet::detail::timed_within_jerks(problem, path);
      for (int k = 0; k < 4; ++k) {
        double from = random.uniform(0, .99), to = random.uniform(from + .01, 1);
        if (k == 1) { // short
          to = std::min(1.0, from + random.log_uniform(1e-3, .1));
        } else if (k == 2) {
          (seed % 2 == 0 ? from : to) = seed % 2 == 0 ? 0 : 1;
        }
        const double time = (to - from) * complete.duration;
        curve piece = path;
        const timing part =
            part_of(problem, piece, complete, from * complete.duration, to * complete.duration);
        ++pieces;
        try {
          stopwatch single;
          const auto q =
              watch.of([&] { return single.of([&] { return duet::detail::timed(part, piece); }); });
          slowest.add(single.median(), seed);
          longer.add(q.duration() / time, seed);
          fraction.add(max_fraction(q, part), seed);
        } catch (const duet::invalid_input&) {
          ++infeasible;
        }
      }
    }
    std::printf("| %s | %d | %d | %.4f | %.4f (%u) | 1 %+.0e | %.0f | %.0f |\n", kind.name, pieces,
                infeasible, longer.sum / (pieces - infeasible), longer.worst, longer.seed,
                fraction.worst - 1, watch.median(), slowest.worst);
    std::fflush(stdout);
  }
}

} // namespace

int main(int argc, char** argv) { compare(argc > 1 ? unsigned(std::atoi(argv[1])) : 50); }
