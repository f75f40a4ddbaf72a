// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

#include <duet/duet.hpp>

namespace test_spline_interpolate {

using duet::clamped;
using duet::interpolate;
using duet::natural;
using duet_test::max_abs_difference;
using duet_test::random_orientations;

using spline = duet::cumulative_bspline<double>;
using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;
using parameters = std::vector<double>;
using table = std::vector<quaternion>;

namespace {

parameters uniform(std::size_t count) {
  parameters result;
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(-0.5 + 0.25 * double(i));
  }
  return result;
}

parameters uneven(std::size_t count) {
  duet_test::random_source random(count);
  parameters result = {3};
  for (std::size_t i = 1; i < count; ++i) {
    result.push_back(result.back() + random.log_uniform(0.1, 1));
  }
  return result;
}

double worst_miss(const spline& s, const parameters& u, const table& q) {
  double worst = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const quaternion at = s(u[i]);
    worst = std::max(worst, std::min(max_abs_difference(at, q[i]), max_abs_difference(at, -q[i])));
  }
  return worst;
}

/// Largest acceleration at the knots, to which those at natural ends are compared.
double largest_acceleration(const spline& s) {
  double result = 0;
  for (const double u : s.basis().breaks()) {
    result = std::max(result, s.motion(u, duet::frame::body).acceleration.norm());
  }
  return result;
}

void check_natural(const parameters& u, const table& q) {
  const spline s = interpolate<spline>(u, q, natural{});
  CHECK(worst_miss(s, u, q) < 1e-14);
  const double size = largest_acceleration(s) + 1;
  CHECK(s.motion(u.front(), duet::frame::body).acceleration.norm() < 1e-12 * size);
  CHECK(s.motion(u.back(), duet::frame::body).acceleration.norm() < 1e-12 * size);
}

void check_clamped(const parameters& u, const table& q, const vector& start, const vector& end) {
  const spline s = interpolate<spline>(u, q, clamped{start, end});
  CHECK(worst_miss(s, u, q) < 1e-14);
  CHECK((s.motion(u.front(), duet::frame::spatial).velocity - start).norm() < 1e-12);
  CHECK((s.motion(u.back(), duet::frame::spatial).velocity - end).norm() < 1e-12);
}

} // namespace

TEST_CASE("interpolate, cumulative cubic: the curve passes through the data and meets its end "
          "conditions") {
  for (const std::size_t count : {2, 3, 4, 7, 30}) {
    for (const double step : {0.0, 1e-9, 0.003, 0.3, 1.5}) {
      CAPTURE(count);
      CAPTURE(step);
      const table q = random_orientations(count, step, count);
      for (const parameters& u : {uniform(count), uneven(count)}) {
        check_natural(u, q);
        check_clamped(u, q, vector(0.3, -0.2, 0.5), vector(-1, 0, 0.4));
        check_clamped(u, q, vector::Zero(), vector::Zero());
      }
    }
  }
}

TEST_CASE("interpolate, cumulative cubic: rotations of 2.8 rad about random axes between samples "
          "converge") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    const table q = duet_test::rotated_by(2.8, 20, seed);
    const parameters u = seed % 2 == 0 ? uniform(20) : [&] {
      duet_test::random_source random(seed);
      parameters result = {0};
      while (result.size() < 20) {
        result.push_back(result.back() + random.uniform(0.5, 1.5));
      }
      return result;
    }();
    check_natural(u, q);
    check_clamped(u, q, vector(1, 0, 0), vector(0, -2, 0));
  }
}

TEST_CASE(
    "interpolate, cumulative cubic: rotations of 2.9 rad about slowly changing axes converge") {
  table q = {quaternion(1)};
  for (int i = 1; i < 20; ++i) {
    const vector axis(std::cos(0.1 * i), std::sin(0.1 * i), 0);
    q.push_back(normalized(q.back() * duet::from_axis_angle(axis, 2.9)));
  }
  check_natural(uniform(20), q);
}

TEST_CASE("interpolate: a copy from knots, control quaternions and increments is the same curve") {
  const table q = duet_test::rotated_by(2, 20, 1);
  const spline s = interpolate<spline>(uniform(20), q);
  const spline copy(s.basis().knots(), s.control_points(), s.increments());
  bool has_long_arc = false;
  for (std::size_t i = 1; i < s.control_points().size(); ++i) {
    has_long_arc = has_long_arc || dot(s.control_points()[i - 1], s.control_points()[i]) < 0;
  }
  CHECK(has_long_arc); // alignment of the signs would change the curve
  for (double u = s.basis().front(); u <= s.basis().back(); u += 0.07) {
    CHECK(max_abs_difference(copy(u), s(u)) < 1e-14);
  }
}

TEST_CASE(
    "interpolate: two samples with natural ends give the shortest rotation at a constant rate") {
  const table q = random_orientations(2, 1.4);
  const spline s = interpolate<spline>(parameters{1, 3}, q);
  for (const double u : {1.0, 1.3, 2.0, 2.9, 3.0}) {
    CHECK(max_abs_difference(s(u), slerp(q[0], q[1], (u - 1) / 2)) < 1e-14);
    CHECK(s.motion(u, duet::frame::body).acceleration.norm() < 1e-13);
  }
}

TEST_CASE("interpolate, cumulative cubic: about one axis the curve is the scalar cubic spline") {
  // Clamped with the slopes of a cubic, the spline equals this cubic.
  const auto angle = [](double u) { return 0.3 + u - 0.8 * u * u + 0.3 * u * u * u; };
  const auto slope = [](double u) { return 1 - 1.6 * u + 0.9 * u * u; };
  const vector axis(2.0 / 3, -1.0 / 3, 2.0 / 3);
  const parameters u = {0, 0.3, 0.5, 1.1, 1.9, 2};
  table q;
  for (const double x : u) {
    q.push_back(duet::from_axis_angle(axis, angle(x)));
  }
  const spline s = interpolate<spline>(
      u, q, clamped{vector(axis * slope(u.front())), vector(axis * slope(u.back()))});
  for (double x = 0; x <= 2; x += 0.07) {
    CHECK(max_abs_difference(s(x), duet::from_axis_angle(axis, angle(x))) < 1e-14);
    CHECK((s.motion(x, duet::frame::body).velocity - axis * slope(x)).norm() < 1e-13);
  }
}

TEST_CASE("interpolate, uniform knots: Q_i = q_i exp(−ω_i/6) exp(ω_{i+1}/6) at inner knots") {
  const std::size_t samples = 12;
  const table q = random_orientations(samples, 1.2);
  const spline s = interpolate<spline>(uniform(samples), q);
  const auto sixth = [&](std::size_t i, double sign) {
    return duet::exp(vector(s.increments()[i] * (sign / 6)));
  };
  int count = 0;
  for (std::size_t k = 3; k + 3 < samples; ++k) { // beyond the influence of repeated end knots
    const std::size_t i = k + 1;                  // the control quaternion of the knot
    const quaternion expected = s.control_points()[i] * sixth(i, -1) * sixth(i + 1, 1);
    CHECK(max_abs_difference(s(uniform(samples)[k]), expected) < 1e-14);
    ++count;
  }
  CHECK(count == 6);
}

TEST_CASE("interpolate: signs and rounded norms of the samples do not affect the curve") {
  const table q = random_orientations(15, 1.5);
  table flipped = q;
  for (std::size_t i = 1; i < q.size(); i += 3) {
    flipped[i] = -q[i];
  }
  const spline s = interpolate<spline>(uneven(15), q);
  const spline t = interpolate<spline>(uneven(15), flipped);
  table rounded = q;
  for (quaternion& r : rounded) {
    r = r * (1 + 2e-4);
  }
  const spline r = interpolate<spline>(uneven(15), rounded);
  for (double u = s.basis().front(); u < s.basis().back(); u += 0.1) {
    CHECK(s(u) == t(u));
    CHECK(max_abs_difference(s(u), r(u)) < 1e-14);
  }
}

} // namespace test_spline_interpolate
