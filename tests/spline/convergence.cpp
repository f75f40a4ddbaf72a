// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

// Orders of convergence of curves through samples of smooth motions, for every end.

namespace test_spline_convergence {
namespace {

using duet_test::max_abs_difference;
using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;
using cumulative = duet::cumulative_bspline<double>;
using cubic = duet::rotation_vector_spline<double>;
using quintic = duet::rotation_vector_spline<double, 6>;

/// Motion whose rotations do not commute, u in [0, 2], or a periodic one of period 2.
template <bool IsPeriodic, class S>
duet::quaternion<S> motion_at(const S& u) {
  using std::cos, std::exp, std::sin;
  if constexpr (IsPeriodic) {
    using std::numbers::pi;
    return duet::from_euler<duet::zyx>(S(0.7 * sin(pi * u)), S(0.5 * cos(pi * u)),
                                       S(0.3 * sin(2 * pi * u + 1)));
  } else {
    return duet::from_euler<duet::zyx>(S(1.3 * sin(1.1 * u + 0.2)), S(0.9 * cos(1.7 * u)),
                                       S(0.8 * u * exp(-0.3 * u)));
  }
}

struct reference {
  quaternion value, second;
  vector velocity, acceleration;
};
template <bool IsPeriodic = false>
reference at(double u) {
  const auto q = duet::derivatives<2>([](const auto& x) { return motion_at<IsPeriodic>(x); }, u);
  return {q[0], q[2], duet::angular_velocity(q[0], q[1], duet::frame::spatial),
          2 * (q[2] * conj(q[0]) + q[1] * conj(q[1])).vec()};
}

double uniform(double u) { return u; }
/// From 0 to 2 with steps that change smoothly, by a factor of 3.
double graded(double u) { return u + 0.25 * (1 - std::cos(std::acos(-1.0) * u)) * u * (2 - u); }

/// Largest errors of value, ω, angular acceleration, and of cumulative cubics Q″ and Q″ by the
/// commuting sum (P4 with its basis corrected).
using errors = std::array<double, 5>;

/// Errors between the parameters a and b of the curve through samples at spacing(2 i/steps).
template <class Spline, class Ends>
errors measure(int steps, double (*spacing)(double), const Ends& ends, double a, double b) {
  constexpr bool is_periodic = std::is_same_v<Ends, duet::periodic>;
  std::vector<double> u;
  std::vector<quaternion> q;
  for (int i = 0; i <= steps; ++i) {
    u.push_back(spacing(2.0 * i / steps));
    q.push_back(at<is_periodic>(u.back()).value);
  }
  const auto s = duet::interpolate<Spline>(u, q, ends);
  errors worst{};
  constexpr int samples = std::is_same_v<Spline, cumulative> ? 4001 : 1001;
  for (int i = 0; i < samples; ++i) {
    const double x = a + (b - a) * i / (samples - 1);
    const reference exact = at<is_periodic>(x);
    const auto m = s.motion(x, duet::frame::spatial);
    const double sign = dot(exact.value, m.value) < 0 ? -1 : 1;
    errors at_parameter = {max_abs_difference(exact.value, sign * m.value),
                           (exact.velocity - m.velocity).norm(),
                           (exact.acceleration - m.acceleration).norm()};
    if constexpr (std::is_same_v<Spline, cumulative>) {
      at_parameter[3] = max_abs_difference(exact.second, sign * s.derivatives(x)[2]);
      at_parameter[4] =
          max_abs_difference(exact.second, sign * duet::printed_derivative(s, x).commuting_second);
    }
    for (std::size_t k = 0; k < worst.size(); ++k) {
      worst[k] = std::max(worst[k], at_parameter[k]);
    }
  }
  return worst;
}

/// Orders observed between 80 and 160 steps, of quintics between 40 and 80.
template <class Spline, class Ends>
errors orders(double (*spacing)(double), const Ends& ends, double a = 0, double b = 2) {
  constexpr int steps = Spline::order == 6 ? 40 : 80;
  const errors coarse = measure<Spline>(steps, spacing, ends, a, b);
  const errors fine = measure<Spline>(2 * steps, spacing, ends, a, b);
  errors result;
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = std::log2(coarse[k] / fine[k]);
  }
  return result;
}

/// Checks the orders of value, ω and angular acceleration: n, n − 1, n − 2.
template <class Spline, class Ends>
void check_orders(int n, double (*spacing)(double), const Ends& ends, double a = 0, double b = 2) {
  const errors order = orders<Spline>(spacing, ends, a, b);
  for (std::size_t k = 0; k < 3; ++k) {
    CAPTURE(k);
    const double tolerance = std::is_same_v<Spline, cumulative> ? 0.1 : 0.08;
    CHECK(order[k] == doctest::Approx(n - int(k)).epsilon(tolerance));
  }
}

const duet::clamped<> velocities{at(0).velocity, at(2).velocity};
const duet::end_acceleration<> accelerations{at(0).acceleration, at(2).acceleration};

TEST_CASE_TEMPLATE("interpolate: errors of cumulative cubics are h³, of rotation-vector cubics h⁴, "
                   "of quintics h⁶; of ω and angular acceleration one and two orders less",
                   Spline, cumulative, cubic, quintic) {
  constexpr int n = std::is_same_v<Spline, cumulative> ? 3 : Spline::order;
  for (const auto spacing : {uniform, graded}) {
    check_orders<Spline>(n, spacing, velocities);
    check_orders<Spline>(n, spacing, accelerations);
    check_orders<Spline>(n, spacing, duet::not_a_knot{});
    if constexpr (n == 6) {
      check_orders<Spline>(n, spacing, duet::fully_clamped{velocities, accelerations});
    }
  }
  check_orders<Spline>(n, uniform, duet::periodic{});
  // Natural ends of a motion whose acceleration is not zero there.
  check_orders<Spline>(2, uniform, duet::natural{});
  if constexpr (n < 6) {
    check_orders<Spline>(n, uniform, duet::natural{}, 0.7, 1.3);
  }
}

TEST_CASE("interpolate, natural ends: the error is the acceleration at the end") {
  const double wrong = std::max(at(0).acceleration.norm(), at(2).acceleration.norm());
  CHECK(measure<cumulative>(160, uniform, duet::natural{}, 0, 2)[2] ==
        doctest::Approx(wrong).epsilon(0.01));
}

TEST_CASE("interpolate with known end velocities: the quintic has a fiftieth of the cubic's error "
          "of acceleration") {
  const errors of_cubic = measure<cubic>(40, uniform, velocities, 0, 2);
  CHECK(measure<quintic>(40, uniform, velocities, 0, 2)[2] < of_cubic[2] / 50);
}

TEST_CASE("P4: the commuting sum is second-order accurate inside, the derivative of the curve "
          "first-order") {
  // Q″ of the cumulative cubic is first-order accurate because of commutators of neighbouring ω_i.
  // The printed formula omits them, and their error with them.
  for (const auto spacing : {uniform, graded}) {
    const errors order = orders<cumulative>(spacing, velocities, 0.7, 1.3);
    CHECK(order[3] == doctest::Approx(1).epsilon(0.1));
    CHECK(order[4] == doctest::Approx(2).epsilon(0.1));
    const errors fine = measure<cumulative>(160, spacing, velocities, 0.7, 1.3);
    CHECK(fine[4] < fine[3] / 5);
  }
  // With repeated end knots the order is lost.
  const errors order = orders<cumulative>(uniform, velocities, 0, 2);
  CHECK(order[3] == doctest::Approx(1).epsilon(0.1));
  CHECK(order[4] == doctest::Approx(1).epsilon(0.1));
}

} // namespace
} // namespace test_spline_convergence
