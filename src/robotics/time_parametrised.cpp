// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "timing/joint_paths.hpp"
#include "timing/timed_curve.hpp"

#include <duet/kinematics/chain_view.hpp>
#include <duet/robotics/time_parametrised.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <utility>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

joint_trajectory timed(const time_parametrisation_input& problem,
                       const std::vector<joint_cubic>& curve) {
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
  return joint_trajectory(std::move(path.pieces), std::move(times));
}

namespace {

[[nodiscard]] joint_trajectory timed_along(const time_parametrisation_input& input,
                                           waypoint_interpolation curve) {
  const joint_polygon& polygon = input.polygon;
  if (polygon.edges() == 0) {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(input.velocity.size());
    return joint_trajectory({{{0, 0, 0}, {polygon.points[0], zero, zero, zero, 0}}},
                            std::vector<double>(input.waypoints, 0.0));
  }
  const auto slopes = curve == waypoint_interpolation::natural_cubic ? natural_cubic_slopes(polygon)
                                                                     : pchip_slopes(polygon);
  return timed(input, hermite_curve(polygon, slopes_within_ranges(input, slopes)));
}

} // namespace

joint_trajectory timed_along_waypoints(const std::vector<Eigen::VectorXd>& waypoints,
                                       const Eigen::VectorXd& velocity,
                                       const Eigen::VectorXd& acceleration,
                                       const time_parametrisation_options& options) {
  return timed_along(validated_input(waypoints, velocity, acceleration, options),
                     options.curve.value_or(options.jerk.empty()
                                                ? waypoint_interpolation::pchip
                                                : waypoint_interpolation::natural_cubic));
}

joint_trajectory timed_within_limits(const chain_view& chain,
                                     const std::vector<Eigen::VectorXd>& waypoints,
                                     const Eigen::VectorXd& acceleration,
                                     const time_parametrisation_options& options) {
  Eigen::VectorXd velocity(chain.size());
  for (int i = 0; i < chain.size(); ++i) {
    velocity[i] = chain.limits(i).velocity;
  }
  auto input = validated_input(waypoints, velocity, acceleration, options);
  for (int i = 0; i < chain.size(); ++i) {
    input.lower[i] = chain.limits(i).lower;
    input.upper[i] = chain.limits(i).upper;
  }
  return timed_along(input, options.curve.value_or(waypoint_interpolation::natural_cubic));
}

DUET_ABI_END
} // namespace duet::detail
