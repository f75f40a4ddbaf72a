// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "timing/timed_curve.hpp"

#include <duet/core/errors.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

namespace {

/// Time ∫ dτ / τ̇ over an interval of τ on which the squared path velocity τ̇² is a
/// quadratic polynomial.
[[nodiscard]] double time_over(double length, double first_rate, double last_rate,
                               double curvature) {
  const double half = length / (first_rate + last_rate);
  const double omega = std::sqrt(std::abs(curvature)), angle = omega * half;
  const double ratio = angle < 1e-9    ? 1
                       : curvature > 0 ? std::atanh(angle) / angle
                                       : std::atan(angle) / angle;
  return 2 * half * ratio;
}

/// Checks that second derivatives of a curve are continuous, as finite jerks require.
///
/// \throws invalid_input where second derivatives jump
void require_smooth(const time_parametrisation_input& problem,
                    const std::vector<joint_cubic>& curve) {
  for (std::size_t k = 1; k < curve.size(); ++k) {
    const auto &before = curve[k - 1], &after = curve[k];
    const auto jump = (after.second(0) - before.second(before.length)).eval();
    Eigen::Index joint = 0;
    const double largest = jump.cwiseAbs().maxCoeff(&joint);
    if (largest * std::min(before.length, after.length) > 1e-9) {
      const auto& at = problem.polygon.waypoint_s;
      const auto waypoint =
          std::lower_bound(at.begin(), at.end(), problem.polygon.s[k]) - at.begin();
      raise(invalid_input(
          message("duet: time_optimal_trajectory: the second derivative of joint ", joint,
                  " jumps at waypoint ", waypoint,
                  " (with jerk limits expected continuous, as of "
                  "waypoint_interpolation::natural_cubic if no joint leaves its range)")));
    }
  }
}

/// Velocities of all joints at the first and the last end of a curve.
[[nodiscard]] std::array<Eigen::VectorXd, 2>
end_velocities(const time_parametrisation_input& problem, const std::vector<joint_cubic>& curve) {
  const auto& last = curve.back();
  return {problem.initial_speed * curve.front().first(0),
          problem.final_speed * last.first(last.length)};
}

/// Checks the joint velocities at both ends against their limits.
///
/// \throws invalid_input for a velocity at an end that exceeds its limit by more than round-off
void require_feasible_ends(const time_parametrisation_input& problem,
                           const std::vector<joint_cubic>& curve) {
  const auto velocities = end_velocities(problem, curve);
  for (const bool is_last : {false, true}) {
    for (Eigen::Index i = 0; i < problem.velocity.size(); ++i) {
      require(std::abs(velocities[is_last][i]) <= problem.velocity[i] * (1 + 1e-12),
              "duet: time_optimal_trajectory: the ", is_last ? "final" : "initial",
              " velocity of joint ", i, " is ", velocities[is_last][i], " (expected at most ",
              problem.velocity[i], " in absolute value)");
    }
  }
}

/// Result of a search for a squared path velocity within velocity, acceleration and jerk limits.
struct jerk_search_result {
  timed_path motion;
  std::array<double, 2> reached{}; ///< fraction of the velocity at each end; 1: attained
  std::size_t nearest_joint = 0;   ///< joint whose limits are the nearest

  /// End at which the smaller fraction of the velocities is attained.
  [[nodiscard]] std::size_t end() const { return reached[1] < reached[0]; }
  [[nodiscard]] bool is_feasible() const { return reached[end()] == 1; }
};

/// Near-minimum-time trajectory within velocity, acceleration and jerk limits. Its squared path
/// velocity is a B-spline of a parameter τ that is proportional to the time of another motion, in a
/// given number of intervals.
///
/// \param motion    motion that defines τ
/// \param accuracy  as of `minimum_time_path_velocity`
[[nodiscard]] jerk_search_result timed_by_jerks(const time_parametrisation_input& problem,
                                                const std::vector<joint_cubic>& curve,
                                                const timed_path& motion, std::size_t intervals,
                                                double accuracy) {
  const auto& knots = problem.polygon.s;
  const std::array<double, 2> speeds{problem.initial_speed, problem.final_speed};
  const reference_parametrisation reference(arc_lengths_of(motion, intervals, knots.back()),
                                            {speeds[0] == 0, speeds[1] == 0});
  const auto path = reference.pieces(knots);
  const path_velocity_constraints bounds(curve, path, intervals, problem.velocity,
                                         problem.acceleration, problem.jerk);
  std::array<double, 2> ends{};
  for (std::size_t e = 0; e < 2; ++e) {
    const double rate = speeds[e] / (e == 0 ? reference.first_slope() : reference.last_slope());
    ends[e] = speeds[e] > 0 ? rate * rate : 0;
  }
  const path_velocity_result velocities = minimum_time_path_velocity(bounds, ends, accuracy);
  jerk_search_result result;
  result.reached = {std::sqrt(velocities.reached[0]), std::sqrt(velocities.reached[1])};
  result.nearest_joint = velocities.nearest_joint;
  result.motion = trajectory_from_path_velocity(curve, path, intervals, velocities.coefficients);
  return result;
}

/// Search for motions within jerk limits with given velocities at both ends. It proceeds from a
/// motion with small accelerations by successive refinement, each result being the initial guess
/// (warm start) of the next. If that fails it starts with jerk limits relaxed until it succeeds and
/// tightens them step by step, so that the velocities at the ends are right throughout.
class jerk_search {
public:
  jerk_search(const time_parametrisation_input& problem, const std::vector<joint_cubic>& curve)
      : problem_(problem), curve_(curve), gentle_(min_acceleration_motion(problem, curve)) {}

  /// Motion within the limits; empty if none is found.
  [[nodiscard]] std::optional<timed_path> run() {
    std::optional<timed_path> result;
    timed_path last = gentle_;
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
  [[nodiscard]] const jerk_search_result& nearest() const { return nearest_; }

private:
  /// Searches with jerk limits multiplied by `scale`, coarsely if that is not 1.
  [[nodiscard]] jerk_search_result find(const timed_path& from, double divisor, double scale) {
    time_parametrisation_input loose = problem_;
    loose.jerk *= scale;
    return timed_by_jerks(loose, curve_, from,
                          std::size_t(std::max(16.0, problem_.parts / divisor)),
                          scale > 1 ? 200 : 5e4);
  }
  [[nodiscard]] std::optional<timed_path> narrowed() {
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

  const time_parametrisation_input& problem_;
  const std::vector<joint_cubic>& curve_;
  timed_path gentle_;
  jerk_search_result nearest_;
};

} // namespace

std::vector<double> arc_lengths_of(const timed_path& path, std::size_t n, double length) {
  std::vector<double> result;
  std::size_t at = 0;
  double s = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = path.duration * double(i) / double(n);
    for (; at + 1 < path.pieces.size() && path.pieces[at + 1].scaling.time <= t; ++at) {
      s += path.pieces[at].path.length;
    }
    const auto& [scaling, edge] = path.pieces[at];
    result.push_back(std::min(s + scaling.at(t, edge.length).s, length));
  }
  result.push_back(length);
  return result;
}

timed_path trajectory_from_path_velocity(const std::vector<joint_cubic>& curve,
                                         const std::vector<reference_piece>& path, std::size_t n,
                                         const std::vector<double>& squared_velocity) {
  timed_path result;
  result.pieces.reserve(path.size());
  for (const auto& [edge, interval, from, l, start, a, b, c] : path) {
    const auto rows = path_velocity_powers(interval, n);
    const double* of = &squared_velocity[interval];
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

timed_path timed_within_jerks(const time_parametrisation_input& problem,
                              const std::vector<joint_cubic>& curve) {
  require_smooth(problem, curve);
  require_feasible_ends(problem, curve);
  jerk_search search(problem, curve);
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

DUET_ABI_END
} // namespace duet::detail
