// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>

#include "support/lanes.hpp"
#include "support/random.hpp"

#include <doctest/doctest.h>

#include <vector>

namespace test_dual_quaternion_batch {

using namespace duet;
using duet_test::check_lanes;

namespace {

constexpr double limit = 8;

/// No motion, pure translation, tiny, half a turn, nearly a full turn, random.
std::vector<dual_quaternion<double>> displacements() {
  duet_test::random_source random(9);
  std::vector<dual_quaternion<double>> result;
  const auto add = [&](const vector3<double>& turn, const vector3<double>& shift) {
    result.push_back(pose(from_rotation_vector(turn), shift));
  };
  add({0, 0, 0}, {0, 0, 0});
  add({0, 0, 0}, {1, -2, 3});
  add({1e-9, 0, 2e-9}, {0, 1, 0});
  add({0, 3.141592653589793, 0}, {0, 1, 2});
  add({6.2, 0, 0}, {0.5, 0, 0});
  while (result.size() < 11) {
    const auto number = [&] { return random.uniform(-2, 2); };
    const vector3<double> turn(number(), number(), number());
    add(turn, {number(), number(), number()});
  }
  return result;
}

} // namespace

TEST_CASE("motions over batches are those of the lanes") {
  const auto a = displacements();
  auto b = a;
  std::swap(b[0], b[3]);
  std::swap(b[1], b[7]);
  check_lanes<4>([](const auto& p, const auto& q) { return p * conj(q); }, limit, a, b);
  check_lanes<4>([](const auto& p) { return log(p); }, limit, a);
  check_lanes<4>([](const auto& p) { return pow(p, 0.4); }, limit, a);
  check_lanes<4>([](const auto& p, const auto& q) { return sclerp(p, q, 0.3); }, 2 * limit, a, b);
  check_lanes<4>([](const auto& p) { return normalized(3 * p); }, limit, a);
  check_lanes<4>([](const auto& p) { return transform_matrix(p); }, limit, a);
  check_lanes<4>([](const auto& p) { return from_transform_matrix(transform_matrix(p)); }, limit,
                 a);
  check_lanes<4>([](const auto& p, const auto& q) { return twist(p, q, frame::hybrid); }, limit, a,
                 b);
  check_lanes<4>(
      [](const auto& tau) { return sclerp(displacements()[5], displacements()[6], tau); },
      2 * limit, std::vector<dual<double>>{{0.0, 1.0}, {0.3, 1.0}, {1.0, 2.0}});
}

} // namespace test_dual_quaternion_batch
