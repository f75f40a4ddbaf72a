// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/interop/eigen.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Geometry>

// Eigen's rotations and duet's are the same: Hamilton product, active.

namespace test_interop_eigen {
namespace {

using duet::dual;
using duet::quaternion;
using duet_test::random_source;

quaternion<double> random_rotation(random_source& random) {
  const auto d = random.direction<4>();
  return normalized(quaternion<double>(d[0], d[1], d[2], d[3]));
}

TEST_CASE("to_eigen and from_eigen: conversion there and back changes nothing") {
  const quaternion<double> q(1, 2, 3, 4);
  const Eigen::Quaterniond e = duet::to_eigen(q);
  CHECK(e.w() == 1);
  CHECK(e.vec() == Eigen::Vector3d(2, 3, 4));
  CHECK(duet::from_eigen(e) == q);
  using D = dual<double>;
  const quaternion<D> moving(D(1, 5), D(2, 6), D(3, 7), D(4, 8));
  CHECK(duet::from_eigen(duet::to_eigen(moving)).z().epsilon() == 8);
  double memory[] = {2, 3, 4, 1}; // x, y, z, w
  CHECK(duet::from_eigen(Eigen::Map<Eigen::Quaterniond>(memory)) == q);
}

TEST_CASE("Eigen::Quaternion: products, conjugates, matrices and rotated vectors agree") {
  random_source random(1);
  for (int i = 0; i < 100; ++i) {
    const auto p = random_rotation(random);
    const auto q = random_rotation(random);
    const auto ep = duet::to_eigen(p);
    const auto eq = duet::to_eigen(q);
    const Eigen::Vector3d v(random.normal(), random.normal(), random.normal());
    CHECK(norm(duet::from_eigen(ep * eq) - p * q) <= 1e-15);
    CHECK(duet::from_eigen(ep.conjugate()) == conj(p));
    CHECK((ep.toRotationMatrix() - rotation_matrix(p)).norm() <= 1e-15);
    CHECK((ep * v - rotate(p, v)).norm() <= 1e-15 * (1 + v.norm()));
    const auto back = duet::from_eigen(Eigen::Quaterniond(rotation_matrix(p)));
    CHECK(norm(dot(back, p) < 0 ? -back - p : back - p) <= 2e-15);
    const double tau = random.unit();
    CHECK(norm(duet::from_eigen(ep.slerp(tau, eq)) - slerp(p, q, tau)) <= 1e-14);
  }
}

TEST_CASE("from_eigen: axis and angle agree with from_axis_angle") {
  random_source random(2);
  for (int i = 0; i < 100; ++i) {
    const auto d = random.direction<3>();
    const Eigen::Vector3d n = Eigen::Vector3d(d[0], d[1], d[2]);
    const double angle = random.uniform(-6, 6);
    const Eigen::AngleAxisd angle_axis(angle, n);
    CHECK(norm(duet::from_eigen(angle_axis) - duet::from_axis_angle(n, angle)) <= 1e-15);
    CHECK(norm(duet::from_eigen(angle_axis) -
               duet::from_rotation_vector(Eigen::Vector3d(angle * n))) <= 1e-15);
  }
}

TEST_CASE("to_eigen and from_eigen: poses and isometries act alike and convert without loss") {
  const auto a = duet::pose(duet::from_rotation_vector(Eigen::Vector3d(0.4, -1, 2)),
                            Eigen::Vector3d(1, 2, -3));
  const auto b = duet::pose(duet::from_rotation_vector(Eigen::Vector3d(-2, 0.1, 0.3)),
                            Eigen::Vector3d(0, 0.5, 4));
  const Eigen::Isometry3d product = duet::to_eigen(a) * duet::to_eigen(b);
  CHECK((product.matrix() - duet::transform_matrix(a * b)).cwiseAbs().maxCoeff() < 4e-15);
  const Eigen::Vector3d x(0.3, -0.7, 2);
  CHECK((duet::to_eigen(a) * x - duet::transform_point(a, x)).norm() < 2e-15);
  CHECK((duet::to_eigen(a).inverse().matrix() - duet::transform_matrix(conj(a)))
            .cwiseAbs()
            .maxCoeff() < 2e-15);
  const auto back = duet::from_eigen(duet::to_eigen(a));
  CHECK((duet::transform_matrix(back) - duet::transform_matrix(a)).cwiseAbs().maxCoeff() < 2e-15);
  Eigen::Isometry3d mirror = Eigen::Isometry3d::Identity();
  mirror.linear()(0, 0) = -1;
  CHECK_THROWS_AS((void)duet::from_eigen(mirror), duet::invalid_input);
}

} // namespace
} // namespace test_interop_eigen
