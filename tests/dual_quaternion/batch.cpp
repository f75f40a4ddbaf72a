// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/lanes.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/dual_quaternion/distance.hpp>
#include <duet/dual_quaternion/exponential_jacobian.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>

namespace test_dual_quaternion_batch {
namespace {

using namespace duet;
using duet_test::check_lanes;

constexpr double limit = 8;

/// The identity, pure translations, tiny motions, half turns, nearly full turns, random motions.
std::vector<dual_quaternion<double>> displacements() {
  duet_test::random_source random(9);
  std::vector<dual_quaternion<double>> result;
  const auto add = [&](const vector3<double>& r, const vector3<double>& shift) {
    result.push_back(pose(from_rotation_vector(r), shift));
  };
  add({0, 0, 0}, {0, 0, 0});
  add({0, 0, 0}, {1, -2, 3});
  add({1e-9, 0, 2e-9}, {0, 1, 0});
  add({0, 3.141592653589793, 0}, {0, 1, 2});
  add({6.2, 0, 0}, {0.5, 0, 0});
  while (result.size() < 11) {
    const auto number = [&] { return random.uniform(-2, 2); };
    const vector3<double> r(number(), number(), number());
    add(r, {number(), number(), number()});
  }
  return result;
}

TEST_CASE("batches: rigid motions agree with each lane") {
  const auto a = displacements();
  auto b = a;
  std::swap(b[0], b[3]);
  std::swap(b[1], b[7]);
  check_lanes<4>([](const auto& p, const auto& q) { return p * conj(q); }, limit, a, b);
  DUET_CHECK_LANES(log, limit, a);
  check_lanes<4>([](const auto& p) { return pow(p, 0.4); }, limit, a);
  check_lanes<4>([](const auto& p, const auto& q) { return sclerp(p, q, 0.3); }, 2 * limit, a, b);
  check_lanes<4>([](const auto& p) { return normalized(3 * p); }, limit, a);
  DUET_CHECK_LANES(transform_matrix, limit, a);
  check_lanes<4>([](const auto& p) { return from_transform_matrix(transform_matrix(p)); }, limit,
                 a);
  check_lanes<4>([](const auto& p, const auto& q) { return twist(p, q, frame::hybrid); }, limit, a,
                 b);
  check_lanes<4>(
      [](const auto& tau) { return sclerp(displacements()[5], displacements()[6], tau); },
      2 * limit, std::vector<dual<double>>{{0.0, 1.0}, {0.3, 1.0}, {1.0, 2.0}});
}

TEST_CASE("batches: distances whose squares overflow or underflow agree with each lane") {
  const auto at = [](double x) {
    return pose(from_rotation_vector(vector3<double>(0, 0, 0.1)), vector3<double>(x, 0, 0));
  };
  const std::vector<dual_quaternion<double>> a{at(0), at(1e-170), at(1e170), at(1), at(-2e180)};
  const std::vector<dual_quaternion<double>> b{at(0), at(3e-170), at(1), at(1.5), at(0)};
  check_lanes<4>([](const auto& p, const auto& q) { return distance(p, q, 1.0); }, limit, a, b);
}

TEST_CASE("batches: transformed points, lines, twists and Jacobians agree with each lane") {
  const auto a = displacements();
  auto b = a;
  std::rotate(b.begin(), b.begin() + 4, b.end());
  std::vector<vector3<double>> points;
  std::vector<vector6<double>> twists;
  std::vector<dual_vector<double>> lines;
  std::vector<vector7<double>> coordinates;
  for (const auto& p : b) {
    points.push_back(translation(p) + vector3<double>(1, 0, 0));
    const vector3<double> r = rotation_vector(rotation(p));
    twists.emplace_back();
    twists.back() << translation(p), r;
    lines.push_back(dual_vector_of(twists.back()));
    coordinates.push_back(pose_coordinates(p));
  }
  DUET_CHECK_LANES(transform_point, limit, a, points);
  DUET_CHECK_LANES(transform_direction, limit, a, points);
  DUET_CHECK_LANES(transform_line, limit, a, lines);
  check_lanes<4>([](const auto& p) { return dual_conj(p) * point_conj(p); }, limit, a);
  DUET_CHECK_LANES(translation, limit, a);
  DUET_CHECK_LANES(Ad, limit, a);
  DUET_CHECK_LANES(coAd, limit, a);
  DUET_CHECK_LANES(ad, limit, twists);
  DUET_CHECK_LANES(coad, limit, twists);
  check_lanes<4>([](const auto& x) { return exp(dual_vector_of(x)); }, limit, twists);
  DUET_CHECK_LANES(left_jacobian, limit, twists);
  DUET_CHECK_LANES(right_jacobian, limit, twists);
  DUET_CHECK_LANES(left_jacobian_inverse, 2 * limit, twists);
  DUET_CHECK_LANES(right_jacobian_inverse, 2 * limit, twists);
  check_lanes<4>([](const auto& p, const auto& x) { return pose_rate(p, x, frame::body); }, limit,
                 a, twists);
  DUET_CHECK_LANES(pose_coordinates, limit, a);
  DUET_CHECK_LANES(from_pose_coordinates, limit, coordinates);
  DUET_CHECK_LANES(pose_rate_matrix, limit, a);
  DUET_CHECK_LANES(pose_coordinates_rate, limit, a, twists);
  check_lanes<4>([](const auto& p, const auto& q) { return squared_distance(p, q, 0.5); }, limit, a,
                 b);
  check_lanes<4>([](const auto& p, const auto& q) { return distance(p, q, 0.5); }, limit, a, b);
  check_lanes<4>(
      [](const auto& angle, const auto& shift) {
        using T = std::decay_t<decltype(angle)>;
        return from_screw(vector3<T>(T(0), T(0.6), T(0.8)), vector3<T>(T(1), T(0.4), T(-0.3)),
                          angle, shift);
      },
      limit, std::vector<double>{0, 1e-9, 0.3, 3.1, -2}, std::vector<double>{0, 0.5, -1});
  using B = batch<double, 4>;
  const auto unit = is_unit(from_lanes<4>([&](std::size_t i) {
    return i == 2 ? dual_quaternion<double>(a[2] * screw_dual<double>(1.1)) : a[i];
  }));
  for (int i = 0; i < B::lanes; ++i) {
    CHECK(unit[i] == (i != 2));
  }
}

} // namespace
} // namespace test_dual_quaternion_batch
