// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

#include <duet/duet.hpp>

namespace test_spline_interpolate_poses {
namespace {

using number = duet::screw_dual<double>;
using pose = duet::quaternion<number>;
using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;
using twist = duet::vector6<double>;
using curve = duet::cumulative_bspline<number>;
using rotation_curve = duet::cumulative_bspline<double>;
using parameters = std::vector<double>;

std::vector<quaternion> rotations_of(const std::vector<pose>& poses) {
  std::vector<quaternion> result;
  for (const pose& a : poses) {
    result.push_back(rotation(a));
  }
  return result;
}

double max_abs_difference(const pose& a, const pose& b) {
  return std::max(duet_test::max_abs_difference(real_part(a), real_part(b)),
                  duet_test::max_abs_difference(dual_part(a), dual_part(b)));
}
double size_of(const twist& v) { return 1 + v.norm(); }

const twist start_rate(0.4, 0.1, -1, 0.3, -0.2, 0.5), end_rate(0, 0.3, 0.7, -1, 0, 0.4);
const vector start_angular(0.3, -0.2, 0.5), end_angular(-1, 0, 0.4);

/// Interpolates; checks that the curve passes through the data, that it is C² and that its
/// rotations are the curve through the rotations.
template <class Ends, class RotationEnds>
curve checked(const parameters& u, const std::vector<pose>& poses, const Ends& ends,
              const RotationEnds& rotation_ends) {
  const curve s = duet::interpolate<curve>(u, poses, ends);
  const rotation_curve r = duet::interpolate<rotation_curve>(u, rotations_of(poses), rotation_ends);
  for (std::size_t i = 0; i < u.size(); ++i) {
    CHECK(std::min(max_abs_difference(s(u[i]), poses[i]), max_abs_difference(s(u[i]), -poses[i])) <
          1e-13);
    CHECK(is_unit(s(u[i]), 1e-14));
    CHECK(duet_test::max_abs_difference(rotation(s(u[i])), r(u[i])) < 1e-14);
  }
  for (std::size_t i = 0; i < r.increments().size(); ++i) {
    CHECK((real_part(s.increments()[i]) - r.increments()[i]).norm() < 1e-14);
  }
  const auto& breaks = s.basis().breaks();
  for (std::size_t i = 1; i + 1 < breaks.size(); ++i) {
    const auto left = s.motion(std::nextafter(breaks[i], -1e9), duet::frame::spatial);
    const auto right = s.motion(breaks[i], duet::frame::spatial);
    CHECK(max_abs_difference(left.value, right.value) < 1e-13);
    CHECK((left.velocity - right.velocity).norm() < 1e-11 * size_of(right.velocity));
    CHECK((left.acceleration - right.acceleration).norm() <
          1e-11 * (size_of(right.acceleration) + right.jerk.norm()));
  }
  return s;
}

} // namespace

TEST_CASE("interpolate, poses: natural ends and given end twists and accelerations are met") {
  for (const std::size_t count : {2, 3, 9}) {
    for (const double step : {0.003, 0.7, 1.8}) {
      CAPTURE(count);
      CAPTURE(step);
      const parameters u = duet_test::uneven_parameters(count);
      const auto poses = duet_test::random_poses(count, step);
      const auto at_ends = [&](const curve& s) {
        return std::array{s.motion(u.front(), duet::frame::spatial),
                          s.motion(u.back(), duet::frame::spatial)};
      };
      const auto n = at_ends(checked(u, poses, duet::natural{}, duet::natural{}));
      CHECK(n[0].acceleration.norm() < 1e-11);
      CHECK(n[1].acceleration.norm() < 1e-11);
      const auto c = at_ends(checked(u, poses, duet::clamped{start_rate, end_rate},
                                     duet::clamped{start_angular, end_angular}));
      CHECK((c[0].velocity - start_rate).norm() < 1e-12);
      CHECK((c[1].velocity - end_rate).norm() < 1e-12);
      const auto a = at_ends(checked(u, poses, duet::end_acceleration{start_rate, end_rate},
                                     duet::end_acceleration{start_angular, end_angular}));
      CHECK((a[0].acceleration - start_rate).norm() < 1e-11);
      CHECK((a[1].acceleration - end_rate).norm() < 1e-11);
    }
  }
}

TEST_CASE("interpolate, poses: not-a-knot ends have a continuous jerk, periodic ends equal rates") {
  for (const std::size_t count : {4, 5, 9}) {
    const parameters u = duet_test::uneven_parameters(count);
    auto poses = duet_test::random_poses(count, 1.5);
    const curve s = checked(u, poses, duet::not_a_knot{}, duet::not_a_knot{});
    const auto left = s.motion(std::nextafter(u[1], -9), duet::frame::body).jerk;
    CHECK((left - s.motion(u[1], duet::frame::body).jerk).norm() < 1e-10 * size_of(left));
    poses.back() = -poses.front();
    const curve p = checked(u, poses, duet::periodic{}, duet::periodic{});
    const auto start = p.motion(u.front(), duet::frame::spatial);
    const auto end = p.motion(u.back(), duet::frame::spatial);
    CHECK((start.velocity - end.velocity).norm() < 1e-11 * size_of(start.velocity));
    CHECK((start.acceleration - end.acceleration).norm() <
          1e-11 * (size_of(start.acceleration) + start.jerk.norm()));
  }
}

TEST_CASE("interpolate, poses: pure translations follow the cubic spline of vectors") {
  const auto path = [](double u) { return vector(u * u * u - u, 2 * u * u, 1 - u); };
  const auto slope = [](double u) { return vector(3 * u * u - 1, 4 * u, -1); };
  const parameters u = duet_test::uneven_parameters(8);
  std::vector<pose> poses;
  for (const double x : u) {
    poses.push_back(duet::pose(quaternion(1), path(x)));
  }
  twist start = twist::Zero(), end = twist::Zero();
  start.head<3>() = slope(u.front());
  end.head<3>() = slope(u.back());
  const curve s = duet::interpolate<curve>(u, poses, duet::clamped{start, end});
  const curve t = duet::interpolate<curve>(u, poses, duet::not_a_knot{});
  for (double x = u.front(); x <= u.back(); x += 0.1) {
    CHECK((translation(s(x)) - path(x)).norm() < 1e-13 * (1 + path(x).norm()));
    CHECK((translation(t(x)) - path(x)).norm() < 1e-12 * (1 + path(x).norm()));
  }
}

TEST_CASE(
    "interpolate, poses: the curve is invariant to a change of the fixed and of the body frame") {
  const parameters u = duet_test::uneven_parameters(9);
  const auto poses = duet_test::random_poses(9, 1.2);
  const pose left = duet_test::random_poses(3, 2)[1], right = duet_test::random_poses(4, 2)[2];
  std::vector<pose> moved;
  for (const pose& a : poses) {
    moved.push_back(left * a * right);
  }
  const auto check = [&](const auto& ends) {
    const curve s = duet::interpolate<curve>(u, poses, ends);
    const curve t = duet::interpolate<curve>(u, moved, ends);
    for (double x = u.front(); x <= u.back(); x += 0.17) {
      CHECK(max_abs_difference(t(x), left * s(x) * right) < 1e-12);
    }
  };
  check(duet::natural{});
  check(duet::not_a_knot{});
}

TEST_CASE("interpolate, poses: steps of 2.8 rad and 3 units of length about random axes converge") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    duet_test::random_source random(seed);
    std::vector<pose> poses;
    parameters u;
    for (const quaternion& q : duet_test::rotated_by(2.8, 20, seed)) {
      const auto n = random.direction<3>();
      const vector before = poses.empty() ? vector(0, 0, 0) : translation(poses.back());
      poses.push_back(duet::pose(q, vector(before + 3 * vector(n[0], n[1], n[2]))));
      u.push_back(double(u.size()));
    }
    const curve s = duet::interpolate<curve>(u, poses);
    for (std::size_t i = 0; i < u.size(); ++i) {
      CHECK(std::min(max_abs_difference(s(u[i]), poses[i]),
                     max_abs_difference(s(u[i]), -poses[i])) < 1e-12);
    }
  }
}

} // namespace test_spline_interpolate_poses
