// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Components of the self-motion of seven joints at random and at structured poses, against random
/// restarts: solutions of inverse kinematics from 100 random configurations without limits that are
/// on no component. Arguments: number of poses of each family (50), seed (1), and any third one to
/// list the poses with open curves or missed solutions.
/// build/bench/bench/duet_self_motion_bench

#include <duet/core/random_source.hpp>
#include <duet/kinematics/adapted.hpp>
#include <duet/kinematics/chain_parameters.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/self_motion_curves.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <numbers>
#include <vector>

namespace {

using namespace duet;
using std::numbers::pi;
using arm_chain = serial_chain<7>;
using joints = Eigen::Matrix<double, 7, 1>;
using component = self_motion_curve;

struct robot {
  const char* name;
  arm_chain arm;
};

/// Arm with a spherical shoulder and wrist, except for offsets: `shoulder` between axes 1 and 3,
/// `elbow` and `wrist` perpendicular to the links.
arm_chain redundant_arm(double shoulder, double elbow, double wrist) {
  constexpr double quarter_turn = pi / 2;
  const std::array<dh_row<>, 7> rows{{{.d = .3, .alpha = -quarter_turn},
                                      {.d = shoulder, .alpha = quarter_turn},
                                      {.a = elbow, .d = .4, .alpha = quarter_turn},
                                      {.a = -elbow, .alpha = -quarter_turn},
                                      {.d = .35, .alpha = -quarter_turn},
                                      {.a = wrist, .alpha = quarter_turn},
                                      {.d = .1}}};
  return from_dh(rows);
}

joints difference(const joints& a, const joints& b) {
  return (a - b).unaryExpr([](double x) { return std::remainder(x, 2 * pi); });
}

constexpr double resolution = .1;

bool is_on_curve(const component& curve, const joints& x) {
  const std::size_t n = curve.joints.size();
  double min_distance = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < n; ++k) {
    const joints to_x = difference(x, curve.joints[k]),
                 chord = difference(curve.joints[(k + 1) % n], curve.joints[k]);
    const bool is_piece = chord.norm() > 0 && (k + 1 < n || curve.is_closed);
    const double fraction =
        is_piece ? std::clamp(to_x.dot(chord) / chord.squaredNorm(), 0., 1.) : 0;
    min_distance = std::min(min_distance, (to_x - fraction * chord).norm());
  }
  return min_distance <
         resolution * resolution; // error bound of chords, which exceeds that of singular points
}

/// True if a straight line in joint space leads to a point of the sample on the component, as on
/// the tori of coaxial joints; other components are not tested.
bool is_on_torus(const arm_chain& arm, const component& torus, const joints& x) {
  const auto goal = arm.pose(x);
  return std::any_of(torus.joints.begin(), torus.joints.end(), [&](const joints& s) {
    const joints chord = difference(s, x);
    return [&] {
      for (const double fraction : {.13, .37, .5, .71, .91}) {
        const auto error = pose_error_between(arm.pose(joints(x + fraction * chord)), goal);
        if (error.translation > 1e-5 || error.rotation > 1e-5) {
          return false;
        }
      }
      return true;
    }();
  });
}

struct family {
  const char* name;
  double grid;               ///< multiples of it, 0: any
  std::vector<int> straight; ///< joints at 0
};
const std::array families{family{"random", 0, {}},
                          family{"quarter turns", pi / 2, {}},
                          family{"multiples of 15 deg", pi / 12, {}},
                          family{"multiples of 1/8 rad", .125, {}},
                          family{"straight elbow", 0, {3}},
                          family{"straight shoulder", 0, {1}},
                          family{"straight wrist", 0, {5}},
                          family{"shoulder and elbow", 0, {1, 3}},
                          family{"elbow and wrist", 0, {3, 5}},
                          family{"shoulder and wrist", 0, {1, 5}},
                          family{"all straight", 0, {1, 3, 5}},
                          family{"zero", 0, {0, 1, 2, 3, 4, 5, 6}}};

void row(const robot& each, const family& kind, int count, std::uint64_t seed, bool is_listed) {
  random_source random(seed);
  const joints far = joints::Constant(std::numeric_limits<double>::infinity());
  const arm_chain arm = with_limits(each.arm, joints(-far), far);
  int curves = 0, points = 0, surfaces = 0, open = 0, none = 0, missed = 0;
  const int poses = kind.straight.size() == 7 ? 1 : count;
  std::clock_t time = 0;
  for (int k = 0; k < poses; ++k) {
    joints theta;
    for (double& x : theta) {
      x = random.uniform(-pi, pi);
      x = kind.grid > 0 ? kind.grid * std::round(x / kind.grid) : x;
    }
    for (const int i : kind.straight) {
      theta[i] = 0;
    }
    const auto goal = arm.pose(theta);
    const std::clock_t before = std::clock();
    const auto all = self_motion_curves(arm, goal, {.resolution = resolution});
    time += std::clock() - before;
    int open_curves = 0, missed_solutions = 0;
    for (const component& each_of : all) {
      curves += each_of.dimension == 1;
      points += each_of.dimension == 0;
      surfaces += each_of.dimension > 1;
      open_curves += each_of.dimension == 1 && !each_of.is_closed;
    }
    for (int start = 0; start < 100; ++start) {
      joints from;
      for (double& x : from) {
        x = random.uniform(-pi, pi);
      }
      const auto result =
          inverse_kinematics(arm, goal, from, {.tolerance = 1e-12, .max_restarts = 0});
      missed_solutions += result.reason == stop_reason::reached &&
                          std::none_of(all.begin(), all.end(), [&](const component& part) {
                            return part.dimension > 1 ? is_on_torus(arm, part, result.joints)
                                                      : is_on_curve(part, result.joints);
                          });
    }
    open += open_curves;
    missed += missed_solutions > 0;
    none += all.empty();
    if (is_listed && (open_curves + missed_solutions > 0 || all.empty())) {
      std::printf("  pose %d: %zu components, %d open, %d solutions on none\n", k, all.size(),
                  open_curves, missed_solutions);
    }
  }
  std::printf("%-16s %-22s %5d %6d %6d %8d %5d %5d %6d %8.3f\n", each.name, kind.name, poses,
              curves, points, surfaces, open, none, missed, double(time) / CLOCKS_PER_SEC / poses);
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 50;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const std::vector<robot> robots{{"iiwa 14", robots::iiwa14().table()},
                                  {"Panda", robots::panda().table()},
                                  {"Baxter", robots::baxter_left().table()},
                                  {"no offsets", redundant_arm(0, 0, 0)},
                                  {"elbow, wrist", redundant_arm(0, .0525, .076)},
                                  {"shoulder 12 mm", redundant_arm(.012, 0, 0)},
                                  {"all offsets", redundant_arm(.1, .05, .05)}};
  std::printf("%-16s %-22s %5s %6s %6s %8s %5s %5s %6s %8s\n", "arm", "poses at", "poses", "curves",
              "points", "surfaces", "open", "none", "missed", "s each");
  for (const robot& each : robots) {
    for (const family& kind : families) {
      row(each, kind, count, seed, argc > 3);
    }
  }
}
