// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/gap.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

#include <Eigen/Core>

/// \file
/// Arms and configurations for tests.

namespace duet_test {

template <int N>
using coordinates = Eigen::Matrix<double, N, 1>;

template <class F>
void for_each_frame(F&& f) {
  f(duet::frame::spatial);
  f(duet::frame::body);
  f(duet::frame::hybrid);
}

/// Configurations: zero, tiny, half turns, a bent elbow, then random; singular ones first.
template <class Chain>
std::vector<coordinates<Chain::joints>> configurations(const Chain& chain, int count) {
  constexpr int n = Chain::joints;
  using joint_vector = coordinates<n>;
  std::vector<joint_vector> result = {joint_vector::Zero(), joint_vector::Constant(1e-8),
                                      joint_vector::Constant(1e-160),
                                      joint_vector::Constant(3.141592653589793)};
  joint_vector elbow = joint_vector::Zero();
  elbow[n / 2] = -1.5707963267948966;
  result.push_back(elbow);
  random_source random(11);
  for (int k = 0; k < count; ++k) {
    joint_vector theta;
    for (int i = 0; i < n; ++i) {
      const double bound = std::min(3.5, chain.limits(i).upper);
      theta[i] = random.uniform(-bound, bound);
    }
    result.push_back(theta);
  }
  return result;
}

/// A chain with all types of joints, with axes in general directions.
inline duet::serial_chain<7> every_joint() {
  using duet::joint_kind;
  const auto n = [](double x, double y, double z) {
    const double length = std::sqrt(x * x + y * y + z * z);
    return std::array<double, 3>{x / length, y / length, z / length};
  };
  const auto origin = [](double a, double b, double c, double x, double y, double z) {
    return duet::placement<double>(
        duet::pose(duet::from_rotation_vector(Eigen::Vector3d(a, b, c)), Eigen::Vector3d(x, y, z)));
  };
  std::array<duet::joint<>, 7> joints;
  joints[0] = {joint_kind::revolute, origin(0, 0, 0, 0, 0, .3), n(0, 0, 1)};
  joints[1] = {joint_kind::prismatic, origin(.3, -1, .2, .1, .2, -.1), n(1, 2, -.3)};
  joints[2] = {joint_kind::helical, origin(1, 0, 2, .3, 0, .2), n(.2, -.4, 1), {}, .07};
  joints[3] = {joint_kind::continuous, origin(-.5, .6, 0, 0, .5, 0), n(0, 1, 0)};
  joints[4] = {joint_kind::prismatic, origin(0, 0, 1, 0, 0, .4), n(0, 0, 1)};
  joints[5] = {joint_kind::helical, origin(.1, .2, .3, .2, .1, 0), n(1, 1, 1), {}, -.4};
  joints[6] = {joint_kind::revolute, origin(2, 1, 0, .05, 0, .1), n(-1, .5, 0)};
  return duet::serial_chain<7>(joints, origin(.4, .5, .6, .1, .2, .3));
}

/// Calls f(chain, name) on the arms as tables of 7 joints, and on the one with 6.
template <class F>
void for_each_arm(F&& f) {
  const auto run = [&](const auto& chain, const char* name) {
    CAPTURE(name);
    f(chain);
  };
  run(duet::robots::panda().table(), "panda");
  run(duet::robots::iiwa14().table(), "iiwa14");
  run(duet::robots::baxter_left().table(), "baxter_left");
  run(every_joint(), "every kind of joint");
  run(duet::robots::ur5e().table(), "ur5e");
}

/// Calls f(chain, name) on the arms known to the compiler.
template <class F>
void for_each_known_arm(F&& f) {
  f(duet::robots::panda());
  f(duet::robots::iiwa14());
  f(duet::robots::baxter_left());
  f(duet::robots::ur5e());
}

} // namespace duet_test
