// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/dual_quaternion/exponential_jacobian.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/interop/multiprecision.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/rotation.hpp>

// Axes, rotation vectors, velocities and matrices given as integers are those of real numbers.

namespace test_dual_quaternion_integers {
namespace {

using namespace duet;

const Eigen::Vector3i z(0, 0, 1), odd(1, -3, 2);
const Eigen::Vector3d z_real(0, 0, 1), odd_real(1, -3, 2);

/// True if both have equal values and the same type.
template <class A>
bool same(const A& a, const A& b) {
  return a == b;
}

TEST_CASE("integer axes and rotation vectors give the same values as real ones") {
  CHECK(same(from_axis_angle(z, 0.2), from_axis_angle(z_real, 0.2)));
  CHECK(same(from_axis_angle(odd, 1), from_axis_angle(odd_real, 1.0)));
  CHECK(same(from_axis_angle(odd_real, 1), from_axis_angle(odd_real, 1.0)));
  CHECK(same(from_axis_angle(odd, 0.5F), from_axis_angle(vector3<float>(1, -3, 2), 0.5F)));
  CHECK(same(from_rotation_vector(odd), from_rotation_vector(odd_real)));
  CHECK(same(duet::exp(odd), duet::exp(odd_real)));
  CHECK(same(from_two_vectors(z, odd), from_two_vectors(z_real, odd_real)));
  CHECK(same(from_two_vectors(z, odd_real), from_two_vectors(z_real, odd_real)));
  // The precision is that of the other argument, which may be differentiated.
  const real_50 angle(0.3);
  CHECK(same(from_axis_angle(odd, angle), from_axis_angle(vector3<real_50>(1, -3, 2), angle)));
  const auto rotation_about = [](const auto& n) {
    return [=](const auto& a) { return from_axis_angle(n, a); };
  };
  CHECK(derivative(rotation_about(odd), 0.7).derivative ==
        derivative(rotation_about(odd_real), 0.7).derivative);
  CHECK_THROWS_AS(static_cast<void>(from_axis_angle(Eigen::Vector3i(0, 0, 0), 1)), invalid_input);
}

TEST_CASE("integer rotation matrices and arguments of Jacobians act as real ones") {
  Eigen::Matrix3i quarter;
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  CHECK(same(from_rotation_matrix(quarter),
             from_rotation_matrix(matrix3<double>(quarter.cast<double>()))));
  CHECK(same(left_jacobian(odd), left_jacobian(odd_real)));
  CHECK(same(right_jacobian(odd), right_jacobian(odd_real)));
  CHECK(same(left_jacobian_inverse(odd), left_jacobian_inverse(odd_real)));
  CHECK(same(right_jacobian_inverse(odd), right_jacobian_inverse(odd_real)));
}

TEST_CASE("integer velocities: halves of odd numbers are not truncated") {
  const auto q = from_axis_angle(odd_real, 0.4);
  for (const auto& w : {z, odd}) {
    const Eigen::Vector3d real = w.cast<double>();
    CHECK(same(quaternion_rate(q, w, frame::body), quaternion_rate(q, real, frame::body)));
    CHECK(same(quaternion_acceleration(q, odd, w, frame::spatial),
               quaternion_acceleration(q, odd_real, real, frame::spatial)));
  }
  const quaternion<float> single(q);
  CHECK(same(quaternion_rate(single, odd, frame::spatial),
             quaternion_rate(single, vector3<float>(1, -3, 2), frame::spatial)));
  const auto a = pose(q, odd_real);
  const vector6<int> twist = (vector6<int>() << 1, 2, 3, -1, 5, 7).finished();
  const vector6<double> real = twist.cast<double>();
  CHECK(same(pose_rate(a, twist, frame::body), pose_rate(a, real, frame::body)));
  CHECK(same(pose_rate(a, twist, frame::spatial), pose_rate(a, real, frame::spatial)));
  CHECK(same(pose_rate(a, twist, frame::hybrid), pose_rate(a, real, frame::hybrid)));
  CHECK(same(left_jacobian(twist), left_jacobian(real)));
  CHECK(same(right_jacobian_inverse(twist), right_jacobian_inverse(real)));
}

TEST_CASE("integer screws and lines give the same values as real ones") {
  const Eigen::Vector3i moment(3, 1, 0);
  const Eigen::Vector3d moment_real(3, 1, 0);
  CHECK(same(from_screw(z, moment, 1, 3), from_screw(z_real, moment_real, 1.0, 3.0)));
  CHECK(same(from_screw(z, moment, 0.3, 1), from_screw(z_real, moment_real, 0.3, 1.0)));
  CHECK(same(make_dual_vector(z, moment), make_dual_vector(z_real, moment_real)));
  CHECK(same(pose(from_axis_angle(z, 1), moment), pose(from_axis_angle(z, 1), moment_real)));
}

} // namespace
} // namespace test_dual_quaternion_integers
