// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curve_jacobians.hpp"

#include <duet/duet.hpp>

namespace test_spline_motion_jacobian {

using duet::perturbation;
using duet_test::compare_blocks;
using duet_test::jacobian_errors;

namespace {

const double almost_pi = duet::constant::pi<double>() - 1e-9;
const std::array steps{0.0, 1e-12, 1e-6, 0.01, 0.7, 2.5, almost_pi};

/// All kinds of knots, all steps between control points, both ends and the inside of all spans.
template <int Order>
void compare_order(jacobian_errors& errors) {
  std::size_t count = 0;
  for (const auto& [name, knots] : duet_test::knot_vectors(Order)) {
    // Each parameter with another step; all of them are met several times.
    for (const double u : duet_test::parameters_on(knots, Order, 1)) {
      const double step = steps[count++ % steps.size()];
      const auto s = duet_test::curve_of_steps<double, Order>(knots, step, count);
      const std::string text =
          "order " + std::to_string(Order) + ", " + name + ", step " + std::to_string(step);
      const perturbation side = count % 3 == 0 ? perturbation::left : perturbation::right;
      if (count % 2 == 0) {
        compare_blocks(errors, text, s, u, duet::frame::body, side);
      } else {
        compare_blocks(errors, text, s, u, duet::frame::spatial, side);
      }
    }
  }
}

} // namespace

TEST_CASE("motion_jacobian: blocks of rotations agree with 50 digits, orders 2 to 6") {
  jacobian_errors errors;
  compare_order<2>(errors);
  compare_order<3>(errors);
  compare_order<4>(errors);
  compare_order<5>(errors);
  compare_order<6>(errors);
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

TEST_CASE("motion_jacobian: blocks have the sums of a rotation of all control points") {
  for (const auto& [name, knots] : duet_test::knot_vectors(4)) {
    const auto s = duet_test::curve_of_steps<double, 4>(knots, 0.9, 3);
    for (const double u : duet_test::parameters_on(knots, 4)) {
      const auto m = s.motion_jacobian<3>(u, duet::frame::body);
      const auto sum = [](const auto& blocks) {
        return duet::matrix3<double>(blocks.block(0) + blocks.block(1) + blocks.block(2) +
                                     blocks.block(3));
      };
      const auto is_close = [](const duet::matrix3<double>& a, const duet::matrix3<double>& b) {
        return (a - b).cwiseAbs().maxCoeff() <= 4e-14 * (1 + b.cwiseAbs().maxCoeff());
      };
      const auto skew = [](const duet::vector3<double>& v) {
        return duet::detail::matrix_of(duet::detail::skew_rows(duet::detail::components(v)));
      };
      CHECK(is_close(sum(m.value), duet::matrix3<double>::Identity()));
      CHECK(is_close(sum(m.velocity), skew(m.motion.velocity)));
      CHECK(is_close(sum(m.acceleration), skew(m.motion.acceleration)));
      CHECK(is_close(sum(m.jerk), skew(m.motion.jerk)));
    }
  }
}

TEST_CASE("motion_jacobian: motion and derivatives with respect to u are those of motion") {
  const auto knots = duet_test::knot_vectors(5)[1].knots;
  const auto s = duet_test::curve_of_steps<double, 5>(knots, 0.9, 3);
  using number = duet::dual<double>;
  const auto compare = [&](auto frame) {
    for (const double u : duet_test::parameters_on(knots, 5, 2)) {
      const auto right = s.motion_jacobian<3>(u, frame);
      const auto left = s.motion_jacobian<0>(u, frame, perturbation::left);
      const auto m = s.motion(u, frame);
      const auto moved = s.motion(number::variable(u), frame);
      const auto close = [&](const auto& a, const auto& b) {
        return (a - b).norm() <= 1e-12 * (1 + b.norm());
      };
      CHECK(duet_test::max_abs_difference(right.motion.value, m.value) <= 1e-15);
      CHECK(close(right.motion.velocity, m.velocity));
      CHECK(close(right.motion.acceleration, m.acceleration));
      CHECK(close(right.motion.jerk, m.jerk));
      CHECK(close(left.motion.jerk, m.jerk));
      CHECK(close(right.parameter_derivative.value, s.motion(u, duet::frame::body).velocity));
      CHECK(close(left.parameter_derivative.value, s.motion(u, duet::frame::spatial).velocity));
      CHECK(close(right.parameter_derivative.velocity, m.acceleration));
      CHECK(close(right.parameter_derivative.acceleration, m.jerk));
      const auto slope = [](const auto& x) {
        return duet::vector3<double>(x[0].epsilon(), x[1].epsilon(), x[2].epsilon());
      };
      CHECK(close(right.parameter_derivative.jerk, slope(moved.jerk)));
    }
  };
  compare(duet::frame::body);
  compare(duet::frame::spatial);
}

TEST_CASE("motion_jacobian: beyond an end where the curve is at rest, rates have zero Jacobians") {
  const auto knots = duet_test::knot_vectors(4)[3].knots;
  auto s = duet_test::curve_of_steps<double, 4>(knots, 0.9, 3);
  CHECK_THROWS_AS(static_cast<void>(s.motion_jacobian<1>(-9.0, duet::frame::body)),
                  duet::invalid_input);
  s.set_out_of_domain(duet::out_of_domain::clamp);
  const auto m = s.motion_jacobian<2>(-9.0, duet::frame::body);
  CHECK(m.first == 0);
  CHECK(m.value.block(0).isIdentity(1e-15));
  CHECK(m.velocity.matrix().isZero(0));
  CHECK(m.acceleration.matrix().isZero(0));
  CHECK(m.parameter_derivative.value.isZero(0));
  CHECK(m.motion.velocity.isZero(0));
}

} // namespace test_spline_motion_jacobian
