// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curve_jacobians.hpp"

#include <duet/duet.hpp>

namespace test_spline_motion_jacobian_poses {

using duet::perturbation;
using duet_test::compare_blocks;
using duet_test::jacobian_errors;
using screw = duet::screw_dual<double>;

namespace {

const std::array steps{0.0, 1e-12, 1e-6, 0.01, 0.7, 2.5, duet::constant::pi<double>() - 1e-9};

template <int Order>
void compare_order(jacobian_errors& errors, std::size_t every) {
  std::size_t count = 0;
  for (const auto& [name, knots] : duet_test::knot_vectors(Order)) {
    for (const double u : duet_test::parameters_on(knots, Order, 1)) {
      if (++count % every != 0) {
        continue;
      }
      const std::size_t k = count / every;
      const double step = steps[k % steps.size()];
      const auto s = duet_test::curve_of_steps<screw, Order>(knots, step, count);
      const std::string text =
          "poses, order " + std::to_string(Order) + ", " + name + ", step " + std::to_string(step);
      const perturbation side = k % 2 == 0 ? perturbation::left : perturbation::right;
      if (k % 3 == 0) {
        compare_blocks(errors, text, s, u, duet::frame::body, side);
      } else if (k % 3 == 1) {
        compare_blocks(errors, text, s, u, duet::frame::spatial, side);
      } else {
        compare_blocks(errors, text, s, u, duet::frame::hybrid, side);
      }
    }
  }
}

} // namespace

TEST_CASE("motion_jacobian: blocks of poses agree with 50 digits, orders 2 to 6") {
  jacobian_errors errors;
  compare_order<2>(errors, 3);
  compare_order<3>(errors, 6);
  compare_order<4>(errors, 3);
  compare_order<5>(errors, 6);
  compare_order<6>(errors, 6);
  CHECK_MESSAGE(errors.within(5e-14), errors);
}

TEST_CASE("motion_jacobian: blocks of poses have the sums of a motion of all control points") {
  const auto knots = duet_test::knot_vectors(4)[1].knots;
  const auto s = duet_test::curve_of_steps<screw, 4>(knots, 0.9, 3);
  for (const double u : duet_test::parameters_on(knots, 4)) {
    const auto m = s.motion_jacobian<3>(u, duet::frame::body);
    using matrix = duet::matrix6<double>;
    const auto sum = [](const auto& blocks) {
      return matrix(blocks.block(0) + blocks.block(1) + blocks.block(2) + blocks.block(3));
    };
    const auto is_close = [](const matrix& a, const matrix& b) {
      return (a - b).cwiseAbs().maxCoeff() <= 4e-14 * (1 + b.cwiseAbs().maxCoeff());
    };
    CHECK(is_close(sum(m.value), matrix::Identity()));
    CHECK(is_close(sum(m.velocity), duet::ad(m.motion.velocity)));
    CHECK(is_close(sum(m.acceleration), duet::ad(m.motion.acceleration)));
    CHECK(is_close(sum(m.jerk), duet::ad(m.motion.jerk)));
  }
}

TEST_CASE("motion_jacobian: derivatives of poses with respect to u are those of motion") {
  const auto knots = duet_test::knot_vectors(4)[1].knots;
  const auto s = duet_test::curve_of_steps<screw, 4>(knots, 0.9, 3);
  const auto compare = [&](auto frame) {
    for (const double u : duet_test::parameters_on(knots, 4, 2)) {
      const auto m = s.motion_jacobian<3>(u, frame, perturbation::left);
      const auto at = s.motion(u, frame);
      const auto moved = s.motion(duet::dual<double>::variable(u), frame);
      const auto is_close = [&](const auto& a, const auto& b) {
        return (a - b).norm() <= 1e-12 * (1 + b.norm());
      };
      duet::vector6<double> snap;
      for (int i = 0; i < 6; ++i) {
        snap[i] = moved.jerk[i].epsilon();
      }
      CHECK(is_close(m.motion.velocity, at.velocity));
      CHECK(is_close(m.motion.jerk, at.jerk));
      CHECK(is_close(m.parameter_derivative.value, s.motion(u, duet::frame::spatial).velocity));
      CHECK(is_close(m.parameter_derivative.acceleration, at.jerk));
      CHECK(is_close(m.parameter_derivative.jerk, snap));
    }
  };
  compare(duet::frame::body);
  compare(duet::frame::spatial);
  compare(duet::frame::hybrid);
}

} // namespace test_spline_motion_jacobian_poses
