// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

#include <duet/spline/interpolate.hpp>

// Rotation-vector splines through data: they pass through it, are as smooth as their order says and
// meet their end conditions.

namespace test_spline_rotation_vector_interpolate {

using duet::interpolate;
using duet_test::max_abs_difference;

using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;
using parameters = std::vector<double>;
using table = std::vector<quaternion>;
template <int Order>
using spline = duet::rotation_vector_spline<double, Order>;

namespace {

parameters uneven(std::size_t count) {
  duet_test::random_source random(count);
  parameters u = {-0.3};
  while (u.size() < count) {
    u.push_back(u.back() + random.log_uniform(0.2, 0.8));
  }
  return u;
}

/// ω, ω̇ … before and after knot i, body axes.
template <int Order>
std::array<std::array<vector, 5>, 2> both_sides(const spline<Order>& s, std::size_t i) {
  std::array<std::array<vector, 5>, 2> result;
  for (const bool before : {true, false}) {
    if (before && i == 0) {
      continue;
    }
    const double u = s.knots()[i];
    const double at = before ? std::nextafter(u, -1e9) : u;
    // Taylor numbers through the value: independent of the closed form.
    using series = duet::taylor<double, 5>;
    const auto q = s(series::variable(at));
    const auto rate = [](const series& x) {
      series y;
      for (int k = 0; k < 5; ++k) {
        y.set_coefficient(k, x.coefficient(k + 1) * (k + 1));
      }
      return y;
    };
    const auto w =
        conj(q) * duet::quaternion<series>(rate(q.w()), rate(q.x()), rate(q.y()), rate(q.z()));
    for (int k = 0; k < 5; ++k) {
      result[before ? 0 : 1][std::size_t(k)] = {2 * w.x().derivative(k), 2 * w.y().derivative(k),
                                                2 * w.z().derivative(k)};
    }
  }
  return result;
}

/// Checks that the curve passes through the data, that its derivatives up to the (k−2)-th are
/// continuous at inner knots, and that the next one is continuous only at the `joints` outermost
/// inner knots.
template <int Order>
void check_curve(const spline<Order>& s, const parameters& u, const table& q, int joints) {
  constexpr std::size_t smooth = std::size_t(Order) - 2;
  std::array<double, 5> size{};
  std::vector<std::array<std::array<vector, 5>, 2>> sides;
  // The terms of the polynomial of a segment are as large as the rates at its ends.
  double fastest = 0;
  for (const double knot : u) {
    fastest = std::max(fastest, s.motion(knot, duet::frame::body).velocity.norm());
  }
  for (std::size_t i = 0; i < u.size(); ++i) {
    const quaternion at = s(u[i]);
    CHECK(std::min(max_abs_difference(at, q[i]), max_abs_difference(at, -q[i])) <
          1e-15 * (1 + fastest));
    if (i > 0 && i + 1 < u.size()) {
      sides.push_back(both_sides(s, i));
      for (std::size_t k = 0; k < 5; ++k) {
        size[k] = std::max(size[k], sides.back()[1][k].norm());
      }
    }
  }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    CAPTURE(i);
    for (std::size_t k = 0; k < smooth; ++k) {
      CAPTURE(k);
      CHECK((sides[i][0][k] - sides[i][1][k]).norm() < 3e-12 * size[k] + 1e-13);
    }
    const double jump = (sides[i][0][smooth] - sides[i][1][smooth]).norm();
    const std::size_t from_end = std::min(i, sides.size() - 1 - i);
    if (from_end < std::size_t(joints)) {
      CHECK(jump < 1e-10 * size[smooth] + 1e-14);
    } else if (size[0] > 1e-3) {
      CHECK(jump > 1e-6 * size[smooth]);
    }
  }
}

template <int Order>
void check_all_ends(const parameters& u, const table& q) {
  const vector start(0.3, -0.2, 0.5);
  const vector end(-1, 0, 0.4);
  const auto at = [&](const spline<Order>& s, bool first) {
    return s.motion(first ? u.front() : u.back(), duet::frame::spatial);
  };
  {
    const auto s = interpolate<spline<Order>>(u, q, duet::natural{});
    check_curve(s, u, q, 0);
    CHECK(at(s, true).acceleration.norm() < 1e-11);
    CHECK(at(s, false).acceleration.norm() < 1e-11);
    if constexpr (Order == 6) { // no snap at the end
      CHECK(both_sides(s, u.size() - 1)[0][3].norm() < 1e-8);
    }
  }
  if (u.size() >= 4 || Order == 4) {
    const auto s = interpolate<spline<Order>>(u, q, duet::clamped{start, end});
    check_curve(s, u, q, Order == 6 ? 1 : 0);
    CHECK((at(s, true).velocity - start).norm() < 1e-12);
    CHECK((at(s, false).velocity - end).norm() < 1e-12);
  }
  if (u.size() >= 4 || Order == 4) {
    const auto s = interpolate<spline<Order>>(u, q, duet::end_acceleration{start, end});
    check_curve(s, u, q, Order == 6 ? 1 : 0);
    CHECK((at(s, true).acceleration - start).norm() < 1e-11);
    CHECK((at(s, false).acceleration - end).norm() < 1e-11);
  }
  if constexpr (Order == 6) {
    const auto s = interpolate<spline<Order>>(
        u, q, duet::fully_clamped{duet::clamped{start, end}, duet::end_acceleration{end, start}});
    check_curve(s, u, q, 0);
    CHECK((at(s, true).velocity - start).norm() < 1e-12);
    CHECK((at(s, false).velocity - end).norm() < 1e-12);
    CHECK((at(s, true).acceleration - end).norm() < 1e-11);
    CHECK((at(s, false).acceleration - start).norm() < 1e-11);
  }
  if (u.size() >= std::size_t(Order)) {
    const auto s = interpolate<spline<Order>>(u, q, duet::not_a_knot{});
    check_curve(s, u, q, Order == 6 ? 2 : 1);
  }
  if (u.size() >= 3) {
    table closed = q;
    closed.back() = -closed.front();
    const auto s = interpolate<spline<Order>>(u, closed, duet::periodic{});
    check_curve(s, u, closed, 0);
    const auto left = both_sides(s, u.size() - 1)[0];
    const auto right = both_sides(s, 0)[1];
    for (std::size_t k = 0; k + 2 < std::size_t(Order); ++k) {
      CHECK((left[k] - right[k]).norm() < 1e-9);
    }
  }
}

} // namespace

TEST_CASE_TEMPLATE("interpolate, rotation vectors: the curve is C^(k−2), passes through the data "
                   "and meets its end conditions",
                   order, std::integral_constant<int, 4>, std::integral_constant<int, 6>) {
  for (const std::size_t count : {2, 3, 4, 6, 13}) {
    for (const double step : {1e-9, 0.003, 0.3, 1.2}) {
      CAPTURE(count);
      CAPTURE(step);
      check_all_ends<order::value>(uneven(count),
                                   duet_test::random_orientations(count, step, count));
    }
  }
}

TEST_CASE("interpolate, quintic: equal samples give a curve at rest") {
  const table q(7, quaternion(0.6, 0, 0.8, 0));
  const auto s = interpolate<spline<6>>(uneven(7), q, duet::not_a_knot{});
  CHECK(s.motion(0.5, duet::frame::body).velocity.norm() == 0);
  CHECK(max_abs_difference(s(0.5), q[0]) < 1e-15);
}

TEST_CASE("interpolate, rotation vectors: about one axis polynomials of the degree of the spline "
          "are reproduced") {
  const vector axis(2.0 / 3, -1.0 / 3, 2.0 / 3);
  const auto angle = [](double u, int degree) {
    return 0.3 + u - 0.4 * std::pow(u, 3) + (degree == 5 ? 0.1 * std::pow(u, 5) : 0.0);
  };
  const parameters u = {0, 0.3, 0.5, 1.1, 1.3, 1.9, 2};
  for (const int degree : {3, 5}) {
    table q;
    for (const double x : u) {
      q.push_back(duet::from_axis_angle(axis, angle(x, degree)));
    }
    const auto check = [&](const auto& s) {
      for (double x = 0; x <= 2; x += 0.07) {
        CHECK(max_abs_difference(s(x), duet::from_axis_angle(axis, angle(x, degree))) < 1e-13);
      }
    };
    if (degree == 3) {
      check(interpolate<spline<4>>(u, q, duet::not_a_knot{}));
      check(interpolate<spline<4>>(u, q, duet::clamped{axis, vector(axis * (1 - 1.2 * 4))}));
    }
    check(interpolate<spline<6>>(u, q, duet::not_a_knot{}));
  }
}

TEST_CASE("interpolate, rotation vectors: rotations of up to 2.8 rad about random axes give a "
          "curve or an error with the largest rotation") {
  int converged = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    for (const double angle : {2.0, 2.8}) {
      const table q = duet_test::rotated_by(angle, 20, seed);
      parameters u;
      for (int i = 0; i < 20; ++i) {
        u.push_back(i);
      }
      check_curve(interpolate<spline<4>>(u, q, duet::natural{}), u, q, 0);
      check_curve(interpolate<spline<4>>(u, q, duet::not_a_knot{}), u, q, 1);
      try {
        check_curve(interpolate<spline<6>>(u, q, duet::natural{}), u, q, 0);
        ++converged;
      } catch (const duet::no_convergence& error) {
        CHECK(std::string(error.what()).find("rad, from sample") != std::string::npos);
      }
    }
  }
  CHECK(converged >= 23);
}

TEST_CASE("interpolation_report: iterations, residual and largest step of a quintic") {
  duet::interpolation_report report;
  const table q = duet_test::random_orientations(30, 0.003, 4);
  static_cast<void>(interpolate<spline<6>>(uneven(30), q, duet::natural{}, report));
  CHECK(report.iterations >= 1);
  CHECK(report.iterations <= 6);
  CHECK(report.residual < 1e-14);
  CHECK(report.largest_step > 0.002);
  CHECK(report.largest_step < 0.004);
}

} // namespace test_spline_rotation_vector_interpolate
