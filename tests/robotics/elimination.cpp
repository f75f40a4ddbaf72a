// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../src/robotics/branches/elimination.hpp"
#include "../../src/robotics/branches/loop_equation.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <complex>

namespace test_robotics_elimination {
namespace {

using duet::detail::loop_equation;
using duet::detail::six_coordinates;

duet::detail::three_vector<double> random_vector(duet_test::random_source& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

/// Loop with random axes that is closed at θ.
loop_equation closed_at(const six_coordinates& theta, const std::vector<std::size_t>& prismatic,
                        duet_test::random_source& random) {
  loop_equation loop;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto n = random.direction<3>();
    loop.joints[i] = {true, {n[0], n[1], n[2]}, random_vector(random)};
  }
  for (const std::size_t i : prismatic) {
    loop.joints[i].is_revolute = false;
  }
  loop.closing = duet::detail::product_of_joints(loop, theta, 0, 6);
  return loop;
}

double difference(const loop_equation& loop, const six_coordinates& a, const six_coordinates& b) {
  double largest = 0;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double d = a[i] - b[i];
    const bool is_revolute = loop.joints[std::size_t(i)].is_revolute;
    largest =
        std::max(largest, std::abs(is_revolute ? std::remainder(d, 2 * std::numbers::pi) : d));
  }
  return largest;
}

/// Elimination is tested alone, because Newton's method and other orders of the joints would hide
/// wrong initial guesses.
TEST_CASE(
    "elimination: the determinant vanishes at the angle of a solution, and all coordinates of the "
    "solution result from it") {
  duet_test::random_source random(1);
  for (const std::vector<std::size_t>& prismatic :
       {std::vector<std::size_t>{}, {0}, {1}, {3}, {4}}) {
    CAPTURE(prismatic.empty() ? -1 : int(prismatic[0]));
    for (int k = 0; k < 20; ++k) {
      six_coordinates theta;
      for (double& x : theta) {
        x = random.uniform(-1.5, 1.5);
      }
      const loop_equation loop = closed_at(theta, prismatic, random);
      const duet::detail::elimination system(loop);
      double nearest = std::numeric_limits<double>::infinity();
      system.solution_at(theta[2], [&](const six_coordinates& x) {
        nearest = std::min(nearest, difference(loop, x, theta));
      });
      CHECK(nearest < 1e-5);
      double nearest_zero = std::numeric_limits<double>::infinity();
      for (const std::complex<double>& zero : system.roots().values) {
        nearest_zero = std::min(nearest_zero, std::abs(zero - std::polar(1., theta[2])));
      }
      CHECK(nearest_zero < 1e-7);
    }
  }
}

} // namespace
} // namespace test_robotics_elimination
