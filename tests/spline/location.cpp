// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"
#include "support/identical.hpp"

namespace test_spline_location {
namespace {

const std::string clamp_advice =
    "; set_out_of_domain(out_of_domain::clamp) makes a curve stay at its end";

using duet::out_of_domain;
using duet_test::max_abs_difference;
using spline = duet::cumulative_bspline<double>;

const std::vector<double> knots = duet_test::knot_vectors(4)[2].knots; // very uneven
const spline s(knots, duet_test::random_orientations(knots.size() - 4, 1));
const std::vector<double> parameters = duet_test::parameters_on(knots, 4);
const double first = s.basis().front(), last = s.basis().back();

spline with_behaviour(out_of_domain behaviour) {
  spline t = s;
  t.set_out_of_domain(behaviour);
  return t;
}

std::string message_of(const spline& t, double u) {
  return duet_test::message_of([&] { (void)t.motion(u, duet::frame::body); });
}

TEST_CASE("curve: a span hint does not affect results") {
  duet::span_hint forward, backward, random{99};
  duet_test::random_source source(1);
  const auto check = [](double u, duet::span_hint& hint) {
    CHECK(s(u, hint) == s(u));
    CHECK(hint.span == s.basis().find_span(u));
    const auto m = s.motion(u, duet::frame::spatial, hint);
    CHECK(m.jerk == s.motion(u, duet::frame::spatial).jerk);
  };
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    check(parameters[i], forward);
    check(parameters[parameters.size() - 1 - i], backward);
    check(source.uniform(first, last), random);
  }
  duet::span_hint at_end{s.basis().breaks().size() - 2};
  check(last, at_end);
  CHECK_THROWS_AS((void)s(last + 1, at_end), duet::invalid_input);
}

TEST_CASE("curve outside its domain: by default an error with the parameter") {
  const std::vector<double> round = {0, 0, 0, 0, 1, 2, 2, 2, 2};
  spline t(round, duet_test::random_orientations(5, 1));
  CHECK(t.behaviour_out_of_domain() == out_of_domain::error);
  CHECK(message_of(t, 2.5) ==
        "duet: spline evaluated at 2.5, outside its domain [0, 2]" + clamp_advice);
  CHECK(message_of(t, -1) ==
        "duet: spline evaluated at -1, outside its domain [0, 2]" + clamp_advice);
  for (const out_of_domain behaviour :
       {out_of_domain::error, out_of_domain::clamp, out_of_domain::extrapolate}) {
    t.set_out_of_domain(behaviour);
    CHECK(message_of(t, std::numeric_limits<double>::quiet_NaN()) ==
          "duet: spline evaluated at nan, outside its domain [0, 2]");
  }
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(message_of(t, infinity) ==
        "duet: spline evaluated at inf, outside its domain [0, 2]" + clamp_advice);
}

TEST_CASE("out_of_domain::clamp: the curve is at rest at its ends") {
  const spline t = with_behaviour(out_of_domain::clamp);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double far : {1e-9, 0.5, 100.0, infinity}) {
    for (const double end : {first, last}) {
      const double u = end == first ? first - far : last + far;
      const auto m = t.motion(u, duet::frame::spatial);
      CHECK(m.value == s(end));
      CHECK(t(u) == s(end));
      CHECK(m.velocity.isZero(0));
      CHECK(m.acceleration.isZero(0));
      CHECK(m.jerk.isZero(0));
      CHECK(norm(t.derivatives(u)[1]) == 0);
      const auto moving = t(duet::taylor<double, 2>::variable(u));
      CHECK(std::abs(moving.x().value() - s(end).x()) <= duet_test::if_fused(2e-16));
      CHECK(moving.x().derivative(1) == 0);
    }
  }
  CHECK(t.motion(last, duet::frame::body).velocity == s.motion(last, duet::frame::body).velocity);
}

TEST_CASE("out_of_domain::extrapolate: the last segment and its derivatives continue") {
  const spline t = with_behaviour(out_of_domain::extrapolate);
  for (const double end : {first, last}) {
    const double out = end == first ? -1 : 1;
    // The Taylor series of the curve about its end, where the third derivative is continuous.
    for (const double far : {1e-4, 1e-3}) {
      const double u = end + out * far;
      const auto at_end = s.motion(end, duet::frame::spatial);
      const auto m = t.motion(u, duet::frame::spatial);
      const auto expected = at_end.velocity + (u - end) * at_end.acceleration +
                            (u - end) * (u - end) / 2 * at_end.jerk;
      const double size = 1 + at_end.jerk.norm();
      CHECK((m.velocity - expected).norm() < 200 * size * far * far * far);
      CHECK(max_abs_difference(m.value, t(u)) == 0);
      const auto moving = t(duet::taylor<double, 1>::variable(u));
      CHECK(std::abs(moving.y().derivative(1) - t.derivatives(u)[1].y()) < 1e-13 * size);
    }
  }
}

TEST_CASE("apply_time_scaling: ω = δu̇, ω̇ = δ′u̇² + δü, ω̈ = δ″u̇³ + 3δ′u̇ü + δu⃛ agree with Taylor "
          "numbers u(t)") {
  // With u(t) as a Taylor number the rates with respect to time follow without these formulas.
  const double middle = (first + last) / 2;
  for (const double u : {middle, first + 0.1, last - 0.2}) {
    const double rates[] = {0.7, -1.3, 0.4};
    const auto by_u = s.motion(u, duet::frame::spatial);
    const auto m = duet::apply_time_scaling(by_u, rates[0], rates[1], rates[2]);
    const duet::taylor<double, 3> scaling({u, rates[0], rates[1] / 2, rates[2] / 6});
    const auto q = s(scaling);
    const auto derivative = [&](int k) {
      return duet::quaternion<double>(q.w().derivative(k), q.x().derivative(k), q.y().derivative(k),
                                      q.z().derivative(k));
    };
    const auto q0 = derivative(0), q1 = derivative(1), q2 = derivative(2), q3 = derivative(3);
    const auto velocity = (q1 * conj(q0)).vec();
    const auto acceleration = (q2 * conj(q0) + q1 * conj(q1)).vec();
    const auto jerk = (q3 * conj(q0) + 2 * (q2 * conj(q1)) + q1 * conj(q2)).vec();
    CHECK((m.velocity - 2 * velocity).norm() < 1e-13 * (1 + m.velocity.norm()));
    CHECK((m.acceleration - 2 * acceleration).norm() < 1e-13 * (1 + m.acceleration.norm()));
    CHECK((m.jerk - 2 * jerk).norm() < 1e-12 * (1 + m.jerk.norm()));
    CHECK(m.value == by_u.value);
  }
}

TEST_CASE("cumulative_bspline: increments of any length give longer arcs and several full turns") {
  const std::vector<double> round = {0, 0, 1, 2, 2};
  using line = duet::cumulative_bspline<double, 2>;
  const duet::quaternion<double> one(1);
  const duet::vector3<double> axis(0, 0.6, 0.8);
  using std::numbers::pi;
  const line t(round, {one, one, -one},
               {duet::vector3<double>::Zero(), 2 * pi * axis, -3 * pi * axis});
  CHECK((t.motion(0.5, duet::frame::body).velocity - 4 * pi * axis).norm() < 1e-14);
  CHECK((t.motion(1.5, duet::frame::body).velocity + 6 * pi * axis).norm() < 1e-14);
  CHECK_THROWS_WITH_AS(line(round, {one, one, one}, {axis, 2 * pi * axis, -3 * pi * axis}),
                       "duet: sample 2: the increment does not lead to it from the control point "
                       "before",
                       duet::invalid_sample);
  CHECK_THROWS_WITH_AS(line(round, {one, one, one}, {axis, axis}),
                       "duet: cumulative_bspline: 5 knots of order 2 need 3 increments, got 2",
                       duet::invalid_input);
}

} // namespace
} // namespace test_spline_location
