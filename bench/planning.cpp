// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Plans of a Panda along screws: how many of 300 random problems are solved, and how long one
/// takes. A program of its own: build/bench/bench/duet_planning_bench

#include <duet/comparison/random_source.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/mechanism/robots.hpp>
#include <duet/planning/plan_screw_motion.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace {

using vector = Eigen::Matrix<double, 7, 1>;
constexpr auto arm = duet::robots::panda();

struct problem {
  vector start, end;
};

enum class family { near_goals, unrelated_goals, from_gripper_down };

/// Starts and goals in the inner 80 % of the joints' ranges, near ones within 0.5 rad per joint;
/// from the gripper-down pose within 0.5 rad and the limits.
std::vector<problem> problems(family kind, unsigned seed) {
  duet::random_source random(seed);
  const double quarter = 0.78539816339744831;
  vector down;
  down << 0, -quarter, 0, -3 * quarter, 0, 2 * quarter, quarter;
  std::vector<problem> result(kind == family::from_gripper_down ? 500 : 300, {down, down});
  for (problem& p : result) {
    for (int i = 0; i < 7; ++i) {
      const double lower = arm.limits(i).lower, upper = arm.limits(i).upper;
      const double middle = (lower + upper) / 2, half = .8 * (upper - middle);
      if (kind == family::from_gripper_down) {
        p.end[i] = std::clamp(down[i] + random.uniform(-.5, .5), lower, upper);
      } else {
        p.start[i] = middle + half * random.uniform(-1, 1);
        p.end[i] = kind == family::near_goals ? std::clamp(p.start[i] + random.uniform(-.5, .5),
                                                           middle - half, middle + half)
                                              : middle + half * random.uniform(-1, 1);
      }
    }
  }
  return result;
}

/// How far the straight joint paths between waypoints are from the screw, in metres or radians;
/// infinite outside the limits.
double largest_deviation(const duet::motion_plan<7>& plan,
                         const duet::dual_quaternion<double>& goal) {
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
      const auto d = duet::deviation_between(
          arm.pose(theta),
          duet::sclerp(plan.poses[0], goal, (1 - x) * plan.tau[k - 1] + x * plan.tau[k]));
      result = std::max({result, d.length, d.angle});
    }
  }
  return result;
}

/// One iteration plans all problems; the counters are of the first. With DUET_BENCH_FINE set what
/// fails is tried again in ten times smaller steps, which takes minutes.
void plan_all(benchmark::State& state, family kind, unsigned seed, bool has_search) {
  const auto all = problems(kind, seed);
  duet::plan_options options;
  if (!has_search) {
    options.search_step = 0;
  }
  duet::plan_options fine = options;
  fine.largest_step /= 10;
  fine.smallest_step /= 10;
  fine.search_step /= 10;
  fine.self_motion_step /= 10;
  fine.iterations = std::numeric_limits<int>::max();
  std::vector<double> times;
  int reached = 0, reached_finely = 0;
  double largest = 0;
  for (auto _ : state) {
    const bool is_first = times.empty();
    for (const problem& p : all) {
      const auto goal = arm.pose(p.end);
      const auto before = std::chrono::steady_clock::now();
      const auto plan = duet::plan_screw_motion(arm, p.start, goal, options);
      const std::chrono::duration<double, std::milli> time =
          std::chrono::steady_clock::now() - before;
      times.push_back(time.count());
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
  std::nth_element(times.begin(), times.begin() + std::ptrdiff_t(times.size() / 2), times.end());
  state.counters["reached"] = reached;
  state.counters["of"] = double(all.size());
  state.counters["median_ms"] = times[times.size() / 2];
  state.counters["deviation"] = largest;
  state.counters["reached_by_finer_steps_only"] = reached_finely;
}

const bool registered = [] {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto add = [&](const char* name, family kind, bool has_search) {
      benchmark::RegisterBenchmark((std::string(name) + "/seed:" + std::to_string(seed)).c_str(),
                                   plan_all, kind, seed, has_search)
          ->Unit(benchmark::kMillisecond);
    };
    add("near", family::near_goals, true);
    add("near_without_search", family::near_goals, false);
    add("unrelated", family::unrelated_goals, true);
    add("unrelated_without_search", family::unrelated_goals, false);
    add("gripper_down", family::from_gripper_down, true);
  }
  return true;
}();

} // namespace

BENCHMARK_MAIN();
