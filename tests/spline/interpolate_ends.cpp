// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

#include <duet/spline/interpolate.hpp>

namespace test_spline_interpolate_ends {
namespace {

using duet_test::max_abs_difference;
using spline = duet::cumulative_bspline<double>;
using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;
using parameters = std::vector<double>;
using table = std::vector<quaternion>;

table closed_table(std::size_t count, double step) {
  table q = duet_test::random_orientations(count, step, count);
  q.back() = -q.front();
  return q;
}

/// Curve that is checked to pass through the data, and to be C² but not C³ at every knot.
template <class Ends>
spline checked(const parameters& u, const table& q, const Ends& ends) {
  const spline s = duet::interpolate<spline>(u, q, ends);
  for (std::size_t i = 0; i < u.size(); ++i) {
    CHECK(std::min(max_abs_difference(s(u[i]), q[i]), max_abs_difference(s(u[i]), -q[i])) < 1e-14);
  }
  const auto& breaks = s.basis().breaks();
  for (std::size_t i = 1; i + 1 < breaks.size(); ++i) {
    const auto left = s.motion(std::nextafter(breaks[i], -1e9), duet::frame::spatial);
    const auto right = s.motion(breaks[i], duet::frame::spatial);
    CHECK(max_abs_difference(left.value, right.value) < 1e-14);
    CHECK((left.velocity - right.velocity).norm() < 1e-12 * (1 + right.velocity.norm()));
    CHECK((left.acceleration - right.acceleration).norm() <
          1e-12 * (1 + right.acceleration.norm() + right.jerk.norm()));
    CHECK((left.jerk - right.jerk).norm() > 1e-6 * right.jerk.norm());
  }
  return s;
}

constexpr double steps[] = {0.003, 0.5, 1.8};

} // namespace

TEST_CASE("interpolate, cumulative cubic: given end accelerations are met") {
  const vector start(0.3, -0.2, 0.5), end(-1, 0, 0.4);
  for (const std::size_t count : {2, 3, 4, 20}) {
    for (const double step : steps) {
      const parameters u = duet_test::uneven_parameters(count);
      const spline s = checked(u, duet_test::random_orientations(count, step, count),
                               duet::end_acceleration{start, end});
      CHECK((s.motion(u.front(), duet::frame::spatial).acceleration - start).norm() < 1e-12);
      CHECK((s.motion(u.back(), duet::frame::spatial).acceleration - end).norm() < 1e-12);
    }
  }
}

TEST_CASE("interpolate, cumulative cubic: end accelerations of zero equal natural ends") {
  const parameters u = duet_test::uneven_parameters(9);
  const table q = duet_test::random_orientations(9, 1);
  const spline a = checked(u, q, duet::natural{});
  const spline b =
      checked(u, q, duet::end_acceleration{vector(vector::Zero()), vector(vector::Zero())});
  for (std::size_t i = 0; i < a.increments().size(); ++i) {
    CHECK((a.increments()[i] - b.increments()[i]).norm() < 1e-15);
  }
}

TEST_CASE(
    "interpolate, not-a-knot: the jerk is continuous at the second and the last but one sample") {
  for (const std::size_t count : {4, 5, 6, 7, 20}) {
    for (const double step : steps) {
      CAPTURE(count);
      CAPTURE(step);
      const parameters u = duet_test::uneven_parameters(count);
      const spline s =
          checked(u, duet_test::random_orientations(count, step, count), duet::not_a_knot{});
      CHECK(s.basis().breaks().size() == count - 2);
      for (const double at : {u[1], u[count - 2]}) {
        const vector left = s.motion(std::nextafter(at, -1e9), duet::frame::body).jerk;
        const vector right = s.motion(at, duet::frame::body).jerk;
        CHECK((left - right).norm() < 1e-11 * (1 + right.norm()));
      }
    }
  }
}

TEST_CASE("interpolate, not-a-knot: about one axis cubics are reproduced") {
  const auto angle = [](double u) { return 0.3 + u - 0.8 * u * u + 0.3 * u * u * u; };
  const vector axis(2.0 / 3, -1.0 / 3, 2.0 / 3);
  for (const parameters& u : {parameters{0, 0.5, 1.1, 2}, parameters{0, 0.3, 0.5, 1.1, 1.9, 2}}) {
    table q;
    for (const double x : u) {
      q.push_back(duet::from_axis_angle(axis, angle(x)));
    }
    const spline s = duet::interpolate<spline>(u, q, duet::not_a_knot{});
    for (double x = 0; x <= 2; x += 0.07) {
      CHECK(max_abs_difference(s(x), duet::from_axis_angle(axis, angle(x))) < 1e-14);
    }
  }
}

TEST_CASE("interpolate, periodic: value, velocity and acceleration are equal at both ends") {
  for (const std::size_t count : {3, 4, 5, 6, 20}) {
    for (const double step : steps) {
      CAPTURE(count);
      CAPTURE(step);
      const parameters u = duet_test::uneven_parameters(count);
      const spline s = checked(u, closed_table(count, step), duet::periodic{});
      const auto start = s.motion(u.front(), duet::frame::spatial);
      const auto end = s.motion(u.back(), duet::frame::spatial);
      CHECK(std::min(max_abs_difference(start.value, end.value),
                     max_abs_difference(start.value, -end.value)) < 1e-14);
      CHECK((start.velocity - end.velocity).norm() < 1e-12 * (1 + start.velocity.norm()));
      CHECK((start.acceleration - end.acceleration).norm() <
            1e-12 * (1 + start.acceleration.norm() + start.jerk.norm()));
    }
  }
}

TEST_CASE("interpolate, periodic: the curve does not depend on the first sample of the period") {
  const std::size_t count = 12, shift = 5;
  const parameters u = duet_test::uneven_parameters(count);
  const table q = closed_table(count, 1.2);
  const double period = u.back() - u.front();
  parameters v;
  table p;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t j = i + shift;
    v.push_back(j < count - 1 ? u[j] : u[j - (count - 1)] + period);
    p.push_back(q[j % (count - 1)]);
  }
  const spline s = duet::interpolate<spline>(u, q, duet::periodic{});
  const spline t = duet::interpolate<spline>(v, p, duet::periodic{});
  for (double x = v.front(); x <= v.back(); x += 0.13) {
    const double same = x <= u.back() ? x : x - period;
    CHECK(std::min(max_abs_difference(s(same), t(x)), max_abs_difference(s(same), -t(x))) < 1e-13);
  }
}

TEST_CASE("interpolate, periodic: several full turns about one axis have a constant rate") {
  const vector axis(0.6, 0, 0.8);
  for (const int revolutions : {1, 2, 3}) { // an odd number ends in −q
    parameters u;
    table q;
    for (int i = 0; i <= 12; ++i) {
      u.push_back(i);
      q.push_back(duet::from_axis_angle(axis, std::acos(-1.0) * revolutions * i / 6));
    }
    const spline s = duet::interpolate<spline>(u, q, duet::periodic{});
    for (double x = 0; x <= 12; x += 0.31) {
      const auto m = s.motion(x, duet::frame::body);
      CHECK((m.velocity - axis * (std::acos(-1.0) * revolutions / 6)).norm() < 1e-13);
      CHECK(m.acceleration.norm() < 1e-13);
    }
  }
}

TEST_CASE("interpolation_report: iterations, residual and largest step of a cumulative cubic") {
  duet::interpolation_report report;
  const table q = duet_test::rotated_by(1.25, 30, 3);
  const parameters u = duet_test::uneven_parameters(30);
  const spline s = duet::interpolate<spline>(u, q, duet::natural{}, report);
  CHECK(report.largest_step == doctest::Approx(1.25).epsilon(1e-14));
  CHECK(report.residual < 5e-15);
  CHECK(report.iterations >= 3);
  CHECK(report.iterations < 60);

  table equal(5, q.front());
  const spline still =
      duet::interpolate<spline>(duet_test::uneven_parameters(5), equal, duet::not_a_knot{}, report);
  CHECK(report.largest_step < 1e-15);
  CHECK(report.iterations == 1);
  CHECK(still.motion(0, duet::frame::body).velocity.norm() < 1e-15);
}

TEST_CASE("interpolate: the unit of the parameters does not affect the curve") {
  const table q = duet_test::random_orientations(8, 1.3);
  const parameters u = duet_test::uneven_parameters(8);
  const auto check = [&](auto ends, auto scaled_ends, double unit) {
    parameters v;
    for (const double x : u) {
      v.push_back(x * unit);
    }
    const spline s = duet::interpolate<spline>(u, q, ends);
    const spline t = duet::interpolate<spline>(v, q, scaled_ends);
    for (std::size_t i = 0; i < s.increments().size(); ++i) {
      CHECK((s.increments()[i] - t.increments()[i]).norm() < 1e-13);
    }
  };
  const vector a(0.3, 0.1, -0.4), b(0.2, 0.5, 0);
  for (const double unit : {1e-9, 1e-3, 1e6}) {
    CAPTURE(unit);
    check(duet::natural{}, duet::natural{}, unit);
    check(duet::not_a_knot{}, duet::not_a_knot{}, unit);
    check(duet::clamped{a, b}, duet::clamped{a / unit, b / unit}, unit);
    check(duet::end_acceleration{a, b},
          duet::end_acceleration{a / (unit * unit), b / (unit * unit)}, unit);
  }
}

} // namespace test_spline_interpolate_ends
