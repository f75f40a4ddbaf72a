// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

namespace test_spline_motion {
namespace {

using duet::cumulative_bspline;
using duet_test::knot_vectors;
using duet_test::parameters_on;
using duet_test::random_orientations;

using number = duet::screw_dual<double>;
using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;

double size_of(const quaternion& q) { return norm(q); }
double size_of(const duet::dual_quaternion<double>& a) {
  return norm(real_part(a)) + norm(dual_part(a));
}
double size_of(const vector& v) { return v.norm(); }
double size_of(const duet::vector6<double>& v) { return v.norm(); }
template <class X>
double difference(const X& a, const X& b) {
  return size_of(X(a - b)) / (1 + size_of(a));
}

/// Velocity from Q and Q′ by N7 or N18, over any scalar of the parameter.
template <class Curve, class S, class Frame>
auto velocity_of(const Curve& s, const S& u, Frame frame) {
  const auto q = duet::derivative([&](const auto& x) { return s(x); }, u);
  if constexpr (requires { duet::twist(q.value, q.derivative, frame); }) {
    return duet::twist(q.value, q.derivative, frame);
  } else {
    return duet::angular_velocity(q.value, q.derivative, frame);
  }
}

/// Derivatives and rates of a curve in closed form against Taylor numbers through its value.
template <class Curve>
double against_taylor(const Curve& s, const std::vector<double>& parameters) {
  double worst = 0;
  for (const double u : parameters) {
    const auto closed = s.derivatives(u);
    const auto q = duet::derivatives<3>([&](const auto& x) { return s(x); }, u);
    for (std::size_t d = 0; d <= 3; ++d) {
      worst = std::max(worst, difference(closed[d], q[d]));
    }
    const auto compare = [&](auto frame) {
      const auto m = s.motion(u, frame);
      const auto rates =
          duet::derivatives<2>([&](const auto& x) { return velocity_of(s, x, frame); }, u);
      using rate = std::decay_t<decltype(m.velocity)>;
      worst = std::max({worst, difference(m.value, q[0]), difference(rate(rates[0]), m.velocity),
                        difference(rate(rates[1]), m.acceleration),
                        difference(rate(rates[2]), m.jerk)});
    };
    compare(duet::frame::body);
    compare(duet::frame::spatial);
    if constexpr (duet::manifold<std::decay_t<decltype(s(u))>>::dimension == 6) {
      compare(duet::frame::hybrid);
    }
  }
  return worst;
}

template <class T, int Order>
void check_cumulative(const duet_test::named_knots& knots) {
  CAPTURE(Order);
  CAPTURE(knots.name);
  const std::size_t count = knots.knots.size() - std::size_t(Order);
  const auto parameters = parameters_on(knots.knots, Order, 2);
  if constexpr (std::is_same_v<T, double>) {
    const cumulative_bspline<T, Order> s(knots.knots, random_orientations(count, 1));
    CHECK(against_taylor(s, parameters) < 1e-13);
  } else {
    const cumulative_bspline<T, Order> s(knots.knots, duet_test::random_poses(count, 1.2));
    CHECK(against_taylor(s, parameters) < 1e-13);
  }
}

TEST_CASE("P3, P4, N7, N18: derivatives and rates of cumulative curves agree with Taylor numbers") {
  for (const auto& each : knot_vectors(4)) {
    check_cumulative<double, 4>(each);
  }
  check_cumulative<double, 3>(knot_vectors(3)[1]);
  check_cumulative<number, 4>(knot_vectors(4)[1]);
}

TEST_CASE("rotation_vector_spline: derivatives and rates agree with Taylor numbers") {
  const std::vector<double> u{-0.5, 0.1, 0.4, 1.3, 1.5, 2.2, 2.9};
  std::vector<double> parameters;
  for (double x = -0.5; x <= 2.9; x += 0.0613) {
    parameters.push_back(x);
  }
  for (const double step : {0.0, 1e-9, 0.01, 1.0, 2.5}) {
    CAPTURE(step);
    const auto q = random_orientations(7, step, 3);
    using duet::rotation_vector_spline;
    const auto cubic = duet::interpolate<rotation_vector_spline<double>>(u, q);
    CHECK(against_taylor(cubic, parameters) < 1e-13);
    const auto quintic = duet::interpolate<rotation_vector_spline<double, 6>>(u, q);
    CHECK(against_taylor(quintic, parameters) < 1e-13);
  }
}

TEST_CASE("motion: hybrid rates of rotations are spatial ones") {
  const auto knots = knot_vectors(4)[1].knots;
  const cumulative_bspline<double> s(knots, random_orientations(knots.size() - 4, 1));
  const auto hybrid = s.motion(1.5, duet::frame::hybrid);
  const auto spatial = s.motion(1.5, duet::frame::spatial);
  CHECK(hybrid.velocity == spatial.velocity);
  CHECK(hybrid.acceleration == spatial.acceleration);
  CHECK(hybrid.jerk == spatial.jerk);
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

} // namespace
} // namespace test_spline_motion
