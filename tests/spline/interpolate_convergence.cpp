// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

#include <duet/duet.hpp>

namespace test_spline_interpolate_convergence {

using duet_test::max_abs_difference;

using spline = duet::cumulative_bspline<double>;
using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;

namespace {

/// A smooth motion whose rotations do not commute, u in [0, 2].
struct passing {
  template <class S>
  duet::quaternion<S> operator()(const S& u) const {
    using std::cos;
    using std::exp;
    using std::sin;
    return duet::from_euler<duet::zyx>(S(1.3 * sin(1.1 * u + 0.2)), S(0.9 * cos(1.7 * u)),
                                       S(0.8 * u * exp(-0.3 * u)));
  }
};
/// Motion of period 2 with a full turn.
struct returning {
  template <class S>
  duet::quaternion<S> operator()(const S& u) const {
    using std::cos;
    using std::numbers::pi;
    return duet::from_euler<duet::zyx>(S(pi * u), S(0.9 * cos(pi * u)), S(0.3 * cos(pi * u)));
  }
};

/// Value of a motion at u and its derivatives.
struct reference {
  template <class Path = passing>
  explicit reference(double u, const Path& path = {}) {
    const auto q = duet::derivatives<2>([&](const auto& x) { return path(x); }, u);
    value = q[0];
    second = q[2];
    velocity = duet::angular_velocity(q[0], q[1], duet::frame::spatial);
    acceleration = 2 * (q[2] * conj(q[0]) + q[1] * conj(q[1])).vec();
  }
  quaternion value, second;
  vector velocity, acceleration;
};

/// Largest errors: value, ω, α, Q″ of the curve, Q″ by the commuting sum (P4 with its basis
/// corrected).
using errors = std::array<double, 5>;

/// Errors between the parameters a and b of the curve through samples at spacing(2 i/steps).
template <class Spacing, class Ends, class Path = passing>
errors measure(int steps, Spacing spacing, const Ends& ends, double a, double b,
               const Path& path = {}) {
  std::vector<double> u;
  std::vector<quaternion> q;
  for (int i = 0; i <= steps; ++i) {
    u.push_back(spacing(2.0 * i / steps));
    q.push_back(path(u.back()));
  }
  const spline s = duet::interpolate<spline>(u, q, ends);
  errors worst{};
  constexpr int samples = 4001;
  for (int i = 0; i < samples; ++i) {
    const double at = a + (b - a) * i / (samples - 1);
    const reference exact(at, path);
    const auto m = s.motion(at, duet::frame::spatial);
    const double sign = dot(exact.value, m.value) < 0 ? -1 : 1;
    const errors at_parameter = {
        max_abs_difference(exact.value, sign * m.value), (exact.velocity - m.velocity).norm(),
        (exact.acceleration - m.acceleration).norm(),
        max_abs_difference(exact.second, sign * s.derivatives(at)[2]),
        max_abs_difference(exact.second, sign * duet::printed_derivative(s, at).commuting_second)};
    for (std::size_t k = 0; k < worst.size(); ++k) {
      worst[k] = std::max(worst[k], at_parameter[k]);
    }
  }
  return worst;
}

/// Observed orders from 80 steps to 160.
template <class Spacing, class Ends, class Path = passing>
errors orders(Spacing spacing, const Ends& ends, double a, double b, const Path& path = {}) {
  const errors coarse = measure(80, spacing, ends, a, b, path);
  const errors fine = measure(160, spacing, ends, a, b, path);
  errors result;
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = std::log2(coarse[k] / fine[k]);
  }
  return result;
}

double uniform(double u) { return u; }
/// From 0 to 2 with steps that change smoothly, by a factor of 3.
double graded(double u) { return u + 0.25 * (1 - std::cos(std::acos(-1.0) * u)) * u * (2 - u); }

duet::clamped<> exact_rates() { return {reference(0).velocity, reference(2).velocity}; }

} // namespace

TEST_CASE("interpolate, cumulative cubic, exact end velocities: errors of value h³, ω h², angular "
          "acceleration h") {
  for (const auto spacing : {uniform, graded}) {
    const errors order = orders(spacing, exact_rates(), 0, 2);
    CHECK(order[0] == doctest::Approx(3).epsilon(0.1));
    CHECK(order[1] == doctest::Approx(2).epsilon(0.1));
    CHECK(order[2] == doctest::Approx(1).epsilon(0.1));
  }
}

TEST_CASE("interpolate, cumulative cubic, exact end accelerations and not-a-knot: orders 3, 2, 1 "
          "up to the ends") {
  const duet::end_acceleration<> exact = {reference(0).acceleration, reference(2).acceleration};
  for (const auto spacing : {uniform, graded}) {
    const auto check = [](const errors& order) {
      CHECK(order[0] == doctest::Approx(3).epsilon(0.1));
      CHECK(order[1] == doctest::Approx(2).epsilon(0.1));
      CHECK(order[2] == doctest::Approx(1).epsilon(0.1));
    };
    check(orders(spacing, exact, 0, 2));
    check(orders(spacing, duet::not_a_knot{}, 0, 2));
  }
}

TEST_CASE("interpolate, cumulative cubic, periodic ends: orders 3, 2, 1 on the entire period") {
  for (const auto spacing : {uniform, graded}) {
    const errors order = orders(spacing, duet::periodic{}, 0, 2, returning{});
    CHECK(order[0] == doctest::Approx(3).epsilon(0.1));
    CHECK(order[1] == doctest::Approx(2).epsilon(0.1));
    CHECK(order[2] == doctest::Approx(1).epsilon(0.1));
  }
}

TEST_CASE(
    "interpolate, cumulative cubic, natural ends: orders 3, 2, 1 inside, 2, 1, 0 at the ends") {
  const errors inside = orders(uniform, duet::natural{}, 0.7, 1.3);
  CHECK(inside[0] == doctest::Approx(3).epsilon(0.1));
  CHECK(inside[1] == doctest::Approx(2).epsilon(0.1));
  CHECK(inside[2] == doctest::Approx(1).epsilon(0.1));

  const errors at_ends = orders(uniform, duet::natural{}, 0, 2);
  CHECK(at_ends[0] == doctest::Approx(2).epsilon(0.1));
  CHECK(at_ends[1] == doctest::Approx(1).epsilon(0.1));
  CHECK(std::abs(at_ends[2]) < 0.1);
  const double wrong = std::max(reference(0).acceleration.norm(), reference(2).acceleration.norm());
  CHECK(measure(160, uniform, duet::natural{}, 0, 2)[2] == doctest::Approx(wrong).epsilon(0.01));
}

TEST_CASE("P4: the commuting sum is second-order accurate inside, the derivative of the curve "
          "first-order") {
  // Q″ of the cumulative cubic is first-order accurate because of commutators of neighbouring ω_i.
  // The printed formula omits them, and their error with them.
  for (const auto spacing : {uniform, graded}) {
    const errors order = orders(spacing, exact_rates(), 0.7, 1.3);
    CHECK(order[3] == doctest::Approx(1).epsilon(0.1));
    CHECK(order[4] == doctest::Approx(2).epsilon(0.1));
    const errors fine = measure(160, spacing, exact_rates(), 0.7, 1.3);
    CHECK(fine[4] < fine[3] / 5);
  }
  // With repeated end knots the order is lost.
  const errors order = orders(uniform, exact_rates(), 0, 2);
  CHECK(order[3] == doctest::Approx(1).epsilon(0.1));
  CHECK(order[4] == doctest::Approx(1).epsilon(0.1));
}

} // namespace test_spline_interpolate_convergence
