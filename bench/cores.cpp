// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Multithreading: the manipulability of a Panda in many configurations, a table of its poses and
/// Jacobians, a spline with its rates, inverse kinematics of many goals. Each iteration computes
/// one on one core and on all; `times` is how many times faster all cores are, by the shortest
/// times of both.

#include <duet/core/batch/batch.hpp>
#include <duet/core/parallel_for.hpp>
#include <duet/core/random_source.hpp>
#include <duet/kinematics/manipulability.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/kinematics/sweep.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/evaluate.hpp>
#include <duet/spline/interpolate.hpp>

#include <Eigen/Core>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <thread>
#include <vector>

namespace {

constexpr auto arm = duet::robots::panda();
using vector = Eigen::Matrix<double, 7, 1>;

vector random_joints(duet::random_source& random) {
  vector theta;
  for (int i = 0; i < 7; ++i) {
    theta[i] = random.uniform(arm.limits(i).lower, arm.limits(i).upper);
  }
  return theta;
}

double milliseconds(const auto& run) {
  const auto before = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - before)
      .count();
}

void compare(benchmark::State& state, const auto& run) {
  double one = std::numeric_limits<double>::infinity(), all = one;
  run(duet::all_cores);
  for (auto _ : state) {
    one = std::min(one, milliseconds([&] { run(duet::one_core); }));
    all = std::min(all, milliseconds([&] { run(duet::all_cores); }));
  }
  state.counters["one_core_ms"] = one;
  state.counters["all_cores_ms"] = all;
  state.counters["cores"] = std::thread::hardware_concurrency();
  state.counters["times"] = one / all;
}

std::vector<vector> random_configurations(std::size_t count) {
  duet::random_source random(1);
  std::vector<vector> result(count);
  std::generate(result.begin(), result.end(), [&] { return random_joints(random); });
  return result;
}

void manipulabilities(benchmark::State& state) {
  using lanes = duet::batch<double>;
  constexpr auto width = std::size_t(lanes::lanes);
  const auto configurations = random_configurations(16000);
  std::vector<double> out(configurations.size());
  compare(state, [&](duet::execution execution) {
    duet::parallel_for(
        out.size() / width,
        [&](std::size_t i) {
          std::array<lanes, 7> theta;
          for (std::size_t j = 0; j < 7; ++j) {
            theta[j] = lanes::from_lanes(
                [&](int k) { return configurations[i * width + std::size_t(k)][Eigen::Index(j)]; });
          }
          duet::manipulability(arm, theta).store(&out[i * width]);
        },
        execution);
  });
}

void poses_and_jacobians(benchmark::State& state) {
  const auto configurations = random_configurations(100000);
  using result =
      duet::value_and_jacobian<duet::dual_quaternion<double>, Eigen::Matrix<double, 6, 7>>;
  std::vector<result> out(configurations.size());
  compare(state, [&](duet::execution execution) {
    duet::poses_and_jacobians(arm, configurations, duet::frame::hybrid, out, execution);
  });
}

void motion_of_spline(benchmark::State& state) {
  std::vector<double> u;
  std::vector<duet::quaternion<double>> rotations;
  for (int i = 0; i <= 1000; ++i) {
    u.push_back(0.01 * i);
    rotations.push_back(duet::from_rotation_vector(
        duet::vector3<double>(std::sin(u.back()), std::cos(u.back()), u.back() / 4)));
  }
  const auto spline =
      duet::interpolate<duet::cumulative_bspline<double>>(u, rotations, duet::not_a_knot());
  std::vector<double> parameters(100000);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    parameters[i] = u.back() * double(i) / double(parameters.size());
  }
  std::vector<duet::motion<double>> out(parameters.size());
  compare(state, [&](duet::execution execution) {
    duet::evaluate_motion(spline, parameters, duet::frame::body, std::span(out), execution);
  });
}

void inverse_kinematics(benchmark::State& state) {
  duet::random_source random(1);
  std::vector<duet::dual_quaternion<double>> goals(2000);
  std::generate(goals.begin(), goals.end(), [&] { return arm.pose(random_joints(random)); });
  std::vector<duet::inverse_kinematics_result> out(goals.size());
  const vector start{0, -.5, 0, -2, 0, 1.5, .8};
  compare(state, [&](duet::execution execution) {
    duet::inverse_kinematics(arm, std::span<const duet::dual_quaternion<double>>(goals), start,
                             std::span(out), {}, execution);
  });
}

BENCHMARK(manipulabilities)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(poses_and_jacobians)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(motion_of_spline)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(inverse_kinematics)->UseRealTime()->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
