// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"
#include "support/multiprecision.hpp"
#include "support/ulp.hpp"

namespace test_spline_motion_accuracy {
namespace {

using duet_test::real_100;
using duet_test::ulps_of_range;
using duet_test::worst_error;

using quaternion = duet::quaternion<real_100>;
using vector = std::array<real_100, 3>;
using derivatives = std::array<quaternion, 4>;

/// Derivatives Q, Q′, Q″, Q‴ by the definition P2 and central differences.
derivatives exact(const std::vector<real_100>& knots, int order, const quaternion& first,
                  const std::vector<duet::vector3<real_100>>& increments, const real_100& u) {
  derivatives result;
  for (int d = 0; d <= 3; ++d) {
    const real_100 h = pow(real_100(10), -90 / (d + 2));
    real_100 binomial = 1;
    for (int i = 0; i <= d; ++i) {
      const real_100 x = u + h * (real_100(d) / 2 - i);
      const quaternion q = duet_test::product_definition(knots, order, first, increments, x, u);
      result[std::size_t(d)] += q * real_100(i % 2 == 0 ? binomial : -binomial);
      binomial = binomial * (d - i) / (i + 1);
    }
    result[std::size_t(d)] /= real_100(pow(h, d));
  }
  return result;
}

vector twice_the_vector(const quaternion& q) { return {2 * q.x(), 2 * q.y(), 2 * q.z()}; }
std::array<real_100, 4> components(const quaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }
real_100 norm(const vector& v) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

struct worst_errors {
  worst_error increments{"P2, logarithms"}, value{"P2, value"}, first{"P3, Q'"}, second{"P4, Q''"},
      velocity{"angular velocity"}, acceleration{"angular acceleration"}, jerk{"angular jerk"};
};

template <int Order>
void measure(worst_errors& worst, const std::string& name, const std::vector<double>& knots,
             double step) {
  const duet::cumulative_bspline<double, Order> s(
      knots, duet_test::random_orientations(knots.size() - std::size_t(Order), step));
  const auto wide_knots = duet_test::cast<real_100>(knots);
  const auto controls = duet_test::cast<real_100>(s.control_points());
  const auto true_increments = duet_test::increments_of(controls);
  // The reference rates follow from the computed ω_i. (For control quaternions that are equal to
  // round-off, ω_i are accurate relative to the quaternions only.)
  std::vector<duet::vector3<real_100>> increments;
  for (std::size_t i = 0; i < controls.size(); ++i) {
    increments.push_back(s.increments()[i].template cast<real_100>());
    worst.increments.add(ulps_of_range<double>(s.increments()[i], true_increments[i], real_100(1)),
                         name, i);
  }
  for (const double u : duet_test::parameters_on(knots, Order, 1)) {
    const auto q = exact(wide_knots, Order, controls[0], increments, u);
    // The sums of absolute terms: the sizes of the rates without cancellation.
    std::array<real_100, 4> size = {1, 0, 0, 0};
    const std::size_t span = s.basis().find_span(u);
    const auto weights = s.basis().template weights<3>(span, u);
    for (std::size_t j = 0; j + 1 < std::size_t(Order); ++j) {
      const double omega = s.increments()[s.basis().first_function(span) + 1 + j].norm();
      for (std::size_t d = 1; d <= 3; ++d) {
        size[d] += 2 * omega * std::abs(weights[d][j]);
      }
    }
    size[3] += 3 * size[1] * size[2];
    size[2] += size[1] * size[1];
    const auto measure = [&](worst_error& w, const auto& computed, const auto& reference,
                             std::size_t d, const real_100& next) {
      w.add(ulps_of_range<double>(computed, reference, real_100(size[d] + abs(next * u))), name, u);
    };
    const auto of_quaternion = [&](worst_error& w, const duet::quaternion<double>& computed,
                                   std::size_t d, const real_100& next) {
      measure(w, std::array{computed.w(), computed.x(), computed.y(), computed.z()},
              components(q[d]), d, next);
    };
    const auto d = s.derivatives(u);
    of_quaternion(worst.value, s(u), 0, squared_norm(q[1]));
    of_quaternion(worst.first, d[1], 1, sqrt(squared_norm(q[2])));
    of_quaternion(worst.second, d[2], 2, sqrt(squared_norm(q[3])));

    const auto& c = q;
    const vector omega = twice_the_vector(conj(c[0]) * c[1]);
    const vector alpha = twice_the_vector(conj(c[0]) * c[2]);
    const vector jerk =
        twice_the_vector(conj(c[0]) * c[3] + real_100(2) * (conj(c[1]) * c[2]) + conj(c[2]) * c[1]);
    const auto body = s.motion(u, duet::frame::body);
    measure(worst.velocity, body.velocity, omega, 1, norm(alpha));
    measure(worst.acceleration, body.acceleration, alpha, 2, norm(jerk));
    measure(worst.jerk, body.jerk, jerk, 3, 0);

    const auto spatial = s.motion(u, duet::frame::spatial);
    const vector omega_s = twice_the_vector(c[1] * conj(c[0]));
    const vector alpha_s = twice_the_vector(c[2] * conj(c[0]));
    const vector jerk_s =
        twice_the_vector(c[3] * conj(c[0]) + real_100(2) * (c[2] * conj(c[1])) + c[1] * conj(c[2]));
    measure(worst.velocity, spatial.velocity, omega_s, 1, norm(alpha_s));
    measure(worst.acceleration, spatial.acceleration, alpha_s, 2, norm(jerk_s));
    measure(worst.jerk, spatial.jerk, jerk_s, 3, 0);
  }
}

TEST_CASE("P2, P3, P4: value and rates are within 16 ulp of 100 digits") {
  worst_errors worst;
  for (const duet_test::named_knots& each : duet_test::knot_vectors(4)) {
    const std::string& name = each.name;
    const std::vector<double>& knots = each.knots;
    for (const double step : {1e-8, 0.003, 0.5, 3.0}) {
      measure<4>(worst, name, knots, step);
    }
  }
  measure<3>(worst, "order 3", duet_test::knot_vectors(3)[1].knots, 1);
  measure<5>(worst, "order 5", duet_test::knot_vectors(5)[1].knots, 1);
  CHECK_MESSAGE(worst.increments <= 16, worst.increments);
  CHECK_MESSAGE(worst.value <= 16, worst.value);
  CHECK_MESSAGE(worst.first <= 16, worst.first);
  CHECK_MESSAGE(worst.second <= 16, worst.second);
  CHECK_MESSAGE(worst.velocity <= 16, worst.velocity);
  CHECK_MESSAGE(worst.acceleration <= 16, worst.acceleration);
  CHECK_MESSAGE(worst.jerk <= 16, worst.jerk);
}

} // namespace
} // namespace test_spline_motion_accuracy
