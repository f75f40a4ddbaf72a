// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/stopwatch.hpp"

#include <duet/core/random_source.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/robotics/plan_screw_motion.hpp>
#include <duet/robotics/time_parametrised.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

/// \file
/// Families of random paths for the comparison of time parametrisations.

namespace timing_bench {

using vector = duet::detail::joint_vector<double, -16>;
using curve = std::vector<duet::detail::joint_cubic>;
using duet::random_source;

struct problem {
  std::vector<vector> waypoints;
  vector velocity, acceleration;
};

inline vector normal(random_source& random, int n = 7) {
  vector result(n);
  for (double& x : result) {
    x = random.normal();
  }
  return result;
}

/// Waypoints of plans from starts near the centre of the joint ranges to goals within 0.5 rad of
/// them.
template <class C>
std::vector<vector> plan(const C& arm, random_source& random) {
  for (;;) {
    vector start(arm.size()), end(arm.size());
    for (int i = 0; i < arm.size(); ++i) {
      const auto& limits = arm.limits(i);
      const double half = std::min(2.0, .8 * (limits.upper - limits.lower) / 2 - .5);
      start[i] = (limits.lower + limits.upper) / 2 + half * random.uniform(-1, 1);
      end[i] = start[i] + random.uniform(-.5, .5);
    }
    const auto result = duet::plan_screw_motion(arm, start, arm.pose(end));
    if (result.reason == duet::stop_reason::reached) {
      return {result.joints.begin(), result.joints.end()};
    }
  }
}

/// `count` points, each `step(k)` from the one before.
template <class Step>
std::vector<vector> walk(int count, const Step& step) {
  std::vector<vector> result{vector::Zero(7)};
  for (int k = 1; k < count; ++k) {
    result.push_back(result.back() + step(k));
  }
  return result;
}

struct family {
  const char* name;
  std::vector<vector> (*waypoints)(random_source&);
};

inline const std::array families{
    family{"plans of a Panda", [](random_source& r) { return plan(duet::robots::panda(), r); }},
    family{"plans of an iiwa", [](random_source& r) { return plan(duet::robots::iiwa14(), r); }},
    family{"plans of a UR5e", [](random_source& r) { return plan(duet::robots::ur5e(), r); }},
    family{"random walks",
           [](random_source& r) { return walk(r.integer(2, 20), [&](int) { return normal(r); }); }},
    family{"all joints turn back",
           [](random_source& r) {
             const vector direction = normal(r);
             return walk(r.integer(3, 12), [&](int k) {
               return vector((k % 2 == 0 ? -1 : 1) * r.uniform(.3, 1) * direction);
             });
           }},
    family{"one joint after another",
           [](random_source& r) {
             return walk(r.integer(3, 12), [&](int) {
               return vector(r.normal() * vector::Unit(7, r.integer(0, 6)));
             });
           }},
    family{"nearly straight",
           [](random_source& r) {
             const vector direction = normal(r);
             const double off = r.log_uniform(1e-9, 1e-2);
             return walk(r.integer(3, 20), [&](int) {
               return vector(r.uniform(.01, 1) * direction + off * normal(r));
             });
           }},
    family{"unequal, 1e-5 to 1",
           [](random_source& r) {
             return walk(r.integer(3, 20),
                         [&](int) { return vector(r.log_uniform(1e-5, 1) * normal(r)); });
           }},
    family{"tiny, 1e-6 to 1e-3",
           [](random_source& r) {
             const double size = r.log_uniform(1e-6, 1e-3);
             return walk(r.integer(2, 20), [&](int) { return vector(size * normal(r)); });
           }},
    family{"closed curves",
           [](random_source& r) {
             const int n = r.integer(10, 80);
             const vector a = normal(r), b = normal(r), c = normal(r);
             std::vector<vector> result;
             for (int i = 0; i <= n; ++i) {
               const double x = 6.283185307179586 * i / n;
               result.push_back(std::sin(x) * a + std::cos(x) * b + std::sin(2 * x) * c);
             }
             return result;
           }},
    family{"small steps aside", [](random_source& r) {
             const vector direction = normal(r);
             return walk(r.integer(4, 15), [&](int k) {
               return k % 3 == 2 ? vector(r.log_uniform(1e-4, 1e-1) * normal(r))
                                 : vector(r.uniform(.3, 1) * direction);
             });
           }}};

inline problem problem_of(const family& kind, unsigned seed) {
  random_source random(seed);
  problem result;
  result.waypoints = kind.waypoints(random);
  const Eigen::Index n = result.waypoints[0].size();
  result.velocity.resize(n);
  result.acceleration.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    result.velocity[i] = random.uniform(.5, 3);
    result.acceleration[i] = random.uniform(1, 15);
  }
  return result;
}

struct statistics {
  double sum = 0, worst = 0;
  unsigned seed = 0;
  void add(double x, unsigned of) {
    sum += x;
    if (x > worst) {
      worst = x;
      seed = of;
    }
  }
};

} // namespace timing_bench
