// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Motion planning exactly as in the notes (N22–N25), for a Panda: minimum-norm joint rates, a
/// single step, plans towards a goal, inverse kinematics, a path of poses, and the effect of the
/// step size beta. Prints the tables of docs/case-studies/planner_of_the_notes.md.

#include <duet/core/random_source.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/motion/printed_plan.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace {

using namespace duet;
using vector = Eigen::Matrix<double, 7, 1>;

const auto arm = robots::panda().table();

vector gripper_down() {
  const double quarter = 0.78539816339744831;
  return vector(0, -quarter, 0, -3 * quarter, 0, 2 * quarter, quarter);
}

/// One step by N22 and N23.
void single_step() {
  const vector theta = gripper_down();
  const auto current = arm.pose(theta);
  const auto B = resolved_rate_matrix(arm, theta);
  vector7<double> rate = vector7<double>::Zero();
  rate[2] = 1; // of gamma = [t; alpha]: the tip rises at 1 m/s
  const vector rates = B * rate;
  std::printf("| N22: joint | 1 | 2 | 3 | 4 | 5 | 6 | 7 |\n|---|---|---|---|---|---|---|---|\n"
              "| velocity, rad/s |");
  for (const double x : rates) {
    std::printf(" %.4f |", std::abs(x) < 1e-12 ? 0 : x);
  }
  std::printf("\n\n| N23: length of the step | position error after it |\n|---|---|\n");
  for (const double h : {.1, .01, .001}) {
    const auto next = pose(quaternion<double>(1), Eigen::Vector3d(0, 0, h)) * current;
    const auto residual = pose_error_between(arm.pose(resolved_step(arm, theta, next, 1)), next);
    std::printf("| %g m | %.3g m |\n", h, residual.translation);
  }
}

struct problem {
  vector start, end;
};

/// Starts and goals in the inner 80 % of the joints' ranges, goals up to 0.5 rad per joint from the
/// start or anywhere.
std::vector<problem> problems(bool is_near) {
  random_source random(1);
  std::vector<problem> result(50);
  for (problem& p : result) {
    for (int i = 0; i < 7; ++i) {
      const auto& limits = arm.limits(i);
      const double middle = (limits.lower + limits.upper) / 2;
      const double half = .8 * (limits.upper - middle);
      p.start[i] = middle + (half - (is_near ? .5 : 0)) * random.uniform(-1, 1);
      p.end[i] = (is_near ? p.start[i] : middle) + (is_near ? .5 : half) * random.uniform(-1, 1);
    }
  }
  return result;
}

/// Plans by N24, which also solve inverse kinematics (note 2 of N25).
void plans() {
  std::printf(
      "\n| N24 | tau | beta | reached, of 50 | iterations, median |\n|---|---|---|---|---|\n");
  for (const bool is_near : {true, false}) {
    for (const double tau : {.1, 1.}) {
      for (const double beta : {.3, 1., 1.8, 2.5}) {
        std::vector<int> iterations;
        for (const problem& p : problems(is_near)) {
          const auto plan =
              printed_screw_plan(arm, p.start, arm.pose(p.end), {.tau = tau, .beta = beta});
          if (plan.reason == stop_reason::reached) {
            iterations.push_back(plan.iterations);
          }
        }
        std::sort(iterations.begin(), iterations.end());
        std::printf("| %s | %g | %g | %zu | ", is_near ? "near goals" : "any goals", tau, beta,
                    iterations.size());
        if (iterations.empty()) {
          std::printf("|\n");
        } else {
          std::printf("%d |\n", iterations[iterations.size() / 2]);
        }
      }
    }
  }
}

/// A circle of 10 cm as a sequence of poses (note 1 of N25).
void paths() {
  const auto first = arm.pose(gripper_down());
  std::printf("\n| N25, note 1: poses | beta | outcome | largest deviation | divided by h |\n"
              "|---|---|---|---|---|\n");
  for (const int n : {50, 100, 200}) {
    const double full_turn = 6.283185307179586;
    std::vector<dual_quaternion<double>> path;
    for (int i = 1; i <= n; ++i) {
      const double u = full_turn * i / n;
      const Eigen::Vector3d moved(.1 * std::cos(u) - .1, .1 * std::sin(u), 0);
      path.push_back(pose(quaternion<double>(1), moved) * first);
    }
    for (const double beta : {.3, 1., 1.8, 2.5}) {
      const auto plan = printed_path_plan(arm, gripper_down(), path, {.beta = beta});
      double largest = 0;
      for (std::size_t k = 1; k < plan.deviations.size(); ++k) {
        largest = std::max(largest, plan.deviations[k].translation);
      }
      if (plan.reason == stop_reason::reached) {
        std::printf("| %d | %g | %s | %.3g mm | %.2g |\n", n, beta, to_text(plan.reason),
                    1000 * largest, largest / (full_turn * .1 / n));
      } else {
        std::printf("| %d | %g | %s after %d | | |\n", n, beta, to_text(plan.reason),
                    plan.iterations);
      }
    }
  }
}

} // namespace

int main() {
  single_step();
  plans();
  paths();
}
