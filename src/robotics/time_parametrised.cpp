// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "timed_curve.hpp"

#include <duet/core/errors.hpp>
#include <duet/kinematics/chain_view.hpp>
#include <duet/robotics/time_parametrised.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

namespace {

/// Maximum distance of joint i from [lower, upper] inside an edge; 0 if the joint stays within.
double range_violation(const joint_cubic& q, Eigen::Index i, double lower, double upper) {
  double result = 0;
  const auto check_at = [&](double s) {
    if (s > 0 && s < q.length) {
      const double x = q.c0[i] + s * (q.c1[i] + s * (q.c2[i] + s * q.c3[i]));
      result = std::max({result, lower - x, x - upper});
    }
  };
  // Zeros of the slope c1 + 2 c2 s + 3 c3 s².
  const double root = q.c2[i] * q.c2[i] - 3 * q.c1[i] * q.c3[i];
  if (root >= 0) {
    const double u = -(q.c2[i] + std::copysign(std::sqrt(root), q.c2[i]));
    check_at(u / (3 * q.c3[i]));
    check_at(q.c1[i] / u);
  }
  return result;
}

Eigen::VectorXd validated_limits(const Eigen::VectorXd& limits, const char* name, Eigen::Index n,
                                 bool may_be_infinite) {
  require(limits.size() == n, "duet: time_optimal_trajectory: ", limits.size(), " ", name,
          " limits (expected ", n, ", one per joint)");
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = limits[i];
    require(x > 0 && (may_be_infinite || x - x == 0), "duet: time_optimal_trajectory: the ", name,
            " limit of joint ", i, " is ", x, " (expected positive",
            may_be_infinite ? ")" : " and finite)");
  }
  return limits;
}

/// Path velocity ṡ at an end; the slope of the path there becomes the direction of the
/// given joint velocities.
double speed_of(const std::vector<double>& velocities, const char* which, Eigen::VectorXd& slope) {
  if (velocities.empty()) {
    return 0;
  }
  require(Eigen::Index(velocities.size()) == slope.size(),
          "duet: time_optimal_trajectory: ", velocities.size(), " ", which,
          " velocities (expected ", slope.size(), ", one per joint)");
  const Eigen::VectorXd velocity =
      Eigen::Map<const Eigen::VectorXd>(velocities.data(), slope.size());
  const double speed = velocity.norm();
  require(speed - speed == 0, "duet: time_optimal_trajectory: the ", which,
          " velocities are not finite");
  if (speed > 0) {
    slope = velocity / speed;
  }
  return speed;
}

} // namespace

joint_polygon::joint_polygon(const std::vector<Eigen::VectorXd>& waypoints)
    : points{waypoints.front()}, s{0.0},
      first_slope(Eigen::VectorXd::Zero(waypoints.front().size())), last_slope(first_slope) {
  for (const Eigen::VectorXd& each : waypoints) {
    const double distance = (each - points.back()).norm();
    if (distance > 1e-10 * (1 + each.norm())) {
      points.push_back(each);
      s.push_back(s.back() + distance);
    }
    waypoint_s.push_back(s.back());
  }
}
std::vector<Eigen::VectorXd> pchip_slopes(const joint_polygon& polygon) {
  std::vector<Eigen::VectorXd> slopes{polygon.first_slope.isZero(0) ? polygon.chord(0)
                                                                    : polygon.first_slope};
  for (std::size_t k = 1; k < polygon.edges(); ++k) {
    const Eigen::VectorXd before = polygon.chord(k - 1), after = polygon.chord(k);
    const double left = polygon.length(k - 1), right = polygon.length(k);
    const double w_before = 2 * right + left, w_after = right + 2 * left;
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(before.size());
    for (Eigen::Index i = 0; i < slope.size(); ++i) {
      if (before[i] * after[i] > 0) {
        slope[i] = (w_before + w_after) / (w_before / before[i] + w_after / after[i]);
      }
    }
    slopes.push_back(slope);
  }
  slopes.push_back(polygon.last_slope.isZero(0) ? polygon.chord(polygon.edges() - 1)
                                                : polygon.last_slope);
  return slopes;
}

std::vector<Eigen::VectorXd> natural_cubic_slopes(const joint_polygon& polygon) {
  const std::size_t n = polygon.edges();
  // Forward elimination: row k is slope_k + above_k slope_{k+1} = slopes[k].
  const bool starts_freely = polygon.first_slope.isZero(0),
             ends_freely = polygon.last_slope.isZero(0);
  std::vector<double> above{starts_freely ? .5 : 0};
  std::vector<Eigen::VectorXd> slopes{starts_freely ? Eigen::VectorXd(1.5 * polygon.chord(0))
                                                    : polygon.first_slope};
  for (std::size_t k = 1; k < n; ++k) {
    const double left = polygon.length(k - 1), right = polygon.length(k);
    const double pivot = 2 * (left + right) - right * above.back();
    const Eigen::VectorXd row = 3 * (right * polygon.chord(k - 1) + left * polygon.chord(k));
    slopes.push_back((row - right * slopes.back()) / pivot);
    above.push_back(left / pivot);
  }
  slopes.push_back(
      ends_freely ? Eigen::VectorXd((3 * polygon.chord(n - 1) - slopes.back()) / (2 - above.back()))
                  : polygon.last_slope);
  for (std::size_t k = n; k-- > 0;) {
    slopes[k] -= above[k] * slopes[k + 1];
  }
  return slopes;
}

std::vector<joint_cubic> hermite_curve(const joint_polygon& polygon,
                                       const std::vector<Eigen::VectorXd>& slopes) {
  std::vector<joint_cubic> result;
  for (std::size_t k = 0; k < polygon.edges(); ++k) {
    const double h = polygon.length(k);
    const Eigen::VectorXd chord = polygon.chord(k);
    result.push_back({polygon.points[k], slopes[k],
                      Eigen::VectorXd((3 * chord - 2 * slopes[k] - slopes[k + 1]) / h),
                      Eigen::VectorXd((slopes[k] + slopes[k + 1] - 2 * chord) / (h * h)), h});
  }
  return result;
}

time_parametrisation_input validated_input(const std::vector<Eigen::VectorXd>& waypoints,
                                           const Eigen::VectorXd& velocity,
                                           const Eigen::VectorXd& acceleration,
                                           const time_parametrisation_options& options) {
  require(!waypoints.empty(),
          "duet: time_optimal_trajectory: there are no waypoints (expected at least 1)");
  const Eigen::Index n = waypoints.front().size();
  const Eigen::VectorXd v = validated_limits(velocity, "velocity", n, true);
  const Eigen::VectorXd a = validated_limits(acceleration, "acceleration", n, false);
  const Eigen::VectorXd none =
      Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
  const Eigen::VectorXd j =
      options.jerk.empty()
          ? none
          : validated_limits(Eigen::Map<const Eigen::VectorXd>(options.jerk.data(),
                                                               Eigen::Index(options.jerk.size())),
                             "jerk", n, true);
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    require(waypoints[k].size() == n && waypoints[k].allFinite(),
            "duet: time_optimal_trajectory: waypoint ", k,
            " is not finite or has another size than waypoint 0");
  }
  require(options.min_intervals >= 1, "duet: time_optimal_trajectory: min_intervals is ",
          options.min_intervals, " (expected at least 1)");
  time_parametrisation_input result{joint_polygon(waypoints),
                                    waypoints.size(),
                                    v,
                                    a,
                                    j,
                                    0,
                                    0,
                                    options.min_intervals,
                                    -none,
                                    none};
  result.initial_speed =
      speed_of(options.initial_velocities, "initial", result.polygon.first_slope);
  result.final_speed = speed_of(options.final_velocities, "final", result.polygon.last_slope);
  require(
      result.polygon.edges() > 0 || (result.initial_speed == 0 && result.final_speed == 0),
      "duet: time_optimal_trajectory: all ", waypoints.size(),
      " waypoints coincide (expected zero initial and final velocities on a path of zero length)");
  return result;
}

std::vector<Eigen::VectorXd> slopes_within_ranges(const time_parametrisation_input& problem,
                                                  std::vector<Eigen::VectorXd> slopes) {
  const auto& polygon = problem.polygon;
  const auto safe = pchip_slopes(polygon);
  for (bool is_new = true; is_new;) {
    is_new = false;
    const auto before = slopes;
    const auto curve = hermite_curve(polygon, before);
    for (std::size_t k = 0; k < curve.size(); ++k) {
      for (Eigen::Index i = 0; i < problem.lower.size(); ++i) {
        const double from = polygon.points[k][i], to = polygon.points[k + 1][i];
        const double violation =
            range_violation(curve[k], i, std::min({problem.lower[i], from, to}),
                            std::max({problem.upper[i], from, to}));
        if (violation <= 1e-12 * (1 + std::abs(from))) {
          continue;
        }
        if (before[k][i] == safe[k][i] && before[k + 1][i] == safe[k + 1][i]) {
          const auto next = std::upper_bound(polygon.waypoint_s.begin(), polygon.waypoint_s.end(),
                                             polygon.s[k] + polygon.length(k) / 2) -
                            polygon.waypoint_s.begin();
          raise(invalid_input(message("duet: time_optimal_trajectory: joint ", i,
                                      " leaves its limits by ", violation, " between waypoints ",
                                      next - 1, " and ", next,
                                      " because of its velocity at an end")));
        }
        slopes[k][i] = safe[k][i];
        slopes[k + 1][i] = safe[k + 1][i];
        is_new = true;
      }
    }
  }
  return slopes;
}

namespace {

/// Constraint |y + slope x| ≤ reach on the squared path velocities x = ṡ² at the start of a segment
/// and y at its end.
struct speed_bound {
  double slope, reach;
};

/// Interval of the y between `lower` and `upper` that satisfy all constraints for a given x, from
/// the value of one line at x to that of another.
struct feasible_path_velocities {
  struct line {
    double at_zero, slope, value;
  };
  line lower, upper;

  feasible_path_velocities(std::span<const speed_bound> bounds, double x, double from, double to)
      : lower{from, 0, from}, upper{to, 0, to} {
    for (const auto& [slope, reach] : bounds) {
      const double middle = -slope * x;
      if (middle + reach < upper.value) {
        upper = {reach, -slope, middle + reach};
      }
      if (middle - reach > lower.value) {
        lower = {-reach, -slope, middle - reach};
      }
    }
  }
};

/// Nearest value to x for which some y between `lower` and `upper` satisfies all constraints;
/// NaN if no such y exists. The length of the interval of such y is a concave function of x.
/// Newton's method approaches its nearer zero from outside without passing it, from one pair of
/// active lines to the next.
[[nodiscard]] double nearest_speed(std::span<const speed_bound> bounds, double x, double lower,
                                   double upper) {
  for (double direction = 0;;) {
    const feasible_path_velocities y(bounds, x, lower, upper);
    if (y.lower.value <= y.upper.value) {
      return x;
    }
    const double next = (y.upper.at_zero - y.lower.at_zero) / (y.lower.slope - y.upper.slope);
    const double step = next - x;
    if (!(step * direction > 0) && direction != 0) {
      // Converged to round-off, or between the zeros of a function that has none.
      return std::abs(step) <= 1e-9 * std::abs(x) ? x : std::numeric_limits<double>::quiet_NaN();
    }
    if (!(std::abs(step) < std::numeric_limits<double>::infinity())) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    direction = step > 0 ? 1 : -1;
    x = next;
  }
}

/// Constraints on ṡ² at the starts and ends of the segments of a path, between which it is linear
/// in s.
struct path_bounds {
  std::vector<double> before, after; ///< largest ṡ² that velocity limits admit
  std::vector<speed_bound> bounds;   ///< constraints, as many for each segment
  std::size_t bounds_each;

  /// Collects the constraints by which velocities and accelerations stay within limits on entire
  /// segments. With ṡ² linear in s the acceleration q' s̈ + q'' ṡ² is a quadratic polynomial and
  /// lies between its Bernstein coefficients, which are linear in both ṡ².
  path_bounds(const std::vector<joint_cubic>& parts, const Eigen::VectorXd& velocity,
              const Eigen::VectorXd& acceleration)
      : bounds_each(std::size_t(3 * velocity.size())) {
    before.reserve(parts.size());
    after.reserve(parts.size());
    bounds.reserve(parts.size() * bounds_each);
    for (const joint_cubic& q : parts) {
      before.push_back(1e100);
      after.push_back(1e100);
      const Eigen::VectorXd first = q.first(0), middle = q.c1 + q.length * q.c2,
                            end = q.first(q.length), second = q.second(0),
                            last = q.second(q.length);
      const double half = 1 / (2 * q.length); // s̈ = (y − x) / (2 length)
      for (Eigen::Index i = 0; i < second.size(); ++i) {
        const double a = acceleration[i];
        apply_velocity_limit({first[i], middle[i], end[i]}, velocity[i]);
        add(second[i] - first[i] * half, first[i] * half, a);
        add(last[i] / 2 - middle[i] * half, second[i] / 2 + middle[i] * half, a);
        add(-end[i] * half, last[i] + end[i] * half, a);
      }
    }
  }

  [[nodiscard]] std::size_t size() const { return before.size(); }
  [[nodiscard]] std::span<const speed_bound> of(std::size_t part) const {
    return std::span(bounds).subspan(part * bounds_each, bounds_each);
  }

private:
  /// Adds the constraint |a x + b y| ≤ c, solved for y.
  void add(double a, double b, double c) {
    if (std::abs(b) > 1e-12 * std::abs(a)) [[likely]] {
      const double inverse = 1 / b;
      bounds.push_back({a * inverse, c * std::abs(inverse)});
    } else {
      before.back() = std::min(before.back(), c / std::max(std::abs(a), 1e-100));
      bounds.push_back({0, std::numeric_limits<double>::infinity()});
    }
  }
  /// Applies a velocity limit. If |q'| is below a line from l to r l, ṡ² may be below (limit /
  /// line)², which is a convex function, and is above its chord divided by the largest ratio of the
  /// two. That ratio is attained at (2 r + 1) / (3 r + 3) of the segment.
  void apply_velocity_limit(const std::array<double, 3>& p, double limit) {
    const double l_0 = std::abs(p[0]), l_1 = std::abs(p[1]), l_2 = std::abs(p[2]);
    double at_start = limit / std::max({l_0, l_1, l_2, 1e-50}), at_end = at_start; // ṡ
    if (at_start * at_start >= std::max(before.back(), after.back())) {
      return;
    }
    const double over = std::max(0.0, l_1 - (l_0 + l_2) / 2);
    const double x_0 = l_0 + over, x_1 = l_2 + over, r = x_1 / x_0;
    // Where the line changes much within a segment, its maximum gives a better limit.
    if (r > .5 && r < 2) {
      const double u = (2 * r + 1) / (3 * r + 3), line = 1 + (r - 1) * u;
      const double ratio = line * std::sqrt(1 + (1 / (r * r) - 1) * u);
      at_start = limit / (x_0 * ratio);
      at_end = limit / (x_1 * ratio);
    }
    before.back() = std::min(before.back(), at_start * at_start);
    after.back() = std::min(after.back(), at_end * at_end);
  }
};

/// Maximum squared path velocities, or an infeasible boundary velocity.
struct phase_plane_result {
  std::vector<double> squares = {};       ///< ṡ² at the ends of all segments
  std::optional<int> infeasible_end = {}; ///< 0: start, 1: end; `squares` then has no meaning
  double largest = 0;                     ///< largest ṡ² that is feasible there
};

/// Maximum squared path velocities ṡ² at the ends of all segments. The backward pass finds the
/// range from which the given end can be reached; the forward pass takes the largest values that
/// this range and the constraints admit.
[[nodiscard]] phase_plane_result phase_plane_velocities(const path_bounds& path, double first,
                                                        double last) {
  const std::size_t n = path.size();
  const auto cap = [&](std::size_t i) {
    return std::min(i < n ? path.before[i] : path.after[n - 1],
                    i > 0 ? path.after[i - 1] : path.before[0]);
  };
  std::vector<double> upper(n + 1), lower(n + 1), speeds(n + 1);
  const auto backwards = [&](double lowest, double highest) {
    upper[n] = highest;
    lower[n] = lowest;
    for (std::size_t i = n; i-- > 0;) {
      upper[i] = nearest_speed(path.of(i), cap(i), lower[i + 1], upper[i + 1]);
      if (upper[i] > cap(i)) {
        upper[i] = std::numeric_limits<double>::quiet_NaN();
      }
      lower[i] = lower[i + 1] > 0 ? nearest_speed(path.of(i), 0, lower[i + 1], upper[i + 1]) : 0;
    }
  };
  const auto forwards = [&] {
    speeds[0] = first;
    for (std::size_t i = 0; i < n; ++i) {
      speeds[i + 1] = std::max(
          0.0,
          feasible_path_velocities(path.of(i), speeds[i], lower[i + 1], upper[i + 1]).upper.value);
    }
    return speeds[n];
  };
  constexpr double tolerance = 1 + 1e-9;
  backwards(last, last);
  if (first <= upper[0] * tolerance && first * tolerance >= lower[0] &&
      last <= cap(n) * tolerance) {
    forwards();
    return {std::move(speeds)};
  }
  backwards(0, std::min(last, cap(n)));
  if (first > upper[0] * tolerance) {
    return {{}, 0, upper[0]};
  }
  backwards(0, cap(n));
  return {{}, 1, forwards()};
}

/// Segments of a curve with constant s̈ each: their number is proportional to the length, but at
/// least sixteen per edge; they are shorter towards the ends of edges, where the second derivative
/// or its slope jumps. Eight are enough on an edge between nearly equal waypoints, as s̈ = (y −
/// x)/(2h) suffers from cancellation in short segments.
[[nodiscard]] std::vector<joint_cubic> parts_of(const std::vector<joint_cubic>& curve,
                                                double length, int parts) {
  std::vector<joint_cubic> result;
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

/// Motion with given squared path velocities ṡ² at the ends of segments.
[[nodiscard]] timed_path timed_by_squares(const std::vector<joint_cubic>& parts,
                                          const std::vector<double>& squares) {
  timed_path result;
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

/// Largest fraction of an acceleration limit that a motion uses, by Bernstein coefficients.
[[nodiscard]] double largest_fraction(const timed_path& motion, const Eigen::VectorXd& limits) {
  double result = 0;
  for (const auto& [scaling, q] : motion.pieces) {
    const double x = scaling.speed * scaling.speed, y = x + 2 * q.length * scaling.acceleration;
    const Eigen::VectorXd second = q.second(0), last = q.second(q.length);
    for (const Eigen::VectorXd& coefficient :
         {Eigen::VectorXd(scaling.acceleration * q.first(0) + x * second),
          Eigen::VectorXd(scaling.acceleration * (q.c1 + q.length * q.c2) + x / 2 * last +
                          y / 2 * second),
          Eigen::VectorXd(scaling.acceleration * q.first(q.length) + y * last)}) {
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
[[nodiscard]] timed_path timed_by_accelerations(const time_parametrisation_input& problem,
                                                const std::vector<joint_cubic>& curve) {
  const auto parts = parts_of(curve, problem.polygon.s.back(), problem.parts);
  const double first = problem.initial_speed, last = problem.final_speed;
  Eigen::VectorXd limits = problem.acceleration;
  std::optional<timed_path> result;
  for (int round = 0; round < 8; ++round) {
    const auto [squares, infeasible_end, largest] = phase_plane_velocities(
        path_bounds(parts, problem.velocity, limits), first * first, last * last);
    if (result && infeasible_end) {
      break; // velocities at their limits
    }
    require(!infeasible_end, "duet: time_optimal_trajectory: the ",
            infeasible_end == 0 ? "initial" : "final",
            " velocities are infeasible (expected at most ",
            std::floor(9999 * std::sqrt(largest) / (infeasible_end == 0 ? first : last)) / 1e4,
            " times as large)");
    result = timed_by_squares(parts, squares);
    const double excess = largest_fraction(*result, problem.acceleration) - 1;
    if (!(excess > 1e-13)) {
      break;
    }
    limits /= 1 + 2 * excess;
  }
  return *result;
}

} // namespace

timed_path min_acceleration_motion(const time_parametrisation_input& problem,
                                   const std::vector<joint_cubic>& curve) {
  const auto parts = parts_of(curve, problem.polygon.s.back(), problem.parts);
  std::array<double, 2> ends{problem.initial_speed * problem.initial_speed,
                             problem.final_speed * problem.final_speed};
  phase_plane_result found;
  const auto is_feasible = [&](double scale) {
    found = phase_plane_velocities(
        path_bounds(parts, problem.velocity, scale * problem.acceleration), ends[0], ends[1]);
    return !found.infeasible_end;
  };
  while (!is_feasible(1)) {
    ends[std::size_t(*found.infeasible_end)] = found.largest > 0 ? .99 * found.largest : 0;
  }
  if (ends[0] + ends[1] > 0) {
    double low = 1e-4, high = 1;
    for (int i = 0; i < 8; ++i) {
      const double middle = std::sqrt(low * high);
      (is_feasible(middle) ? high : low) = middle;
    }
    (void)is_feasible(high);
  }
  return timed_by_squares(parts, found.squares);
}

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
