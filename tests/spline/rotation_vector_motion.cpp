// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

#include <duet/duet.hpp>

// Evaluation of rotation-vector splines: closed form against Taylor numbers through the value.

namespace test_spline_rotation_vector_motion {

using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;
template <int Order>
using spline = duet::rotation_vector_spline<double, Order>;

namespace {

const std::vector<double> knots{-0.5, 0.1, 0.4, 1.3, 1.5, 2.2, 2.9};

template <int Order>
spline<Order> curve(double step) {
  return duet::interpolate<spline<Order>>(knots, duet_test::random_orientations(7, step, 3));
}

template <class Rates>
vector rate(const Rates& w, int order) {
  return {2 * w.x().derivative(order), 2 * w.y().derivative(order), 2 * w.z().derivative(order)};
}

template <int Order>
void check_motion(const spline<Order>& s) {
  for (double u = -0.5; u <= 2.9; u += 0.0613) {
    CAPTURE(u);
    using series = duet::taylor<double, 3>;
    const auto q = s(series::variable(u));
    const auto d = duet::derivatives<3>(s, u);
    const auto closed = s.derivatives(u);
    const auto derivative = [](const series& x) {
      return series({x.coefficient(1), 2 * x.coefficient(2), 3 * x.coefficient(3), 0});
    };
    const duet::quaternion<series> dq(derivative(q.w()), derivative(q.x()), derivative(q.y()),
                                      derivative(q.z()));
    for (std::size_t k = 0; k < 4; ++k) {
      CHECK(norm(d[k] - closed[k]) < 1e-13 * (1 + norm(d[k])));
    }
    const auto body = s.motion(u, duet::frame::body);
    const auto spatial = s.motion(u, duet::frame::spatial);
    const auto check = [&](const auto& m, const auto& w) {
      CHECK(duet_test::max_abs_difference(m.value, d[0]) < 1e-15);
      CHECK((m.velocity - rate(w, 0)).norm() < 1e-13 * (1 + m.velocity.norm()));
      CHECK((m.acceleration - rate(w, 1)).norm() < 1e-13 * (1 + m.acceleration.norm()));
      CHECK((m.jerk - rate(w, 2)).norm() < 1e-13 * (1 + m.jerk.norm()));
    };
    check(body, conj(q) * dq);
    check(spatial, dq * conj(q));
  }
}

} // namespace

TEST_CASE("rotation_vector_spline: closed-form rates agree with automatic differentiation") {
  for (const double step : {0.0, 1e-9, 0.01, 1.0, 2.5}) {
    CAPTURE(step);
    check_motion(curve<4>(step));
    check_motion(curve<6>(step));
  }
}

TEST_CASE("rotation_vector_spline: Hermite curves have the given rates at the knots") {
  const auto q = duet_test::random_orientations(3, 1.4, 8);
  const std::vector<double> u{0, 0.5, 2};
  const vector w[] = {{0.2, 0.1, -0.6}, {1, -0.3, 0.2}, {0, 0, 0.4}};
  const vector a[] = {{-1, 0.1, 0.3}, {0.4, 0.4, -2}, {1, 2, 3}};
  const spline<4> cubic(u, q, {{w[0]}, {w[1]}, {w[2]}});
  const spline<6> quintic(u, q, {{w[0], a[0]}, {w[1], a[1]}, {w[2], a[2]}});
  for (std::size_t i = 0; i < 3; ++i) {
    for (const bool before : {false, true}) {
      const double at = before && i > 0 ? std::nextafter(u[i], -1.0) : u[i];
      CHECK((cubic.motion(at, duet::frame::body).velocity - 2 * w[i]).norm() < 1e-13);
      const auto m = quintic.motion(at, duet::frame::body);
      CHECK((m.velocity - 2 * w[i]).norm() < 1e-13);
      CHECK((m.acceleration - 2 * a[i]).norm() < 1e-12);
    }
  }
}

TEST_CASE("rotation_vector_spline::from_pieces: a copy is the same curve, invalid pieces throw") {
  const auto s = curve<4>(1.2);
  const auto copy = spline<4>::from_pieces(s.knots(), s.elements(), s.pieces());
  CHECK(copy.motion(0.3, duet::frame::body).jerk == s.motion(0.3, duet::frame::body).jerk);
  auto pieces = s.pieces();
  pieces[2][1] += vector(0.1, 0, 0);
  CHECK_THROWS_WITH_AS(
      static_cast<void>(spline<4>::from_pieces(s.knots(), s.elements(), pieces)),
      doctest::Contains("sample 3: the polynomial piece before does not end at it"),
      duet::invalid_sample);
  pieces.pop_back();
  CHECK_THROWS_WITH_AS(static_cast<void>(spline<4>::from_pieces(s.knots(), s.elements(), pieces)),
                       doctest::Contains("7 samples need 6 pieces, got 5"), duet::invalid_input);
}

TEST_CASE("rotation_vector_spline: hints do not affect results; out_of_domain sets the behaviour "
          "outside the domain") {
  auto s = curve<6>(1.2);
  duet::span_hint hint{77};
  for (const double u : {0.3, 0.31, 0.5, 2.9, -0.5, 1.4}) {
    CHECK(s(u, hint) == s(u));
    CHECK(s.motion(u, duet::frame::body, hint).jerk == s.motion(u, duet::frame::body).jerk);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double u : {-0.51, 2.91, nan}) {
    CHECK_THROWS_WITH_AS(static_cast<void>(s(u)),
                         doctest::Contains("outside its domain [-0.5, 2.9]"), duet::invalid_input);
  }
  s.set_out_of_domain(duet::out_of_domain::clamp);
  CHECK(s(7.0) == s(2.9));
  CHECK(s.motion(-3.0, duet::frame::spatial).velocity.norm() == 0);
  CHECK_THROWS_AS(static_cast<void>(s(nan)), duet::invalid_input);
  s.set_out_of_domain(duet::out_of_domain::extrapolate);
  const auto series = duet::derivatives<3>(s, 2.9);
  const double h = 1e-3;
  const quaternion expected =
      series[0] + series[1] * h + series[2] * (h * h / 2) + series[3] * (h * h * h / 6);
  CHECK(duet_test::max_abs_difference(s(2.9 + h), expected) < 1e-9);
}

TEST_CASE("rotation_vector_spline: errors name invalid samples, parameters and end conditions") {
  using duet::interpolate;
  const auto q = duet_test::random_orientations(7, 1, 3);
  const auto samples = [&](std::size_t n) {
    return std::vector<quaternion>(q.begin(), q.begin() + long(n));
  };
  const auto us = [&](std::size_t n) {
    return std::vector<double>(knots.begin(), knots.begin() + long(n));
  };
  const vector zero = vector::Zero();
  CHECK_THROWS_AS(static_cast<void>(interpolate<spline<4>>(us(1), samples(1))),
                  duet::invalid_input);
  CHECK_THROWS_AS(static_cast<void>(interpolate<spline<4>>(us(3), samples(4))),
                  duet::invalid_input);
  CHECK_THROWS_WITH_AS(
      static_cast<void>(interpolate<spline<4>>(us(3), samples(3), duet::not_a_knot{})),
      doctest::Contains("needs 4 samples"), duet::invalid_input);
  CHECK_THROWS_WITH_AS(
      static_cast<void>(interpolate<spline<6>>(us(5), samples(5), duet::not_a_knot{})),
      doctest::Contains("needs 6 samples"), duet::invalid_input);
  CHECK_THROWS_WITH_AS(
      static_cast<void>(interpolate<spline<6>>(us(3), samples(3), duet::clamped{zero, zero})),
      doctest::Contains("needs 4 samples"), duet::invalid_input);
  CHECK_THROWS_WITH_AS(static_cast<void>(interpolate<spline<4>>(us(7), q, duet::periodic{})),
                       doctest::Contains("sample 6: periodic ends"), duet::invalid_sample);
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH_AS(static_cast<void>(interpolate<spline<4>>(
                           us(7), q, duet::clamped{zero, vector(0, infinity, 0)})),
                       doctest::Contains("rate at the end"), duet::invalid_input);
  auto repeated = knots;
  repeated[3] = repeated[2];
  CHECK_THROWS_WITH_AS(static_cast<void>(interpolate<spline<6>>(repeated, q)),
                       doctest::Contains("sample 3: parameter 0.4 does not increase"),
                       duet::invalid_sample);
  auto half_turn = q;
  half_turn[4] = half_turn[3] * quaternion(0, 0, 1, 0);
  CHECK_THROWS_WITH_AS(static_cast<void>(interpolate<spline<4>>(knots, half_turn)),
                       doctest::Contains("sample 4: half a turn"), duet::invalid_sample);
  CHECK_THROWS_WITH_AS(static_cast<void>(spline<4>(us(3), samples(3), {{zero}, {zero}})),
                       doctest::Contains("3 samples need 3 rates, got 2"), duet::invalid_input);
}

} // namespace test_spline_rotation_vector_motion
