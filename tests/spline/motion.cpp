// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

#include <duet/duet.hpp>

namespace test_spline_motion {

using duet::cumulative_bspline;
using duet_test::knot_vectors;
using duet_test::max_abs_difference;
using duet_test::parameters_on;
using duet_test::random_orientations;

using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;

namespace {

template <int Order, class F>
void for_each_curve(F&& f) {
  for (const duet_test::named_knots& each : knot_vectors(Order)) {
    const std::string& name = each.name;
    const std::vector<double>& knots = each.knots;
    CAPTURE(Order);
    CAPTURE(name);
    f(cumulative_bspline<double, Order>(knots,
                                        random_orientations(knots.size() - std::size_t(Order), 1)),
      parameters_on(knots, Order, 2));
  }
}

/// ω, ω′ and ω″ from Q, Q′, Q″, Q‴ by the product rule on N7.
template <class Frame>
std::array<vector, 3> rates(const std::array<quaternion, 4>& q, Frame) {
  const std::array<quaternion, 3> half = [&] {
    if constexpr (std::is_same_v<Frame, duet::spatial_frame>) {
      return std::array{q[1] * conj(q[0]), q[2] * conj(q[0]) + q[1] * conj(q[1]),
                        q[3] * conj(q[0]) + 2 * (q[2] * conj(q[1])) + q[1] * conj(q[2])};
    } else {
      return std::array{conj(q[0]) * q[1], conj(q[0]) * q[2] + conj(q[1]) * q[1],
                        conj(q[0]) * q[3] + 2 * (conj(q[1]) * q[2]) + conj(q[2]) * q[1]};
    }
  }();
  return {2 * half[0].vec(), 2 * half[1].vec(), 2 * half[2].vec()};
}

/// Relative difference, with a lower bound of the size for derivatives that are identically zero.
double difference(const vector& a, const vector& b) {
  return (a - b).norm() / std::max(1e-3, a.norm());
}
double difference(const quaternion& a, const quaternion& b) {
  return max_abs_difference(a, b) / std::max(1e-3, std::sqrt(squared_norm(a)));
}

template <class Spline, class Frame>
double against_taylor(const Spline& s, const std::vector<double>& parameters, Frame frame) {
  double worst = 0;
  for (const double u : parameters) {
    const auto m = s.motion(u, frame);
    const auto q = duet::derivatives<3>([&](const auto& x) { return s(x); }, u);
    const auto expected = rates(q, frame);
    worst = std::max(worst, max_abs_difference(m.value, s(u)));
    worst = std::max(worst, difference(expected[0], m.velocity));
    worst = std::max(worst, difference(duet::angular_velocity(q[0], q[1], frame), m.velocity));
    worst = std::max(worst, difference(expected[1], m.acceleration));
    worst = std::max(worst, difference(expected[2], m.jerk));
  }
  return worst;
}

} // namespace

TEST_CASE("P3, P4: Q′, Q″ and Q‴ agree with Taylor numbers, Q′ and Q″ with nested dual numbers") {
  const auto check = [](const auto& s, const std::vector<double>& parameters) {
    double worst = 0;
    for (const double u : parameters) {
      const auto closed = s.derivatives(u);
      const auto curve = [&](const auto& x) { return s(x); };
      const auto taylor = duet::derivatives<3>(curve, u);
      const auto nested = duet::derivative(
          [&](const auto& x) {
            return duet::derivative([&](const auto& y) { return s(y); }, x).derivative;
          },
          u);
      for (std::size_t d = 0; d <= 3; ++d) {
        worst = std::max(worst, difference(taylor[d], closed[d]));
      }
      worst = std::max(worst, difference(nested.value, closed[1]));
      worst = std::max(worst, difference(nested.derivative, closed[2]));
    }
    CHECK(worst < 1e-13);
  };
  for_each_curve<3>(check);
  for_each_curve<4>(check);
}

TEST_CASE("P3, P4, N7: angular velocity, acceleration and jerk agree with Taylor numbers") {
  for_each_curve<4>([](const auto& s, const std::vector<double>& parameters) {
    CHECK(against_taylor(s, parameters, duet::frame::body) < 1e-12);
    CHECK(against_taylor(s, parameters, duet::frame::spatial) < 1e-12);
  });
}

TEST_CASE("motion: each rate is the derivative of the rate before in the same axes") {
  const auto knots = knot_vectors(4)[1].knots;
  const cumulative_bspline<double> s(knots, random_orientations(knots.size() - 4, 1));
  const auto check = [&](auto frame) {
    for (const double u : parameters_on(knots, 4)) {
      const auto m = s.motion(u, frame);
      const auto alpha =
          duet::derivative([&](const auto& x) { return s.motion(x, frame).velocity; }, u);
      const auto jerk =
          duet::derivative([&](const auto& x) { return s.motion(x, frame).acceleration; }, u);
      CHECK(difference(alpha.value, m.velocity) < 1e-14);
      CHECK(difference(alpha.derivative, m.acceleration) < 1e-13);
      CHECK(difference(jerk.value, m.acceleration) < 1e-14);
      CHECK(difference(jerk.derivative, m.jerk) < 1e-13);
    }
  };
  check(duet::frame::body);
  check(duet::frame::spatial);
  const auto hybrid = s.motion(1.5, duet::frame::hybrid);
  const auto spatial = s.motion(1.5, duet::frame::spatial);
  CHECK(hybrid.velocity == spatial.velocity);
  CHECK(hybrid.acceleration == spatial.acceleration);
  CHECK(hybrid.jerk == spatial.jerk);
}

TEST_CASE(
    "motion: body and spatial rates are the same vectors in different axes, except the jerk") {
  const auto knots = knot_vectors(4)[0].knots;
  const cumulative_bspline<double> s(knots, random_orientations(knots.size() - 4, 2));
  for (const double u : parameters_on(knots, 4)) {
    const auto b = s.motion(u, duet::frame::body);
    const auto f = s.motion(u, duet::frame::spatial);
    CHECK(difference(f.velocity, rotate(b.value, b.velocity)) < 1e-14);
    CHECK(difference(f.acceleration, rotate(b.value, b.acceleration)) < 1e-14);
    const vector jerk = b.jerk + b.velocity.cross(b.acceleration);
    CHECK(difference(f.jerk, rotate(b.value, jerk)) < 1e-14);
  }
}

TEST_CASE("cumulative_bspline: a curve of order 2 rotates at a constant rate") {
  const std::vector<double> knots = {0, 0, 2, 3, 3};
  const cumulative_bspline<double, 2> s(knots, random_orientations(3, 1));
  for (const double u : {0.0, 0.3, 1.99}) {
    const auto m = s.motion(u, duet::frame::body);
    CHECK(difference(s.increments()[1], m.velocity) < 1e-15); // twice the half angle in time 2
    CHECK(m.acceleration.isZero(0));
    CHECK(m.jerk.isZero(0));
  }
}

} // namespace test_spline_motion
