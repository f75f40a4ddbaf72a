// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

namespace test_spline_curve {
namespace {

using duet::cumulative_bspline;
using duet_test::knot_vectors;
using duet_test::max_abs_difference;
using duet_test::message_of;
using duet_test::parameters_on;
using duet_test::random_orientations;

using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;

template <class F>
void for_each_order(F&& f) {
  f(std::integral_constant<int, 2>{});
  f(std::integral_constant<int, 3>{});
  f(std::integral_constant<int, 4>{});
  f(std::integral_constant<int, 5>{});
  f(std::integral_constant<int, 6>{});
}

template <int Order>
cumulative_bspline<double, Order> random_curve(const std::vector<double>& knots, double step) {
  return {knots, random_orientations(knots.size() - std::size_t(Order), step)};
}

TEST_CASE("cumulative_bspline: increments of small steps have the digits of the control points") {
  std::vector<double> breaks(38);
  std::iota(breaks.begin(), breaks.end(), 0.);
  for (const double step : {1e-12, 1e-9, 1e-6}) {
    std::vector<quaternion> controls;
    for (int i = 0; i < 40; ++i) {
      controls.push_back(duet::from_rotation_vector(vector(.3, -.4, 1.1)) *
                         duet::from_rotation_vector(vector(i * step, -.5 * i * step, 0)));
    }
    const cumulative_bspline<double> s(duet::clamped_knots(breaks, 4), controls);
    double largest = 0;
    for (std::size_t i = 1; i < controls.size(); ++i) {
      using wide = duet::quaternion<long double>;
      const auto reference = log(normalized(conj(wide(controls[i - 1])) * wide(controls[i]))).vec();
      const auto miss =
          (s.increments()[i].cast<long double>() - reference).norm() / reference.norm();
      largest = std::max(largest, double(miss));
    }
    CHECK_LT(largest, 1e-18 / step + 1e-15); // the reference itself has this error
  }
}

TEST_CASE("P2: the curve equals the product over all control quaternions") {
  for_each_order([](auto order) {
    constexpr int k = order;
    for (const duet_test::named_knots& each : knot_vectors(k)) {
      const std::string& name = each.name;
      const std::vector<double>& knots = each.knots;
      CAPTURE(k);
      CAPTURE(name);
      const auto s = random_curve<k>(knots, 1.5);
      const auto increments = duet_test::increments_of(s.control_points());
      double worst = 0;
      for (const double u : parameters_on(knots, k, 3)) {
        const auto product =
            duet_test::product_definition(knots, k, s.control_points()[0], increments, u, u);
        worst = std::max(worst, max_abs_difference(s(u), product));
        worst = std::max(worst, std::abs(squared_norm(s(u)) - 1));
      }
      CHECK(worst <= 1e-14);
    }
  });
}

TEST_CASE("P2 as printed, functions from B_{−1}: the first exponent B̃_0 is correct except in the "
          "first span") {
  const auto knots = knot_vectors(4)[1].knots;
  const auto s = random_curve<4>(knots, 1);
  const quaternion first = s.control_points().front();
  int in_first_span = 0, beyond = 0;
  for (const double u : parameters_on(knots, 4)) {
    const double exponent = duet_test::cumulative_definition(knots, 1, 4, u, u);
    const quaternion printed = pow(first, exponent) * (conj(first) * s(u));
    if (s.basis().find_span(u) == 0 && exponent < 0.999) {
      CHECK(max_abs_difference(printed, s(u)) > 1e-6);
      ++in_first_span;
    } else if (s.basis().find_span(u) > 0) {
      CHECK(exponent == doctest::Approx(1).epsilon(1e-15));
      CHECK(max_abs_difference(printed, s(u)) < 1e-14);
      ++beyond;
    }
  }
  CHECK(in_first_span > 3);
  CHECK(beyond > 10);
}

TEST_CASE("cumulative_bspline: only the sign of the first control quaternion affects the curve") {
  const auto knots = knot_vectors(4)[1].knots;
  const auto s = random_curve<4>(knots, 2.5);
  std::vector<quaternion> flipped = s.control_points();
  for (std::size_t i = 1; i < flipped.size(); i += 2) {
    flipped[i] = -flipped[i];
  }
  const cumulative_bspline<double> t(knots, flipped);
  flipped[0] = -flipped[0];
  const cumulative_bspline<double> opposite(knots, flipped);
  for (std::size_t i = 0; i < flipped.size(); ++i) {
    CHECK(t.control_points()[i] == s.control_points()[i]);
    CHECK(t.increments()[i] == s.increments()[i]);
    CHECK(s.increments()[i].norm() <= 1.5707963268); // half of a half turn
  }
  for (const double u : parameters_on(knots, 4)) {
    CHECK(t(u) == s(u));
    CHECK(max_abs_difference(opposite(u), -s(u)) < 1e-15);
  }
}

TEST_CASE("cumulative_bspline: errors for missing control quaternions, for norms other than 1 and "
          "for neighbours half a turn apart") {
  const std::vector<double> knots = {0, 0, 0, 1, 2, 2, 2};
  using spline = cumulative_bspline<double, 3>;
  const auto make = [&](std::vector<quaternion> controls) {
    return [&knots, controls] { (void)spline(knots, controls); };
  };
  const quaternion one(1);
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  CHECK(message_of<duet::invalid_input>(make({one, one, one})) ==
        "duet: cumulative_bspline: 7 knots of order 3 need 4 control points, got 3");
  CHECK(message_of<duet::invalid_input>(make({})) ==
        "duet: cumulative_bspline: 7 knots of order 3 need 4 control points, got 0");
  CHECK(message_of<duet::invalid_sample>(make({one, one * 1.1, one, one})) ==
        "duet: sample 1: quaternion (1.1, 0, 0, 0) has norm 1.1, not 1");
  CHECK(message_of<duet::invalid_sample>(make({one, one, quaternion(), one})) ==
        "duet: sample 2: quaternion (0, 0, 0, 0) has norm 0, not 1");
  CHECK(message_of<duet::invalid_sample>(make({one, one, one, {0, not_a_number, 0, 1}})) ==
        "duet: sample 3: quaternion (0, nan, 0, 1) is not finite");
  CHECK(message_of<duet::invalid_sample>(make({one, {0, 0.6, 0.8, 0}, one, one})) ==
        "duet: sample 1: half a turn from the sample before: both arcs are equally short");
  // A norm that differs from 1 by the rounding of a printed table is normalised.
  const spline s(knots, {one * 1.0004, one, one, one});
  CHECK(s.control_points()[0] == one);
}

} // namespace
} // namespace test_spline_curve
