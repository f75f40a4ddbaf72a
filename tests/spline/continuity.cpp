// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

namespace test_spline_continuity {
namespace {

using duet::cumulative_bspline;
using duet_test::max_abs_difference;
using duet_test::random_orientations;

constexpr double knot = 1.2;
const double just_before = std::nextafter(knot, 0);

/// Curve with the knot of the given multiplicity and simple knots otherwise.
template <int Order>
cumulative_bspline<double, Order> curve_with(int times) {
  std::vector<double> knots;
  for (int i = Order; i > 0; --i) {
    knots.push_back(0.9 - 0.3 * i);
  }
  knots.insert(knots.end(), std::size_t(times), knot);
  for (int i = 0; i < Order; ++i) {
    knots.push_back(1.6 + 0.5 * i);
  }
  return {knots, random_orientations(knots.size() - std::size_t(Order), 1.2)};
}

template <int Order>
void check_order() {
  for (int times = 1; times <= std::min(Order, 3); ++times) {
    CAPTURE(Order);
    CAPTURE(times);
    const auto s = curve_with<Order>(times);
    REQUIRE(s.basis().find_span(just_before) + 1 == s.basis().find_span(knot));
    const auto curve = [&](const auto& u) { return s(u); };
    const auto left = duet::derivatives<Order - 1>(curve, just_before);
    const auto right = duet::derivatives<Order - 1>(curve, knot);
    for (int d = 0; d < Order; ++d) {
      CAPTURE(d);
      const auto k = std::size_t(d);
      const double size =
          std::max(std::sqrt(squared_norm(left[k])), std::sqrt(squared_norm(right[k])));
      const double jump = max_abs_difference(left[k], right[k]) / size;
      if (d <= Order - 1 - times) {
        CHECK(jump < 1e-11);
      } else {
        CHECK(jump > 1e-3); // the next derivative jumps, so that the test is significant
      }
    }
  }
}

TEST_CASE("P1: the curve is C^{k−2} at simple knots, with one order less for every repetition") {
  check_order<2>();
  check_order<3>();
  check_order<4>();
  check_order<5>();
  check_order<6>();
}

TEST_CASE(
    "P3, P4: rates of the cubic at a knot are continuous up to the order of its multiplicity") {
  const auto frames = [](auto frame) {
    for (int times = 1; times <= 3; ++times) {
      CAPTURE(times);
      const auto s = curve_with<4>(times);
      const auto left = s.motion(just_before, frame);
      const auto right = s.motion(knot, frame);
      CHECK(max_abs_difference(left.value, right.value) < 1e-14);
      const double velocity = (left.velocity - right.velocity).norm() / left.velocity.norm();
      const double acceleration =
          (left.acceleration - right.acceleration).norm() / left.acceleration.norm();
      const double jerk = (left.jerk - right.jerk).norm() / left.jerk.norm();
      CHECK((velocity < 1e-12) == (times <= 2));
      CHECK((acceleration < 1e-12) == (times <= 1));
      CHECK(jerk > 0.01);
      CHECK((times <= 2 || velocity > 0.01));
      CHECK((times <= 1 || acceleration > 0.01));
    }
  };
  frames(duet::frame::body);
  frames(duet::frame::spatial);
}

} // namespace
} // namespace test_spline_continuity
