// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "dual_quaternion/cases.hpp"
#include "support/shared_tag.hpp"
#include "support/test.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/curves.hpp>
#include <duet/quaternion/exponential.hpp>

// Squad and Bézier curves, of poses and so of rotations; arcs of ScLERP.

namespace test_dual_quaternion_curves {
namespace {

using duet::bezier, duet::slerp_arc, duet::squad, duet::squad_control,
    duet_test::max_abs_difference, duet_test::vector;
using dual_quaternion = duet::dual_quaternion<double>;

/// Poses along a smooth motion, signs aligned.
std::vector<dual_quaternion> table() {
  std::vector<dual_quaternion> result;
  for (int i = 0; i < 6; ++i) {
    const double t = 0.5 * i;
    result.push_back(
        duet::pose(duet::from_rotation_vector(vector(std::sin(t), 0.6 * t, 0.3 * t * t)),
                   vector(t, t * t, 1)));
    if (i > 0 && dot(result[std::size_t(i - 1)], result.back()).value() < 0) {
      result.back() = -result.back();
    }
  }
  return result;
}

template <class D>
duet::vector6<double> body_twist(const D& d) {
  return duet::twist(d.value, d.derivative, duet::frame::body);
}

TEST_CASE("squad: passes through the poses with continuous velocity") {
  const auto p = table();
  const auto segment = [&](std::size_t i) {
    return [&p, i](const auto& tau) {
      return squad(p[i], squad_control(p[i - 1], p[i], p[i + 1]),
                   squad_control(p[i], p[i + 1], p[i + 2]), p[i + 1], tau);
    };
  };
  for (std::size_t i = 1; i + 3 < p.size(); ++i) {
    const auto begin = duet::derivative<duet_test::shared_tag>(segment(i), 0.0);
    const auto end = duet::derivative<duet_test::shared_tag>(segment(i), 1.0);
    CHECK(max_abs_difference(begin.value, p[i]) < 2e-15);
    CHECK(max_abs_difference(end.value, p[i + 1]) < 4e-15);
    CHECK(max_abs_difference(body_twist(end), body_twist(duet::derivative<duet_test::shared_tag>(
                                                  segment(i + 1), 0.0))) < 4e-14);
  }
  // The velocity at p[1] is the mean of the logarithms to both neighbours.
  const auto to_next = log(conj(p[1]) * p[2]).vec();
  const auto to_previous = log(conj(p[1]) * p[0]).vec();
  const duet::dual_vector<double> mean = to_next - to_previous;
  CHECK(max_abs_difference(body_twist(duet::derivative<duet_test::shared_tag>(segment(1), 0.0)),
                           duet::twist_of(mean)) < 2e-14);
}

TEST_CASE("bezier: end velocities are n times those of the control polygon") {
  const auto p = table();
  for (std::size_t n = 1; n <= 4; ++n) {
    const std::vector<dual_quaternion> points(p.begin(), p.begin() + int(n) + 1);
    const auto curve = [&](const auto& tau) { return bezier(points, tau); };
    const auto begin = duet::derivative<duet_test::shared_tag>(curve, 0.0);
    const auto end = duet::derivative<duet_test::shared_tag>(curve, 1.0);
    CHECK(max_abs_difference(begin.value, points.front()) < 2e-15);
    CHECK(max_abs_difference(end.value, points.back()) < 2e-14);
    const auto speed = double(n) * 2.0;
    const duet::dual_vector<double> first = log(conj(points[0]) * points[1]).vec() * speed;
    const duet::dual_vector<double> last = log(conj(points[n - 1]) * points[n]).vec() * speed;
    CHECK(max_abs_difference(body_twist(begin), duet::twist_of(first)) < 4e-14);
    CHECK(max_abs_difference(body_twist(end), duet::twist_of(last)) < 4e-14);
  }
  CHECK(max_abs_difference(bezier(std::vector<dual_quaternion>{p[0]}, 0.4), p[0]) == 0);
  CHECK(max_abs_difference(bezier(std::array{p[0], p[1], p[2], p[3]}, 0.4),
                           bezier(std::vector<dual_quaternion>(p.begin(), p.begin() + 4), 0.4)) ==
        0);
  CHECK(max_abs_difference(bezier(std::vector<dual_quaternion>{p[0], p[1]}, 0.4),
                           sclerp(p[0], p[1], 0.4)) == 0);
  DUET_CHECK_REFUSED("duet: bezier: there are no control points",
                     bezier(std::vector<dual_quaternion>(), 0.4));
}

TEST_CASE("sclerp: takes the shorter arc, the longer arc or that of the signs") {
  const auto a = duet::pose(duet::quaternion<double>(1.0), vector(0, 0, 0));
  const auto b = duet::pose(duet::from_axis_angle(vector(0, 0, 1), 1.0), vector(0, 0, 2));
  for (const auto& goal : {b, -b}) {
    const auto angle = [&](slerp_arc arc) {
      const auto d = duet::derivative<duet_test::shared_tag>(
          [&](auto t) { return sclerp(a, goal, t, arc); }, 0.0);
      CHECK(max_abs_difference(duet::transform_matrix(sclerp(a, goal, 1.0, arc)),
                               duet::transform_matrix(b)) < 2e-15);
      return duet::twist(d.value, d.derivative, duet::frame::body)[5];
    };
    const double longer_arc = 1 - 2 * 3.141592653589793;
    CHECK(angle(slerp_arc::shortest) == doctest::Approx(1.0).epsilon(1e-15));
    CHECK(angle(slerp_arc::longest) == doctest::Approx(longer_arc).epsilon(1e-15));
    CHECK(angle(slerp_arc::as_given) ==
          doctest::Approx(duet::real_part(goal).w() > 0 ? 1.0 : longer_arc).epsilon(1e-15));
  }
  CHECK_FALSE(differs_by_half_turn(a, b));
  const auto half_turn = duet::pose(duet::quaternion<double>(0, 0.6, 0.8, 0), vector(1, 2, 3));
  CHECK(differs_by_half_turn(a, half_turn));
  CHECK_FALSE(differs_by_half_turn(
      a, duet::pose(duet::from_axis_angle(vector(1, 0, 0), 3.1415926), vector(1, 2, 3))));
}

} // namespace
} // namespace test_dual_quaternion_curves
