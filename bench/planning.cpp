// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Plans of a Panda along screws, freely and near a ball: how many of some hundreds of random
/// problems are solved, and how long one takes. A program of its own:
/// build/bench/bench/duet_planning_bench

#include "support/stopwatch.hpp"

#include <duet/core/random_source.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace {

using vector = Eigen::Matrix<double, 7, 1>;
using dual_quaternion = duet::dual_quaternion<double>;
constexpr auto arm = duet::robots::panda();

vector gripper_down() {
  const double quarter = 0.78539816339744831;
  vector theta;
  theta << 0, -quarter, 0, -3 * quarter, 0, 2 * quarter, quarter;
  return theta;
}

struct problem {
  vector start, end;
};

enum class family { near_goals, near_goals_cut_off, unrelated_goals, from_gripper_down };

/// Starts and goals in the inner 80 % of the joints' ranges. Near goals are within 0.5 rad per
/// joint of starts that leave as much room, or of any start, and cut off where they leave these
/// ranges; from the gripper-down pose within 0.5 rad and the limits.
std::vector<problem> problems(family kind, unsigned seed) {
  duet::random_source random(seed);
  const vector down = gripper_down();
  std::vector<problem> result(kind == family::from_gripper_down ? 500 : 300, {down, down});
  for (problem& p : result) {
    for (int i = 0; i < 7; ++i) {
      const double lower = arm.limits(i).lower, upper = arm.limits(i).upper;
      const double centre = (lower + upper) / 2, half = .8 * (upper - centre);
      if (kind == family::from_gripper_down) {
        p.end[i] = std::clamp(down[i] + random.uniform(-.5, .5), lower, upper);
      } else {
        const double spread = kind == family::near_goals ? half - .5 : half;
        p.start[i] = centre + spread * random.uniform(-1, 1);
        p.end[i] =
            kind == family::unrelated_goals
                ? centre + half * random.uniform(-1, 1)
                : std::clamp(p.start[i] + random.uniform(-.5, .5), centre - half, centre + half);
      }
    }
  }
  return result;
}

/// How far the straight joint paths between waypoints are from the screw, in metres or radians;
/// infinite outside the limits.
double largest_deviation(const duet::motion_plan& plan, const dual_quaternion& goal) {
  double result = 0;
  for (std::size_t k = 1; k < plan.joints.size(); ++k) {
    for (int part = 1; part <= 10; ++part) {
      const double x = part / 10.0;
      const vector theta = (1 - x) * plan.joints[k - 1] + x * plan.joints[k];
      for (int i = 0; i < 7; ++i) {
        if (!(theta[i] >= arm.limits(i).lower - 1e-15 && theta[i] <= arm.limits(i).upper + 1e-15)) {
          return std::numeric_limits<double>::infinity();
        }
      }
      const auto d = duet::pose_error_between(
          arm.pose(theta),
          duet::sclerp(plan.poses[0], goal, (1 - x) * plan.tau[k - 1] + x * plan.tau[k]));
      result = std::max({result, d.translation, d.rotation});
    }
  }
  return result;
}

struct problem_near_ball {
  dual_quaternion goal;
  duet::scene around;
};

/// From the gripper-down pose to goals within 0.6 rad per joint and the limits, that the plan
/// without obstacles reaches, but comes closer to a ball than the margin: one whose centre is
/// 0.15 m from where the elbow is two thirds of that way.
std::vector<problem_near_ball> problems_near_balls(unsigned seed) {
  duet::random_source random(seed);
  std::vector<problem_near_ball> result;
  while (result.size() < 100) {
    vector end = gripper_down();
    for (int i = 0; i < 7; ++i) {
      end[i] =
          std::clamp(end[i] + random.uniform(-.6, .6), arm.limits(i).lower, arm.limits(i).upper);
    }
    const auto aside = random.direction<3>();
    const auto goal = arm.pose(end);
    const auto plain = duet::plan_screw_motion(arm, gripper_down(), goal);
    if (plain.reason != duet::stop_reason::reached) {
      continue;
    }
    const vector late = plain.joints[plain.joints.size() * 2 / 3];
    const Eigen::Vector3d centre =
        duet::translation(arm.pose(late, 4)) + .15 * Eigen::Vector3d(aside[0], aside[1], aside[2]);
    const duet::scene around{{{2, duet::capsule<>({0, 0, 0}, {0, -.316, 0}, .06)},
                              {3, duet::sphere<>{{.0825, 0, 0}, .06}},
                              {4, duet::capsule<>({0, 0, 0}, {-.0825, .384, 0}, .06)},
                              {7, duet::capsule<>({0, 0, -.05}, {0, 0, .05}, .05)}},
                             {duet::sphere<>{centre, .1}},
                             .01};
    const auto is_too_close = [&](const vector& theta) {
      return duet::clearance(arm, theta, around).distance < around.margin;
    };
    if (!is_too_close(gripper_down()) &&
        std::any_of(plain.joints.begin(), plain.joints.end(), is_too_close)) {
      result.push_back({goal, around});
    }
  }
  return result;
}

/// One iteration plans all problems; `reached` and the smallest clearance, at waypoints and at
/// midpoints between them, are those of the first.
void plan_near_balls(benchmark::State& state, unsigned seed) {
  const auto all = problems_near_balls(seed);
  stopwatch times;
  int reached = 0;
  double largest = 0, nearest = std::numeric_limits<double>::infinity();
  for (auto _ : state) {
    const bool is_first = times.is_empty();
    for (const problem_near_ball& p : all) {
      const auto plan = times.of(
          [&] { return duet::plan_screw_motion(arm, gripper_down(), p.goal, {}, {}, p.around); });
      if (is_first) {
        reached += plan.reason == duet::stop_reason::reached;
        largest = std::max(largest, largest_deviation(plan, p.goal));
        nearest = std::min(nearest, plan.smallest_clearance);
        for (std::size_t k = 1; k < plan.joints.size(); ++k) {
          const vector centre = (plan.joints[k - 1] + plan.joints[k]) / 2;
          nearest = std::min(nearest, duet::clearance(arm, centre, p.around).distance);
        }
      }
    }
  }
  state.counters["reached"] = reached;
  state.counters["of"] = double(all.size());
  state.counters["median_ms"] = times.median();
  state.counters["deviation"] = largest;
  state.counters["clearance"] = nearest;
}

/// One iteration plans all problems; the counters are of the first. With DUET_BENCH_FINE set what
/// fails is tried again in ten times smaller steps, which takes minutes.
void plan_all(benchmark::State& state, const std::vector<family>& kinds, unsigned seed,
              bool has_search) {
  std::vector<problem> all;
  for (const family kind : kinds) {
    const auto some = problems(kind, seed);
    all.insert(all.end(), some.begin(), some.end());
  }
  duet::plan_options options;
  if (!has_search) {
    options.search_step = 0;
  }
  duet::plan_options fine = options;
  fine.largest_step /= 10;
  fine.smallest_step /= 10;
  fine.search_step /= 10;
  fine.self_motion_step /= 10;
  fine.max_iterations = std::numeric_limits<int>::max();
  stopwatch times;
  int reached = 0, reached_finely = 0;
  double largest = 0;
  for (auto _ : state) {
    const bool is_first = times.is_empty();
    for (const problem& p : all) {
      const auto goal = arm.pose(p.end);
      const auto plan =
          times.of([&] { return duet::plan_screw_motion(arm, p.start, goal, options); });
      if (is_first) {
        largest = std::max(largest, largest_deviation(plan, goal));
        if (plan.reason == duet::stop_reason::reached) {
          ++reached;
        } else if (std::getenv("DUET_BENCH_FINE") != nullptr) {
          reached_finely += duet::plan_screw_motion(arm, p.start, goal, fine).reason ==
                            duet::stop_reason::reached;
        }
      }
    }
  }
  state.counters["reached"] = reached;
  state.counters["of"] = double(all.size());
  state.counters["median_ms"] = times.median();
  state.counters["deviation"] = largest;
  state.counters["reached_by_finer_steps_only"] = reached_finely;
}

const bool registered = [] {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto add = [&](const char* name, const std::vector<family>& kinds, bool has_search) {
      benchmark::RegisterBenchmark((std::string(name) + "/seed:" + std::to_string(seed)).c_str(),
                                   plan_all, kinds, seed, has_search)
          ->Unit(benchmark::kMillisecond);
    };
    add("near", {family::near_goals}, true);
    add("near_without_search", {family::near_goals}, false);
    add("near_cut_off", {family::near_goals_cut_off}, true);
    add("near_cut_off_without_search", {family::near_goals_cut_off}, false);
    add("unrelated", {family::unrelated_goals}, true);
    add("unrelated_without_search", {family::unrelated_goals}, false);
    add("near_and_unrelated", {family::near_goals, family::unrelated_goals}, true);
    add("gripper_down", {family::from_gripper_down}, true);
    benchmark::RegisterBenchmark(("beside_ball/seed:" + std::to_string(seed)).c_str(),
                                 plan_near_balls, seed)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

} // namespace

BENCHMARK_MAIN();
