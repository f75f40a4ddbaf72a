// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"
#include "spline/rotation_vector.hpp"

#include <duet/duet.hpp>

// Orders of convergence of rotation-vector splines, for every end.

namespace test_spline_rotation_vector_convergence {

using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;
template <int Order>
using spline = duet::rotation_vector_spline<double, Order>;

namespace {

struct reference {
  quaternion value;
  vector velocity, acceleration;
};

/// Motion `smooth_motion`, or a periodic one of period 2.
template <bool Periodic>
reference at(double u) {
  const auto q = duet::derivatives<2>(
      [](const auto& x) {
        using std::cos;
        using std::sin;
        if constexpr (Periodic) {
          using std::numbers::pi;
          using S = std::decay_t<decltype(x)>;
          return duet::from_euler<duet::zyx>(S(0.7 * sin(pi * x)), S(0.5 * cos(pi * x)),
                                             S(0.3 * sin(2 * pi * x + 1)));
        } else {
          return duet_test::smooth_motion(x);
        }
      },
      u);
  return {q[0], duet::angular_velocity(q[0], q[1], duet::frame::spatial),
          2 * (q[2] * conj(q[0]) + q[1] * conj(q[1])).vec()};
}

double uniform(double u) { return u; }
/// From 0 to 2 with steps that change smoothly, by a factor of 3.
double graded(double u) { return u + 0.25 * (1 - std::cos(std::acos(-1.0) * u)) * u * (2 - u); }

/// Largest errors of value, ω and angular acceleration on [0, 2].
using errors = std::array<double, 3>;

template <int Order, class Ends>
errors measure(int steps, double (*spacing)(double), const Ends& ends, double a = 0, double b = 2) {
  constexpr bool is_periodic = std::is_same_v<Ends, duet::periodic>;
  std::vector<double> u;
  std::vector<quaternion> q;
  for (int i = 0; i <= steps; ++i) {
    u.push_back(spacing(2.0 * i / steps));
    q.push_back(at<is_periodic>(u.back()).value);
  }
  const auto s = duet::interpolate<spline<Order>>(u, q, ends);
  errors worst{};
  constexpr int samples = 1001;
  for (int i = 0; i < samples; ++i) {
    const double x = a + (b - a) * i / (samples - 1);
    const reference exact = at<is_periodic>(x);
    const auto m = s.motion(x, duet::frame::spatial);
    const double sign = dot(exact.value, m.value) < 0 ? -1 : 1;
    const errors at_parameter = {duet_test::max_abs_difference(exact.value, sign * m.value),
                                 (exact.velocity - m.velocity).norm(),
                                 (exact.acceleration - m.acceleration).norm()};
    for (std::size_t k = 0; k < worst.size(); ++k) {
      worst[k] = std::max(worst[k], at_parameter[k]);
    }
  }
  return worst;
}

/// Checks the orders of convergence observed between `steps` and twice as many steps.
template <int Order, class Ends>
void check_orders(double (*spacing)(double), const Ends& ends, int steps, const errors& expected,
                  double a = 0, double b = 2) {
  const errors coarse = measure<Order>(steps, spacing, ends, a, b);
  const errors fine = measure<Order>(2 * steps, spacing, ends, a, b);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    CAPTURE(k);
    CHECK(std::log2(coarse[k] / fine[k]) == doctest::Approx(expected[k]).epsilon(0.08));
  }
}

const duet::clamped<> velocities{at<false>(0).velocity, at<false>(2).velocity};
const duet::end_acceleration<> accelerations{at<false>(0).acceleration, at<false>(2).acceleration};

} // namespace

TEST_CASE("interpolate, rotation-vector cubic: errors of value h⁴, ω h³, acceleration h²") {
  for (const auto spacing : {uniform, graded}) {
    check_orders<4>(spacing, velocities, 80, {4, 3, 2});
    check_orders<4>(spacing, accelerations, 80, {4, 3, 2});
    check_orders<4>(spacing, duet::not_a_knot{}, 80, {4, 3, 2});
  }
  check_orders<4>(uniform, duet::periodic{}, 80, {4, 3, 2});
}

TEST_CASE("interpolate, rotation-vector quintic: errors of value h⁶, ω h⁵, acceleration h⁴") {
  for (const auto spacing : {uniform, graded}) {
    check_orders<6>(spacing, velocities, 40, {6, 5, 4});
    check_orders<6>(spacing, accelerations, 40, {6, 5, 4});
    check_orders<6>(spacing, duet::fully_clamped{velocities, accelerations}, 40, {6, 5, 4});
    check_orders<6>(spacing, duet::not_a_knot{}, 40, {6, 5, 4});
  }
  check_orders<6>(uniform, duet::periodic{}, 40, {6, 5, 4});
}

TEST_CASE(
    "interpolate, rotation vectors, natural ends: orders 2, 1, 0 at the ends, 4, 3, 2 inside") {
  check_orders<4>(uniform, duet::natural{}, 80, {2, 1, 0.0001});
  check_orders<6>(uniform, duet::natural{}, 40, {2, 1, 0.0001});
  check_orders<4>(uniform, duet::natural{}, 80, {4, 3, 2}, 0.7, 1.3);
}

TEST_CASE("interpolate with known end velocities: the quintic has a fiftieth of the cubic's error "
          "of acceleration") {
  const errors cubic = measure<4>(40, uniform, velocities);
  const errors quintic = measure<6>(40, uniform, velocities);
  CHECK(quintic[2] < cubic[2] / 50);
}

} // namespace test_spline_rotation_vector_convergence
