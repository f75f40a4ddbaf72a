// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curve_jacobians.hpp"

namespace test_spline_motion_jacobian {
namespace {

using duet::perturbation;
using duet_test::compare_blocks;
using duet_test::is_pose;
using duet_test::jacobian_errors;
using screw = duet::screw_dual<double>;

const double almost_pi = duet::constant::pi<double>() - 1e-9;
const std::array steps{0.0, 1e-12, 1e-6, 0.01, 0.7, 2.5, almost_pi};

/// All kinds of knots, all steps between control points, both ends and the inside of all spans, of
/// which only one in `every` is taken.
template <class T, int Order>
void compare_order(jacobian_errors& errors, std::size_t every) {
  std::size_t count = 0;
  for (const auto& [name, knots] : duet_test::knot_vectors(Order)) {
    for (const double u : duet_test::parameters_on(knots, Order, 1)) {
      if (++count % every != 0) {
        continue;
      }
      const std::size_t k = count / every;
      const double step = steps[k % steps.size()];
      const auto s = duet_test::curve_of_steps<T, Order>(knots, step, count);
      const std::string text =
          "order " + std::to_string(Order) + ", " + name + ", step " + std::to_string(step);
      const perturbation side = k / 2 % 2 == 0 ? perturbation::left : perturbation::right;
      if (k % 3 == 0) {
        compare_blocks(errors, text, s, u, duet::frame::body, side);
      } else if (k % 3 == 1 || !is_pose<T>) {
        compare_blocks(errors, text, s, u, duet::frame::spatial, side);
      } else if constexpr (is_pose<T>) {
        compare_blocks(errors, text, s, u, duet::frame::hybrid, side);
      }
    }
  }
}

TEST_CASE_TEMPLATE("motion_jacobian: blocks agree with 50 digits, orders 2 to 6", T, double,
                   screw) {
  constexpr std::size_t every = is_pose<T> ? 6 : 3;
  jacobian_errors errors;
  compare_order<T, 2>(errors, every);
  compare_order<T, 3>(errors, 2 * every);
  compare_order<T, 4>(errors, every);
  compare_order<T, 5>(errors, 2 * every);
  compare_order<T, 6>(errors, 2 * every);
  CHECK_MESSAGE(errors.within(5e-14), errors);
}

TEST_CASE("motion_jacobian: blocks of the long way round agree with 50 digits") {
  jacobian_errors errors;
  const auto [name, knots] = duet_test::knot_vectors(4)[1];
  for (const double step : {3.5, 4.8, 6.2}) {
    const auto s = duet_test::curve_of_steps<double, 4>(knots, step, 5);
    for (const double u : duet_test::parameters_on(knots, 4, 1)) {
      compare_blocks(errors, name, s, u, duet::frame::body, perturbation::right);
    }
  }
  CHECK_MESSAGE(errors.within(2e-12), errors);
}

TEST_CASE_TEMPLATE("motion_jacobian: motion and derivatives with respect to u are those of motion",
                   T, double, screw) {
  const auto knots = duet_test::knot_vectors(5)[1].knots;
  const auto s = duet_test::curve_of_steps<T, 5>(knots, 0.9, 3);
  const auto compare = [&](auto frame) {
    for (const double u : duet_test::parameters_on(knots, 5, 2)) {
      const auto right = s.template motion_jacobian<3>(u, frame);
      const auto left = s.template motion_jacobian<0>(u, frame, perturbation::left);
      const auto m = s.motion(u, frame);
      const auto moved = s.motion(duet::dual<double>::variable(u), frame);
      const auto is_close = [&](const auto& a, const auto& b) {
        return (a - b).norm() <= 1e-12 * (1 + b.norm());
      };
      auto snap = (0 * m.jerk).eval();
      for (Eigen::Index i = 0; i < snap.size(); ++i) {
        snap[i] = moved.jerk[i].epsilon();
      }
      CHECK(right.motion.value == left.motion.value);
      CHECK(is_close(right.motion.velocity, m.velocity));
      CHECK(is_close(right.motion.acceleration, m.acceleration));
      CHECK(is_close(right.motion.jerk, m.jerk));
      CHECK(is_close(left.motion.jerk, m.jerk));
      CHECK(is_close(right.parameter_derivative.value, s.motion(u, duet::frame::body).velocity));
      CHECK(is_close(left.parameter_derivative.value, s.motion(u, duet::frame::spatial).velocity));
      CHECK(is_close(right.parameter_derivative.velocity, m.acceleration));
      CHECK(is_close(right.parameter_derivative.acceleration, m.jerk));
      CHECK(is_close(right.parameter_derivative.jerk, snap));
    }
  };
  compare(duet::frame::body);
  compare(duet::frame::spatial);
  if constexpr (is_pose<T>) {
    compare(duet::frame::hybrid);
  }
}

TEST_CASE("motion_jacobian: beyond an end where the curve is at rest, rates have zero Jacobians") {
  const auto knots = duet_test::knot_vectors(4)[3].knots;
  auto s = duet_test::curve_of_steps<double, 4>(knots, 0.9, 3);
  CHECK_THROWS_AS((void)s.motion_jacobian<1>(-9.0, duet::frame::body), duet::invalid_input);
  s.set_out_of_domain(duet::out_of_domain::clamp);
  const auto m = s.motion_jacobian<2>(-9.0, duet::frame::body);
  CHECK(m.first == 0);
  CHECK(m.value.block(0).isIdentity(1e-15));
  CHECK(m.velocity.matrix().isZero(0));
  CHECK(m.acceleration.matrix().isZero(0));
  CHECK(m.parameter_derivative.value.isZero(0));
  CHECK(m.motion.velocity.isZero(0));
}

} // namespace
} // namespace test_spline_motion_jacobian
