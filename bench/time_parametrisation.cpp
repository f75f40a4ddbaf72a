// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Durations of `time_optimal_trajectory` relative to the minimum time with limits sampled on 20
/// 000 segments or more of the same curve, and of natural cubic splines. Prints the table of
/// docs/reference/benchmarks.md. Argument: number of seeds of each family (100);
/// build/bench/bench/duet_time_parametrisation_bench 10

#include "../src/robotics/timed_curve.hpp"
#include "timing_families.hpp"

#include <duet/robotics/time_parametrised.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

namespace {

using namespace timing_bench;

curve pchip_curve(const problem& p) {
  const duet::detail::joint_polygon polygon(duet::detail::waypoints_of(p.waypoints));
  return duet::detail::hermite_curve(polygon, duet::detail::pchip_slopes(polygon));
}

/// Natural cubic spline over the length of the polygon, by its second derivatives.
curve natural_cubic_curve(const problem& p) {
  std::vector<vector> points;
  for (const vector& each : p.waypoints) {
    if (points.empty() || (each - points.back()).norm() > 1e-12) {
      points.push_back(each);
    }
  }
  const Eigen::Index m = Eigen::Index(points.size()) - 1, n = points[0].size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(m + 1, m + 1);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(m + 1, n);
  std::vector<double> h;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    h.push_back((points[k + 1] - points[k]).norm());
  }
  for (Eigen::Index k = 1; k < m; ++k) {
    const auto i = std::size_t(k);
    matrix.row(k).segment(k - 1, 3) << h[i - 1], 2 * (h[i - 1] + h[i]), h[i];
    right.row(k) =
        6 * ((points[i + 1] - points[i]) / h[i] - (points[i] - points[i - 1]) / h[i - 1]);
  }
  const Eigen::MatrixXd second = matrix.partialPivLu().solve(right);
  curve result;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const vector a = second.row(Eigen::Index(k)), b = second.row(Eigen::Index(k) + 1);
    result.push_back({points[k],
                      vector((points[k + 1] - points[k]) / h[k] - h[k] / 6 * (2 * a + b)),
                      vector(a / 2), vector((b - a) / (6 * h[k])), h[k]});
  }
  return result;
}

/// Minimum time along a curve with the limits sampled at both ends of each of 20 000 segments or
/// more, at least 400 between waypoints, by bisection.
double reference(const curve& path, const vector& velocity, const vector& acceleration) {
  double length = 0;
  for (const auto& edge : path) {
    length += edge.length;
  }
  struct part {
    double h, cap_0, cap_1;
    std::vector<std::array<double, 3>> bounds; // |a x + b y| ≤ c
  };
  std::vector<part> parts;
  for (const auto& edge : path) {
    const int count = std::max(400, int(20000 * edge.length / length));
    for (int i = 0; i < count; ++i) {
      part next{edge.length / count, 1e100, 1e100, {}};
      for (const int end : {0, 1}) {
        const double s = edge.length * (i + end) / count;
        const vector first = edge.first(s), second = edge.second(s);
        double& cap = end == 0 ? next.cap_0 : next.cap_1;
        for (Eigen::Index j = 0; j < first.size(); ++j) {
          const double change = first[j] / (2 * next.h);
          next.bounds.push_back({(end == 0 ? second[j] : 0) - change,
                                 (end == 1 ? second[j] : 0) + change, acceleration[j]});
          cap = std::min(cap, std::pow(velocity[j] / std::max(std::abs(first[j]), 1e-50), 2));
        }
      }
      parts.push_back(std::move(next));
    }
  }
  const auto range = [](const part& at, double x, double max_squared_velocity) {
    double low = 0, high = max_squared_velocity;
    for (const auto& [a, b, c] : at.bounds) {
      const double middle = -a * x / b, reach = std::abs(c / b);
      if (b != 0) {
        low = std::max(low, middle - reach);
        high = std::min(high, middle + reach);
      } else if (std::abs(a) * x > c) {
        high = -1;
      }
    }
    return std::pair(low, high);
  };
  const std::size_t n = parts.size();
  std::vector<double> max_squared_velocity(n + 1, 0.0);
  for (std::size_t i = n; i-- > 1;) {
    double low = 0, high = std::min(parts[i].cap_0, parts[i - 1].cap_1);
    const auto is_allowed = [&](double x) {
      const auto [from, to] = range(parts[i], x, max_squared_velocity[i + 1]);
      return from <= to;
    };
    if (!is_allowed(high)) {
      while (high - low > 1e-12 * high) {
        const double middle = (low + high) / 2;
        (is_allowed(middle) ? low : high) = middle;
      }
    } else {
      low = high;
    }
    max_squared_velocity[i] = low;
  }
  double time = 0, x = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double next = std::max(0.0, range(parts[i], x, max_squared_velocity[i + 1]).second);
    time += 2 * parts[i].h / (std::sqrt(x) + std::sqrt(next));
    x = next;
  }
  return time;
}

void compare(unsigned seeds) {
  std::printf("| | same curve | worst (seed) | natural spline | worst (seed) | `natural_cubic` | "
              "worst (seed) | µs |\n|---|---|---|---|---|---|---|---|\n");
  for (const family& kind : families) {
    statistics same, spline, smooth;
    stopwatch watch;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      const problem p = problem_of(kind, seed);
      const auto timed = [&](const duet::time_parametrisation_options& options) {
        return duet::time_optimal_trajectory(p.waypoints, p.velocity, p.acceleration, options)
            .duration();
      };
      const double natural_time = reference(natural_cubic_curve(p), p.velocity, p.acceleration);
      const double time = watch.of([&] { return timed({}); });
      same.add(time / reference(pchip_curve(p), p.velocity, p.acceleration), seed);
      spline.add(time / natural_time, seed);
      smooth.add(timed({.curve = duet::waypoint_interpolation::natural_cubic}) / natural_time,
                 seed);
    }
    std::printf("| %s ", kind.name);
    for (const statistics& each : {same, spline, smooth}) {
      std::printf("| %.4f | %.4f (%u) ", each.sum / seeds, each.worst, each.seed);
    }
    std::printf("| %.0f |\n", 1000 * watch.median());
    std::fflush(stdout);
  }
}

} // namespace

int main(int argc, char** argv) {
  const unsigned seeds = argc > 1 ? unsigned(std::atoi(argv[1])) : 100;
  compare(seeds);
}
