// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Screws through singularities and from them, of five arms of six joints and three of seven: how
/// many of 500 problems each are planned, and how many a plain tracker by Newton's method follows
/// from one end or the other, in 300, 1000 or 1001 equal steps; reasons of the rest. With
/// DUET_BENCH_MISSED set it tells what a tracker solves and the planner does not. Arguments: the
/// number of problems of each of six families (100), the seed (1).
/// build/bench/bench/duet_singular_paths_bench

#include "../src/robotics/tip_pose.hpp"

#include "robotics/singular_problems.hpp"

#include <duet/kinematics/jacobian.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace singular_problems;

template <int N>
bool is_within(const serial_chain<N>& chain, const joints_of<N>& theta) {
  for (int i = 0; i < N; ++i) {
    if (!(theta[i] >= chain.limits(i).lower - 1e-12 && theta[i] <= chain.limits(i).upper + 1e-12)) {
      return false;
    }
  }
  return true;
}

double pose_distance(const goal_pose& a, const goal_pose& b) {
  const auto d = pose_error_between(a, b);
  return std::max(d.translation, d.rotation);
}

/// Newton's method to a pose by least-norm steps; singular values below 1e-7 are left out.
template <int N>
std::optional<joints_of<N>> newton(const serial_chain<N>& chain, joints_of<N> theta,
                                   const goal_pose& goal) {
  for (int k = 0; k < 12; ++k) {
    const auto current = detail::to_tip_pose(chain.pose(theta));
    const auto e = detail::error_twist(current, detail::to_tip_pose(goal));
    const Eigen::Matrix<double, 6, 1> twist = e;
    if (pose_distance(chain.pose(theta), goal) < 1e-7) {
      return theta;
    }
    Eigen::JacobiSVD<Eigen::Matrix<double, 6, N>> svd(jacobian(chain, theta, frame::hybrid),
                                                      Eigen::ComputeFullU | Eigen::ComputeFullV);
    svd.setThreshold(1e-7);
    const joints_of<N> step = svd.solve(twist);
    if (!(step.norm() < .3)) {
      return {};
    }
    theta += step;
  }
  return {};
}

/// Follows a path of poses in `steps` equal steps; nothing where it leaves the limits or, half way
/// between two of them, is 1e-5 off the path.
template <int N, class Path>
std::optional<joints_of<N>> tracked(const serial_chain<N>& chain, joints_of<N> theta,
                                    const Path& path, int steps) {
  for (int k = 1; k <= steps; ++k) {
    const auto next = newton(chain, theta, path(double(k) / steps));
    if (!next || !is_within(chain, *next) ||
        pose_distance(chain.pose(joints_of<N>((theta + *next) / 2)), path((k - .5) / steps)) >
            1e-5) {
      return {};
    }
    theta = *next;
  }
  return theta;
}

/// True if the joints get from one configuration of a pose to another by a self-motion, each step
/// as straight as possible.
template <int N>
bool are_connected(const serial_chain<N>& chain, joints_of<N> from, const joints_of<N>& to) {
  const goal_pose pose_at_end = chain.pose(to);
  for (int k = 0; k < 1000; ++k) {
    const joints_of<N> difference = to - from;
    if (difference.norm() < .1 &&
        pose_distance(chain.pose(joints_of<N>(from + difference / 2)), pose_at_end) < 1e-5) {
      return true;
    }
    const Eigen::JacobiSVD<Eigen::Matrix<double, 6, N>> svd(
        jacobian(chain, from, frame::hybrid), Eigen::ComputeFullU | Eigen::ComputeFullV);
    joints_of<N> along = joints_of<N>::Zero();
    for (int i = 0; i < N; ++i) {
      if (i >= 6 || svd.singularValues()[i] < 1e-3) {
        along += svd.matrixV().col(i).dot(difference) * svd.matrixV().col(i);
      }
    }
    if (!(along.norm() > 1e-4)) {
      return false;
    }
    const auto next =
        newton(chain, joints_of<N>(from + along * std::min(1., .02 / along.norm())), pose_at_end);
    if (!next || !is_within(chain, *next)) {
      return false;
    }
    from = *next;
  }
  return false;
}

template <int N>
bool is_good(const serial_chain<N>& chain, const problem<N>& p, const motion_plan& plan,
             const screw& path) {
  if (plan.joints.front() != p.start || plan.tau.back() != 1) {
    return false;
  }
  for (std::size_t k = 1; k < plan.joints.size(); ++k) {
    for (int part = 1; part <= 10; ++part) {
      const double x = part / 10.;
      const joints_of<N> theta = (1 - x) * plan.joints[k - 1] + x * plan.joints[k];
      if (plan.tau[k] < plan.tau[k - 1] || !is_within(chain, theta) ||
          pose_distance(chain.pose(theta), path((1 - x) * plan.tau[k - 1] + x * plan.tau[k])) >
              1.1e-5) {
        return false;
      }
    }
  }
  return true;
}

struct score {
  int planned = 0, forward = 0, either = 0, missed = 0, bad = 0;
  double seconds = 0, slowest = 0;
  std::map<std::string, int> reasons;
};

template <int N>
score solve(const arm<N>& a, family kind, int count, unsigned seed) {
  random_source random(seed);
  score result;
  for (int k = 0; k < count; ++k) {
    const auto p = make(a, kind, random);
    const screw path{a.chain.pose(p.start), a.chain.pose(p.end)};
    const std::clock_t begin = std::clock();
    const auto plan = plan_screw_motion(a.chain, p.start, path.last);
    const double took = double(std::clock() - begin) / CLOCKS_PER_SEC;
    result.seconds += took;
    result.slowest = std::max(result.slowest, took);
    const bool is_planned = plan.reason == stop_reason::reached;
    const bool is_bad = is_planned && !is_good(a.chain, p, plan, path);
    bool is_forward = false, is_either = false;
    for (const int steps : {300, 1000, 1001}) {
      is_forward = is_forward || tracked(a.chain, p.start, path, steps);
      if (is_forward || is_either) {
        is_either = true;
        continue;
      }
      const auto back = tracked(
          a.chain, p.end, [&](double u) { return path(1 - u); }, steps);
      is_either = back && are_connected(a.chain, *back, p.start);
    }
    result.planned += is_planned && !is_bad;
    result.bad += is_bad;
    result.forward += is_forward;
    result.either += is_either;
    const bool is_missed = is_either && (!is_planned || is_bad);
    result.missed += is_missed;
    if (!is_planned) {
      ++result.reasons[to_text(plan.reason)];
    }
    if (is_missed && std::getenv("DUET_BENCH_MISSED") != nullptr) {
      std::printf("  missed %d: %s at %.9g after %d, sigma %.2g%s\n", k, to_text(plan.reason),
                  plan.tau.back(), plan.iterations, plan.smallest_singular_value,
                  is_bad ? ", bad" : "");
    }
  }
  return result;
}

template <int N>
void table_of(const std::vector<arm<N>>& arms, int count, unsigned seed) {
  for (const arm<N>& a : arms) {
    score sum;
    for (std::size_t k = 0; k < families.size(); ++k) {
      const score s = solve(a, family(k), count, seed);
      std::printf("%-14s %-22s %4d %4d %4d %4d %4d %7.2f", a.name, families[k], s.forward, s.either,
                  s.planned, s.missed, s.bad, 1e3 * s.seconds / count);
      for (const auto& [name, n] : s.reasons) {
        std::printf("  %s %d", name.c_str(), n);
      }
      std::printf("\n");
      sum.forward += s.forward;
      sum.either += s.either;
      sum.planned += s.planned;
      sum.missed += s.missed;
      sum.bad += s.bad;
    }
    std::printf("%-14s %-22s %4d %4d %4d %4d %4d\n", a.name, "all", sum.forward, sum.either,
                sum.planned, sum.missed, sum.bad);
    std::fflush(stdout);
  }
}

} // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 100;
  const unsigned seed = argc > 2 ? unsigned(std::atoi(argv[2])) : 1;
  std::printf("%-14s %-22s %4s %4s %4s %4s %4s %7s\n", "arm", "from", "on", "both", "plan", "less",
              "bad", "ms");
  table_of(six_joints(), count, seed);
  table_of(redundant_arm(), count, seed);
}
