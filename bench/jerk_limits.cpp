// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Durations of `time_optimal_trajectory` with jerk limits relative to the minimum time. They are
/// compared with the closed form on straight lines, and on curves with those of another method: a
/// search over time in 300 equal steps of constant s⃛, with limits at three moments of each. Prints
/// the table of docs/reference/benchmarks.md. Argument: number of seeds of each family (20);
/// build/bench/bench/duet_jerk_limits_bench 10

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
#include <limits>
#include <utility>
#include <vector>

namespace {

using namespace timing_bench;
using curve = std::vector<duet::detail::joint_cubic>;

/// Minimum time from rest to rest on a straight line.
double seven_phases(double distance, double v, double a, double j) {
  const auto rise = [&](double speed) {
    return speed > a * a / j ? speed / a + a / j : 2 * std::sqrt(speed / j);
  };
  if (v * rise(v) <= distance) {
    return 2 * rise(v) + (distance - v * rise(v)) / v;
  }
  double low = 0, high = v;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (middle * rise(middle) < distance ? low : high) = middle;
  }
  return 2 * rise(high);
}

/// Minimum time along a curve for a cubic B-spline s over n steps of time, by a primal log-barrier
/// method with Newton steps. Limits are satisfied at three moments of each step only.
class reference {
public:
  reference(const curve& path, const problem& limits, const vector& jerk,
            const std::vector<double>& arc_lengths)
      : path_(path), limits_(limits), jerk_(jerk), n_(int(arc_lengths.size()) - 1),
        c_(Eigen::VectorXd::Zero(n_ + 3)) {
    for (int i = 0; i <= n_; ++i) {
      c_[i + 1] = arc_lengths[std::size_t(i)];
    }
    c_[0] = c_[1] = c_[2] = 0;
    c_[n_] = c_[n_ + 1] = c_[n_ + 2] = arc_lengths.back();
    step_ = 1;
    double stretch = 0;
    for_each_bound(c_, step_, [&](double limit, double, double x, int, const auto&, int order) {
      stretch = std::max(stretch, std::pow(std::abs(x) / limit, 1.0 / order));
    });
    step_ = 1.05 * stretch;
  }

  double time() {
    for (double weight = 1e3 * n_; weight < 1e5 * n_; weight *= 3) {
      for (int k = 0; k < 100 && improve(weight / step_) > .1; ++k) {
      }
    }
    return n_ * step_;
  }

private:
  /// Calls f(limit, its derivative with respect to the step, x, first coefficient, derivatives of
  /// x, order) for each constraint |x| ≤ limit.
  void for_each_bound(const Eigen::VectorXd& c, double h, const auto& f) const {
    std::size_t edge = 0;
    double begin = 0;
    for (int k = 0; k < n_; ++k) {
      for (const double u : {0.0, .5, 1.0}) {
        const double w = 1 - u;
        const Eigen::Vector4d w_0(w * w * w / 6, 2.0 / 3 - u * u * (1 - u / 2),
                                  2.0 / 3 - w * w * (1 - w / 2), u * u * u / 6);
        const Eigen::Vector4d w_1(-w * w / 2, u * (1.5 * u - 2), -w * (1.5 * w - 2), u * u / 2);
        const Eigen::Vector4d w_2(w, 3 * u - 2, 1 - 3 * u, u), w_3(-1, 3, -3, 1);
        const Eigen::Vector4d each = c.segment<4>(k);
        const double s = w_0.dot(each), s_1 = w_1.dot(each), s_2 = w_2.dot(each),
                     s_3 = w_3.dot(each);
        while (edge + 1 < path_.size() && s > begin + path_[edge].length) {
          begin += path_[edge++].length;
        }
        while (edge > 0 && s < begin) {
          begin -= path_[--edge].length;
        }
        const auto& q = path_[edge];
        const vector q_1 = q.first(s - begin), q_2 = q.second(s - begin);
        const auto [q_3, q_4] = third(edge, s - begin);
        for (Eigen::Index j = 0; j < q_1.size(); ++j) {
          const double a = q_1[j], b = q_2[j], d = q_3[j];
          f(limits_.velocity[j] * h, limits_.velocity[j], a * s_1, k,
            Eigen::Vector4d(b * s_1 * w_0 + a * w_1), 1);
          f(limits_.acceleration[j] * h * h, 2 * limits_.acceleration[j] * h,
            b * s_1 * s_1 + a * s_2, k,
            Eigen::Vector4d((d * s_1 * s_1 + b * s_2) * w_0 + 2 * b * s_1 * w_1 + a * w_2), 2);
          f(jerk_[j] * h * h * h, 3 * jerk_[j] * h * h,
            d * s_1 * s_1 * s_1 + 3 * b * s_1 * s_2 + a * s_3, k,
            Eigen::Vector4d((q_4[j] * s_1 * s_1 * s_1 + 3 * d * s_1 * s_2 + b * s_3) * w_0 +
                            3 * (d * s_1 * s_1 + b * s_2) * w_1 + 3 * b * s_1 * w_2 + a * w_3),
            3);
        }
      }
    }
  }
  /// Third derivative and its derivative. The former is interpolated linearly over a tenth of both
  /// edges at a knot, because the search could not move a moment past a jump.
  [[nodiscard]] std::pair<vector, vector> third(std::size_t edge, double s) const {
    const auto& q = path_[edge];
    for (const bool is_end : {false, true}) {
      if (is_end ? edge + 1 < path_.size() : edge > 0) {
        const auto &left = path_[is_end ? edge : edge - 1],
                   &right = path_[is_end ? edge + 1 : edge];
        const double reach = .1 * std::min(left.length, right.length);
        const double x = .5 + (is_end ? s - q.length : s) / (2 * reach);
        if (x > 0 && x < 1) {
          return {6 * ((1 - x) * left.c3 + x * right.c3), 3 * (right.c3 - left.c3) / reach};
        }
      }
    }
    return {6 * q.c3, 0 * q.c3};
  }
  double value(const Eigen::VectorXd& c, double h, double weight) const {
    double sum = weight * h;
    bool is_inside = true;
    for_each_bound(c, h, [&](double limit, double, double x, int, const auto&, int order) {
      is_inside = is_inside && std::abs(x) < limit;
      sum -= is_inside ? std::log(limit * limit - x * x) - 2 * order * std::log(h) : 0;
    });
    return is_inside && h > 0 ? sum : std::numeric_limits<double>::infinity();
  }
  /// Takes a Newton step.
  ///
  /// \return the decrease that the model predicts
  double improve(double weight) {
    const int n = n_ + 4; // the last variable is the step
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
    gradient[n - 1] = weight;
    for_each_bound(
        c_, step_,
        [&](double limit, double by_step, double x, int k, const Eigen::Vector4d& by, int order) {
          for (const int sign : {-1, 1}) {
            const double inverse = 1 / (limit + sign * x);
            gradient.segment<4>(k) -= sign * inverse * by;
            gradient[n - 1] -= inverse * by_step;
            const double square = inverse * inverse;
            matrix.block<4, 4>(k, k) += square * by * by.transpose();
            matrix.block<1, 4>(n - 1, k) += square * sign * by_step * by.transpose();
            matrix(n - 1, n - 1) += square * by_step * by_step;
          }
          gradient[n - 1] += 2 * order / step_;
        });
    for (const int fixed : {0, 1, 2, n_, n_ + 1, n_ + 2}) {
      gradient[fixed] = 0;
      matrix.row(fixed).setZero();
      matrix.col(fixed).setZero();
      matrix(fixed, fixed) = 1;
    }
    const Eigen::VectorXd newton_step =
        matrix.selfadjointView<Eigen::Lower>().ldlt().solve(-gradient);
    const double decrease = -gradient.dot(newton_step), before = value(c_, step_, weight);
    for (double fraction = 1; fraction > 1e-6; fraction /= 2) {
      const Eigen::VectorXd c = c_ + fraction * newton_step.head(n_ + 3);
      const double h = step_ + fraction * newton_step[n - 1];
      if (value(c, h, weight) < before - 1e-3 * fraction * decrease) {
        c_ = c;
        step_ = h;
        return decrease;
      }
    }
    return 0;
  }

  const curve& path_;
  const problem& limits_;
  vector jerk_;
  int n_;
  Eigen::VectorXd c_;
  double step_;
};

void compare(unsigned seeds) {
  std::printf(
      "| | without | other search | worst (seed) | 2400 intervals | worst (seed) | straight "
      "| worst (seed) | ms |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const family& kind : families) {
    statistics longer, sampled, finer, straight;
    stopwatch watch;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      const problem p = problem_of(kind, seed);
      random_source random(seed + 1000);
      vector jerk(p.velocity.size());
      for (double& each : jerk) {
        each = random.log_uniform(3, 300);
      }
      const std::vector<double> limits(jerk.begin(), jerk.end());
      const auto timed = [&](const auto& waypoints) {
        return duet::time_optimal_trajectory(waypoints, p.velocity, p.acceleration,
                                             {.jerk = limits});
      };
      const auto motion = watch.of([&] { return timed(p.waypoints); });
      const auto without =
          duet::time_optimal_trajectory(p.waypoints, p.velocity, p.acceleration,
                                        {.curve = duet::waypoint_interpolation::natural_cubic});
      longer.add(motion.duration() / without.duration(), seed);
      // The searches start from the arc lengths of both motions at equal times.
      const auto problem = duet::detail::validated_input(
          duet::detail::waypoints_of(p.waypoints), p.velocity, p.acceleration,
          duet::time_parametrisation_options{.jerk = limits});
      const curve path = duet::detail::hermite_curve(
          problem.polygon, duet::detail::natural_cubic_slopes(problem.polygon));
      const auto start = duet::detail::min_acceleration_motion(problem, path);
      double best = std::numeric_limits<double>::infinity();
      for (const auto& each : {start, duet::detail::timed_within_jerks(problem, path)}) {
        const auto arc_lengths = duet::detail::arc_lengths_of(each, 300, problem.polygon.s.back());
        best = std::min(best, reference(path, p, jerk, arc_lengths).time());
      }
      sampled.add(motion.duration() / best, seed);
      const auto fine = duet::time_optimal_trajectory(p.waypoints, p.velocity, p.acceleration,
                                                      {.min_intervals = 2400, .jerk = limits});
      finer.add(motion.duration() / fine.duration(), seed);
      const std::vector<vector> ends{p.waypoints[0], p.waypoints[1]};
      const vector displacement = ends[1] - ends[0];
      const auto min_ratio = [&](const vector& limit) {
        return limit.cwiseQuotient(displacement.cwiseAbs()).minCoeff();
      };
      straight.add(timed(ends).duration() / seven_phases(1, min_ratio(p.velocity),
                                                         min_ratio(p.acceleration),
                                                         min_ratio(jerk)),
                   seed);
    }
    std::printf("| %s | %.2f ", kind.name, longer.sum / seeds);
    for (const statistics& each : {sampled, finer, straight}) {
      std::printf("| %.4f | %.4f (%u) ", each.sum / seeds, each.worst, each.seed);
    }
    std::printf("| %.0f |\n", watch.median());
    std::fflush(stdout);
  }
}

} // namespace

int main(int argc, char** argv) { compare(argc > 1 ? unsigned(std::atoi(argv[1])) : 20); }
