// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

// Evaluation of rotation-vector splines: closed form against Taylor numbers through the value.

namespace test_spline_rotation_vector_motion {
namespace {

using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;
template <int Order>
using spline = duet::rotation_vector_spline<double, Order>;

const std::vector<double> knots{-0.5, 0.1, 0.4, 1.3, 1.5, 2.2, 2.9};

template <int Order>
spline<Order> curve(double step) {
  return duet::interpolate<spline<Order>>(knots, duet_test::random_orientations(7, step, 3));
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
      (void)spline<4>::from_pieces(s.knots(), s.elements(), pieces),
      doctest::Contains("sample 3: the polynomial piece before does not end at it"),
      duet::invalid_sample);
  pieces.pop_back();
  CHECK_THROWS_WITH_AS((void)spline<4>::from_pieces(s.knots(), s.elements(), pieces),
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
    CHECK_THROWS_WITH_AS((void)s(u), doctest::Contains("outside its domain [-0.5, 2.9]"),
                         duet::invalid_input);
  }
  s.set_out_of_domain(duet::out_of_domain::clamp);
  CHECK(s(7.0) == s(2.9));
  CHECK(s.motion(-3.0, duet::frame::spatial).velocity.norm() == 0);
  CHECK_THROWS_AS((void)s(nan), duet::invalid_input);
  s.set_out_of_domain(duet::out_of_domain::extrapolate);
  const auto series = duet::derivatives<3>(s, 2.9);
  const double h = 1e-3;
  const quaternion expected =
      series[0] + series[1] * h + series[2] * (h * h / 2) + series[3] * (h * h * h / 6);
  CHECK(duet_test::max_abs_difference(s(2.9 + h), expected) < 1e-9);
}

} // namespace
} // namespace test_spline_rotation_vector_motion
