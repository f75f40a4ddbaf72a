// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/random_source.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/kinematics/adapted.hpp>
#include <duet/kinematics/chain_parameters.hpp>
#include <duet/kinematics/robots.hpp>
#include <duet/kinematics/serial_chain.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

/// \file
/// Screws through singularities and from them.

namespace singular_problems {

using namespace duet;
using std::numbers::pi;
using goal_pose = dual_quaternion<double>;

template <int N>
using joints_of = Eigen::Matrix<double, N, 1>;

template <int N>
struct arm {
  const char* name;
  serial_chain<N> chain;
};

inline joint_limits<> degrees(double lower, double upper) {
  return {lower * pi / 180, upper * pi / 180};
}

/// Five arms of six joints, from their makers' dimensions, in metres.
inline std::vector<arm<6>> six_joints() {
  const double quarter = pi / 2;
  const std::array<dh_row<>, 6> puma{
      {{.alpha = quarter, .limits = degrees(-160, 160)},
       {.a = .4318, .limits = degrees(-225, 45)},
       {.a = .0203, .d = .15005, .alpha = -quarter, .limits = degrees(-225, 45)},
       {.d = .4318, .alpha = quarter, .limits = degrees(-110, 170)},
       {.alpha = -quarter, .limits = degrees(-100, 100)},
       {.d = .1, .limits = degrees(-266, 266)}}};
  const std::array<dh_row<>, 6> irb{{{.d = .29, .alpha = -quarter, .limits = degrees(-165, 165)},
                                     {.a = .27, .theta = -quarter, .limits = degrees(-110, 110)},
                                     {.a = .07, .alpha = -quarter, .limits = degrees(-110, 70)},
                                     {.d = .302, .alpha = quarter, .limits = degrees(-160, 160)},
                                     {.alpha = -quarter, .limits = degrees(-120, 120)},
                                     {.d = .072, .theta = pi, .limits = degrees(-400, 400)}}};
  const std::array<dh_row<>, 6> kr{
      {{.a = .025, .d = .4, .alpha = -quarter, .limits = degrees(-170, 170)},
       {.a = .455, .limits = degrees(-190, 45)},
       {.a = .035, .alpha = -quarter, .theta = -quarter, .limits = degrees(-120, 156)},
       {.d = .42, .alpha = quarter, .limits = degrees(-185, 185)},
       {.alpha = -quarter, .limits = degrees(-120, 120)},
       {.d = .08, .limits = degrees(-350, 350)}}};
  const std::array<dh_row<>, 6> mate{
      {{.a = .05, .d = .33, .alpha = -quarter, .limits = degrees(-170, 170)},
       {.a = .33, .theta = -quarter, .limits = degrees(-100, 145)},
       {.a = .035, .alpha = -quarter, .limits = degrees(-140, 213)},
       {.d = .335, .alpha = quarter, .limits = degrees(-190, 190)},
       {.alpha = -quarter, .limits = degrees(-125, 125)},
       {.d = .08, .limits = degrees(-360, 360)}}};
  return {{"UR5e", robots::ur5e().table()},
          {"PUMA 560", from_dh(puma)},
          {"IRB 120", from_dh(irb)},
          {"KR 6 R900", from_dh(kr)},
          {"LR Mate 200iD", from_dh(mate)}};
}

inline std::vector<arm<7>> redundant_arm() {
  return {{"Panda", robots::panda().table()},
          {"iiwa 14", robots::iiwa14().table()},
          {"Baxter", robots::baxter_left().table()}};
}

enum class family { across, near_wrist, past, from_elbow, from_wrist, structured };
constexpr std::array families{"across the wrist", "across, all joints",
                              "beside the wrist", "from a stretched elbow",
                              "from the wrist",   "multiples of 15 deg"};

template <int N>
struct problem {
  joints_of<N> start, end;
};

/// The coordinate of the elbow at which the wrist is farthest from the shoulder: the square of that
/// distance is A + B cos θ + C sin θ.
template <int N>
double stretched(const serial_chain<N>& chain, joints_of<N> theta, int elbow) {
  const auto square = [&](double x) {
    theta[elbow] = x;
    const auto shoulder = chain.pose(theta, N == 6 ? 1 : 2);
    const Eigen::Vector3d offset =
        translation(chain.pose(theta, N == 6 ? 4 : 5)) - translation(shoulder);
    const Eigen::Vector3d axis = rotate(rotation(shoulder), Eigen::Vector3d(0, 0, 1));
    return N == 6 ? (offset - axis.dot(offset) * axis).squaredNorm() : offset.squaredNorm();
  };
  const double centre = (square(0) + square(pi)) / 2;
  return std::atan2(square(pi / 2) - centre, square(0) - centre);
}

/// Starts in the inner 80 % of the joints' ranges. Across: joint 5 (of seven joints 6; of the Panda
/// 2) from x to −x, the others as they were, or up to 0.5
/// rad away, or next to nothing: 1e-6 to 1e-2 rad. From a stretched elbow, from joint 5 at 0: all
/// joints up to 0.5 and 1 rad away.
template <int N>
problem<N> make(const arm<N>& a, family kind, random_source& random) {
  const int wrist = N == 6 ? 4 : std::string(a.name) == "Panda" ? 1 : 5, elbow = N == 6 ? 2 : 3;
  problem<N> p;
  for (int i = 0; i < N; ++i) {
    const double lower = a.chain.limits(i).lower, upper = a.chain.limits(i).upper;
    p.start[i] = (lower + upper) / 2 + .4 * (upper - lower) * random.uniform(-1, 1);
  }
  if (kind == family::from_elbow) {
    p.start[elbow] = std::clamp(stretched(a.chain, p.start, elbow), a.chain.limits(elbow).lower,
                                a.chain.limits(elbow).upper);
  } else {
    const double max_angle =
        .8 * std::min(-a.chain.limits(wrist).lower, a.chain.limits(wrist).upper);
    p.start[wrist] = kind == family::from_wrist ? 0 : random.sign() * random.uniform(.1, max_angle);
  }
  p.end = p.start;
  const double spread = kind == family::across       ? 0
                        : kind == family::past       ? random.log_uniform(1e-6, 1e-2)
                        : kind >= family::from_wrist ? 1
                                                     : .5;
  for (int i = 0; i < N; ++i) {
    p.end[i] = std::clamp(p.end[i] + spread * random.uniform(-1, 1), a.chain.limits(i).lower,
                          a.chain.limits(i).upper);
  }
  if (kind < family::from_elbow) {
    p.end[wrist] = -p.start[wrist];
  }
  if (kind == family::structured) {
    const auto round = [](double x) { return pi / 12 * std::trunc(12 / pi * x); };
    p.start =
        p.start.unaryExpr(round).cwiseMax(lower_limits(a.chain)).cwiseMin(upper_limits(a.chain));
    p.end = p.end.unaryExpr(round).cwiseMax(lower_limits(a.chain)).cwiseMin(upper_limits(a.chain));
  }
  return p;
}

/// The problem of that number of a family with that seed.
template <int N>
problem<N> make(const arm<N>& a, family kind, unsigned seed, int number) {
  random_source random(seed);
  problem<N> p;
  for (int k = 0; k <= number; ++k) {
    p = make(a, kind, random);
  }
  return p;
}

/// The shorter screw from pose to pose.
struct screw {
  goal_pose first, last;
  goal_pose operator()(double u) const { return sclerp(first, last, u); }
};

} // namespace singular_problems
