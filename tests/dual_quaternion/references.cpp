// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual_quaternion/cases.hpp"
#include "support/identical.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/rate.hpp>

#include <boost/numeric/odeint.hpp>
#include <unsupported/Eigen/MatrixFunctions>

// Rigid motion against independent methods: matrix exponential and logarithm, numerical
// integration, long products.

namespace test_dual_quaternion_references {
namespace {

using duet_test::max_abs_difference, duet_test::poses, duet_test::vector;
using dual_quaternion = duet::dual_quaternion<double>;
using twist = duet::vector6<double>;

double size_of(const duet::quaternion<double>& q) { return norm(q); }

/// Near a full turn the logarithm multiplies the part of a motion across the axis by φ / sin φ, and
/// also the rounding errors of the part along the axis, which cancel unless operations are fused.
double amplification(const dual_quaternion& a) {
  const duet::quaternion<double> q = duet::real_part(a);
  const double sine = q.vec().norm();
  return sine > 0 && q.w() < 0 ? std::atan2(sine, q.w()) / sine : 1;
}

/// The matrix [ω̂ v; 0 0] of a twist.
Eigen::Matrix4d matrix_of(const twist& x) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m.topLeftCorner<3, 3>() = duet::ad(x).topLeftCorner<3, 3>();
  m.topRightCorner<3, 1>() = x.head<3>();
  return m;
}

TEST_CASE("exp and log: agree with those of 4×4 matrices") {
  for (const auto& a : poses()) {
    const twist x = 2 * duet::twist_of<double>(log(a).vec());
    CAPTURE(x.transpose());
    if (x.norm() > 1e3) {
      continue; // near a full turn the axis is so far away that the sum over the matrix cancels
    }
    const Eigen::Matrix4d m = matrix_of(x).exp();
    const double size = 1 + x.norm();
    const double rounding = duet_test::if_fused(1e-15 * amplification(a));
    CHECK(max_abs_difference(m, duet::transform_matrix(a)) < 4e-15 * size + rounding);
    if (x.tail<3>().norm() < 3) { // the principal logarithm
      const Eigen::Matrix4d back = duet::transform_matrix(a).log();
      CHECK(max_abs_difference(back, matrix_of(x)) < 4e-14 * size);
    }
  }
}

TEST_CASE("exp and log: exp(log A) = A within 8 ulp") {
  for (const auto& a : poses()) {
    const auto v = log(a).vec();
    const auto back = duet::exp(duet::dual_vector<double>(v));
    CHECK(size_of(duet::real_part(back) - duet::real_part(a)) < 8 * 0x1p-53);
    // Near a full turn the moment in log A is as far away as the axis.
    const double scale = size_of(duet::dual_part(a)) + duet::dual_part(v).norm();
    const double rounding = duet_test::if_fused(1e-15 * amplification(a));
    CHECK(size_of(duet::dual_part(back) - duet::dual_part(a)) <=
          8 * 0x1p-53 * (1e-300 + scale) + rounding);
  }
}

TEST_CASE("pose_rate and quaternion_rate: integrated numerically give the screw motion") {
  using state = std::array<double, 8>;
  const auto pose_of = [](const state& s) {
    return duet::make_dual_quaternion(duet::quaternion<double>(s[0], s[1], s[2], s[3]),
                                      duet::quaternion<double>(s[4], s[5], s[6], s[7]));
  };
  const auto start = duet::pose(duet::from_rotation_vector(vector(0.4, -1, 0.2)), vector(1, 0, 2));
  twist v;
  v << 0.3, -0.8, 0.5, 1.2, 0.4, -2;
  const auto spatial = [&](const state& s, state& rate, double) {
    const auto a_dot = duet::pose_rate(pose_of(s), v, duet::frame::spatial);
    const auto p = duet::real_part(a_dot);
    const auto q = duet::dual_part(a_dot);
    rate = {p.w(), p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
  };
  const auto p = duet::real_part(start);
  const auto q = duet::dual_part(start);
  state s = {p.w(), p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
  using namespace boost::numeric::odeint;
  integrate_adaptive(make_controlled<runge_kutta_fehlberg78<state>>(1e-13, 1e-13), spatial, s, 0.0,
                     1.7, 0.01);
  // A constant spatial twist is one screw motion.
  const auto expected =
      duet::exp(duet::dual_vector<double>(duet::dual_vector_of(v) * (1.7 / 2))) * start;
  CHECK(max_abs_difference(pose_of(s), expected) < 1e-11);
  // Its real part has integrated q̇ = ½ ω q.
  const auto expected_rotation = duet::exp(duet::vector3<double>(v.tail<3>() * (1.7 / 2))) * p;
  CHECK(size_of(duet::real_part(pose_of(s)) - expected_rotation) < 1e-11);
}

TEST_CASE("products: the norm drifts little over a million, normalized restores it") {
  duet_test::random_source random(21);
  dual_quaternion a = duet::pose(duet::quaternion<double>(1.0), vector(0, 0, 0));
  std::array<dual_quaternion, 64> steps;
  for (auto& step : steps) {
    const auto n = random.direction<3>();
    const double angle = random.uniform(0, 3);
    step = duet::pose(duet::from_rotation_vector(vector(angle * n[0], angle * n[1], angle * n[2])),
                      vector(n[1], n[2], n[0]));
  }
  for (int i = 0; i < 1000000; ++i) {
    a = steps[std::size_t(i * 37 + i / 64) % 64] * a;
  }
  const auto unit = squared_norm(a);
  const double distance = duet::translation(a).norm();
  MESSAGE("after 1e6 products |A A* - 1| = ", std::abs(unit.value() - 1), " + eps ",
          std::abs(unit.epsilon()), " at |t| = ", distance);
  CHECK(std::abs(unit.value() - 1) < 1e-10);
  CHECK(std::abs(unit.epsilon()) < 1e-10 * (1 + distance));
  const auto restored = squared_norm(normalized(a));
  CHECK(std::abs(restored.value() - 1) <= 4 * 0x1p-53);
  CHECK(std::abs(restored.epsilon()) <= 8 * 0x1p-53 * (1 + distance));
}

} // namespace
} // namespace test_dual_quaternion_references
