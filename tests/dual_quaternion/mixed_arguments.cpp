// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/mixed_arguments.hpp"
#include "support/test.hpp"

#include <duet/dual_quaternion/distance.hpp>
#include <duet/dual_quaternion/nearest.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/curves.hpp>

namespace test_dual_quaternion_mixed_arguments {

using namespace test_support::mixed;

TEST_CASE("poses: every function accepts constants mixed with derivatives") {
  DUET_CHECK_MIXED(make_dual_vector, u, v);
  DUET_CHECK_MIXED(make_dual_quaternion, p, q);
  DUET_CHECK_MIXED(pose, p, u);
  check(
      "+ - *", [](const auto& a, const auto& b) { return (a + b) * (a - b) * a * b; }, A, B);
  DUET_CHECK_MIXED(transform_point, A, u);
  DUET_CHECK_MIXED(transform_direction, A, u);
  DUET_CHECK_MIXED(transform_line, A, make_dual_vector(u, v));
  check(
      "transform_plane",
      [](const auto& a, const auto& n, const auto& d) {
        using T = promote_t<typename std::decay_t<decltype(n)>::Scalar, std::decay_t<decltype(d)>>;
        const auto moved = transform_plane(a, plane<T>{n.template cast<T>(), T(d)});
        return std::tuple(moved.normal, moved.offset);
      },
      A, u, 0.3);
  DUET_CHECK_MIXED(sclerp, A, B, 0.3);
  DUET_CHECK_MIXED(pow, A, 0.3);
  DUET_CHECK_MIXED(squad, A, B, A * B, B * A, 0.3);
  DUET_CHECK_MIXED(from_screw, u, v, 0.3, 0.7);
  check(
      "twist", [](const auto& a, const auto& rate) { return twist(a, rate, frame::body); }, A, B);
  check(
      "pose_rate", [](const auto& a, const auto& t) { return pose_rate(a, t, frame::spatial); }, A,
      xi);
  check(
      "pose_rate", [](const auto& a, const auto& t) { return pose_rate(a, t, frame::hybrid); }, A,
      xi);
  DUET_CHECK_MIXED(pose_coordinates_rate, A, xi);
  check(
      "distance", [](const auto& a, const auto& b) { return distance(a, b, 0.5); }, A, B);
  check(
      "squared_distance", [](const auto& a, const auto& b) { return squared_distance(a, b, 0.5); },
      A, B);
  check(
      "nearest_on_screw",
      [](const auto& start, const auto& end, const auto& other) {
        const auto nearest = nearest_on_screw(start, screw_parameters(end), other, 0.5);
        return std::tuple(nearest.tau, nearest.pose, nearest.squared_distance);
      },
      A, conj(A) * B, sclerp(A, B, 0.4) * pose(s, vector3<double>(0.01, 0.02, 0)));
}

} // namespace test_dual_quaternion_mixed_arguments
