// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual_quaternion/cases.hpp"
#include "support/identical.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>

#include <unsupported/Eigen/MatrixFunctions>

// Exponential, logarithm, ScLERP (N19) and screw parameters, with no special case for translations.

namespace test_dual_quaternion_screw {

using duet::conj, duet::exp, duet::sclerp, duet::screw_kind, duet::screw_parameters,
    duet_test::max_abs_difference, duet_test::poses, duet_test::vector;

using number = duet::screw_dual<double>;
using dual_quaternion = duet::dual_quaternion<double>;
using twist = duet::vector6<double>;

TEST_CASE("exp, log and pow: exp inverts log, exponents of powers add up") {
  for (const auto& a : poses()) {
    // Near a full turn the logarithm magnifies the rounding of A by 1/(2π − φ).
    const double tolerance = duet::real_part(a).w() < -0.9999 ? 1e-8 : 4e-15;
    CHECK(max_abs_difference(exp(duet::dual_vector<double>(log(a).vec())), a) < tolerance);
    CHECK(max_abs_difference(pow(a, 2), a * a) < tolerance);
    CHECK(max_abs_difference(pow(a, 0.25) * pow(a, 0.75), a) < tolerance);
    CHECK(max_abs_difference(pow(a, -1), conj(a)) < tolerance);
  }
}

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

TEST_CASE("N19: sclerp runs from A to B at constant velocity, invariant under rigid motions") {
  const auto all = poses();
  for (std::size_t i = 0; i + 3 < all.size(); i += 3) {
    const auto& a = all[i];
    const auto b = all[i + 3];
    CHECK(max_abs_difference(duet::transform_matrix(sclerp(a, b, 0.0)), duet::transform_matrix(a)) <
          1e-14);
    CHECK(max_abs_difference(duet::transform_matrix(sclerp(a, b, 1.0)), duet::transform_matrix(b)) <
          4e-14);
    if (std::abs(dot(a, b).value()) < 1e-12) {
      continue; // at a half turn both arcs are equally long
    }
    CHECK(max_abs_difference(sclerp(a, b, 0.4), sclerp(a, -b, 0.4)) == 0);
    // Moving both ends moves the poses between them.
    const auto c = duet::pose(duet::from_rotation_vector(vector(0.4, -0.2, 1)), vector(1, 2, -1));
    CHECK(max_abs_difference(sclerp(c * a, c * b, 0.3), c * sclerp(a, b, 0.3)) < 4e-14);
    // Equal steps give the same displacement.
    const auto step = conj(sclerp(a, b, 0.25)) * sclerp(a, b, 0.5);
    CHECK(max_abs_difference(conj(sclerp(a, b, 0.5)) * sclerp(a, b, 0.75), step) < 2e-14);
  }
}

TEST_CASE("sclerp: a pure translation follows a straight line") {
  const auto a = duet::pose(duet::quaternion<double>(1.0), vector(1, 0, 0));
  const auto b = duet::pose(duet::quaternion<double>(1.0), vector(1, 4, -2));
  CHECK(max_abs_difference(duet::translation(sclerp(a, b, 0.25)), vector(1, 1, -0.5)) == 0);
  const auto [c, rate] =
      duet::derivative<duet_test::shared_tag>([&](auto t) { return sclerp(a, b, t); }, 0.25);
  CHECK(max_abs_difference(2 * duet::dual_part(rate).vec(), vector(0, 4, -2)) == 0);
}

TEST_CASE("screw_parameters: axis, moment, angle and translation of known motions") {
  // Rotation by 1.2 about the line through (1, 2, 0) along z and translation by 0.5 along it.
  const vector axis(0, 0, 1);
  const vector point_on_axis(1, 2, 0);
  const auto a = duet::from_screw(axis, vector(point_on_axis.cross(axis)), 1.2, 0.5);
  for (const auto& s : {screw_parameters(a), screw_parameters(-a)}) {
    CHECK(s.kind == screw_kind::screw);
    CHECK(max_abs_difference(s.axis, axis) < 1e-15);
    CHECK(max_abs_difference(s.moment, point_on_axis.cross(axis)) < 1e-15 * 4);
    CHECK(s.angle == doctest::Approx(1.2).epsilon(1e-15));
    CHECK(s.translation == doctest::Approx(0.5).epsilon(1e-15));
  }
  CHECK(max_abs_difference(duet::transform_point(a, point_on_axis), point_on_axis + 0.5 * axis) <
        1e-15);

  const auto pure_rotation = duet::from_screw(axis, vector(point_on_axis.cross(axis)), 1.2, 0.0);
  CHECK(screw_parameters(pure_rotation).kind == screw_kind::rotation);

  const auto shift = duet::pose(duet::quaternion<double>(1.0), vector(0, -3, 4));
  const auto s = screw_parameters(shift);
  CHECK(s.kind == screw_kind::translation);
  CHECK(max_abs_difference(s.axis, vector(0, -0.6, 0.8)) < 1e-15);
  CHECK(s.translation == doctest::Approx(5).epsilon(1e-15));
  CHECK(s.angle == 0);
  CHECK(s.moment.isZero(0));

  const auto none = screw_parameters(dual_quaternion(number(1)));
  CHECK(none.kind == screw_kind::none);
  CHECK(none.axis.isZero(0));
  CHECK(none.translation == 0);

  // The tolerance decides if a tiny rotation counts as zero.
  const auto tiny = duet::from_screw(axis, vector(point_on_axis.cross(axis)), 1e-9, 0.5);
  CHECK(screw_parameters(tiny).kind == screw_kind::translation);
  CHECK(screw_parameters(tiny, 1e-12).kind == screw_kind::screw);
  CHECK(screw_parameters(tiny, 1e-12).angle == doctest::Approx(1e-9).epsilon(1e-12));
}

TEST_CASE("from_screw: inverts screw_parameters") {
  for (const auto& a : poses()) {
    const auto s = screw_parameters(a, 1e-300);
    if (s.kind == screw_kind::none || s.kind == screw_kind::translation) {
      continue;
    }
    CHECK(std::abs(s.axis.norm() - 1) < 1e-15);
    CHECK(s.angle >= 0);
    CHECK(s.angle <= 3.1415926535897936);
    if (s.angle > 1e-5) {
      CHECK(std::abs(s.axis.dot(s.moment)) < 1e-13 * (1 + s.moment.norm()));
      const auto again = duet::from_screw(s);
      CHECK(std::min(max_abs_difference(again, a), max_abs_difference(again, -a)) < 1e-9);
    }
  }
}

TEST_CASE("screw_parameters: the point of the axis nearest to the origin") {
  const duet::vector3<double> on_axis(1, 2, 0), n(0, 0, 1); // axis through (1, 2, 5) along z
  const auto a = duet::from_screw(n, on_axis.cross(n).eval(), 0.7, 0.3);
  CHECK((duet::screw_parameters(a).point() - on_axis).norm() < 1e-14);
  const auto shift = duet::pose(duet::quaternion<double>(1.0), on_axis);
  CHECK(duet::screw_parameters(shift).point() == duet::vector3<double>(0, 0, 0));
}

} // namespace test_dual_quaternion_screw
