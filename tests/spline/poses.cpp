// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

namespace test_spline_poses {
namespace {

using number = duet::screw_dual<double>;
using pose = duet::quaternion<number>;
using vector = duet::vector3<double>;
using curve = duet::cumulative_bspline<number>;

const std::vector<double> knots = duet_test::knot_vectors(4)[1].knots;
const std::vector<double> parameters = duet_test::parameters_on(knots, 4, 1);

const curve s(knots, duet_test::random_poses(knots.size() - 4, 1.2));

double max_abs_difference(const pose& a, const pose& b) {
  return std::max(duet_test::max_abs_difference(real_part(a), real_part(b)),
                  duet_test::max_abs_difference(dual_part(a), dual_part(b)));
}

TEST_CASE(
    "cumulative_bspline over poses: its rotation is the curve of the rotations, values are units") {
  std::vector<duet::quaternion<double>> rotations;
  for (const pose& a : s.control_points()) {
    rotations.push_back(rotation(a));
  }
  const duet::cumulative_bspline<double> r(knots, rotations);
  for (const double u : parameters) {
    CHECK(duet_test::max_abs_difference(rotation(s(u)), r(u)) < 1e-15);
    CHECK(is_unit(s(u), 1e-14));
  }
}

TEST_CASE("P1: for pure translations the curve over poses is the B-spline of the vectors") {
  std::vector<pose> shifts;
  std::vector<vector> points;
  duet_test::random_source random(3);
  for (std::size_t i = 0; i + 4 < knots.size(); ++i) {
    points.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    shifts.push_back(duet::pose(duet::quaternion<double>(1), points.back()));
  }
  const curve t(knots, shifts);
  for (const double u : parameters) {
    vector sum = vector::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      sum += points[i] * duet::basis_function(knots, i, 4, u);
    }
    CHECK((translation(t(u)) - sum).norm() < 1e-14);
    CHECK(duet_test::max_abs_difference(rotation(t(u)), duet::quaternion<double>(1)) == 0);
  }
}

TEST_CASE("cumulative_bspline over poses: order 2 gives screw motions between neighbours") {
  const std::vector<double> uneven = {0, 0, 1, 3, 3.5, 3.5};
  const duet::cumulative_bspline<number, 2> t(uneven, duet_test::random_poses(4, 2));
  for (const double x : {0.0, 0.2, 0.7, 0.99}) {
    CHECK(max_abs_difference(
              t(1 + 2 * x), duet::sclerp(t.control_points()[1], t.control_points()[2], x)) < 1e-14);
  }
}

TEST_CASE("motion over poses: hybrid rates have no cancellation far from the origin") {
  // The body rotates about its origin only (shift 0), or also moves along its axes at a rate of 1.
  using scalar = duet::screw_dual<double>;
  const double far = 1e8;
  const auto start = duet::pose(duet::from_rotation_vector(duet::vector3<double>(0.3, -0.2, 1.1)),
                                duet::vector3<double>(far, -far, 2 * far));
  const auto curve = [&](double shift) {
    std::vector<duet::vector3<scalar>> increments;
    std::vector<duet::dual_quaternion<double>> controls;
    for (int i = 0; i < 5; ++i) {
      increments.push_back({scalar(0.1 * i, shift / 2), scalar(0.4), scalar(-0.2 * i)});
      controls.push_back(i == 0 ? start : controls.back() * duet::exp(increments.back()));
    }
    return duet::cumulative_bspline<scalar>(
        duet::bspline_basis<4, double>({-3, -2, -1, 0, 1, 2, 3, 4, 5}), controls, increments);
  };
  for (const double u : {0.0, 0.3, 1.0, 1.9}) {
    const auto still = curve(0).motion(u, duet::frame::hybrid);
    CHECK(still.velocity.tail<3>().norm() > 0.1);
    CHECK(still.velocity.head<3>().norm() == 0);
    CHECK(still.acceleration.head<3>().norm() == 0);
    CHECK(still.jerk.head<3>().norm() == 0);
    const auto moving = curve(1);
    const auto body = moving.motion(u, duet::frame::body);
    const auto m = moving.motion(u, duet::frame::hybrid);
    CHECK(m.velocity.head<3>().norm() ==
          doctest::Approx(body.velocity.head<3>().norm()).epsilon(1e-14));
    CHECK(m.velocity.tail<3>().norm() ==
          doctest::Approx(body.velocity.tail<3>().norm()).epsilon(1e-14));
  }
}

} // namespace
} // namespace test_spline_poses
