// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/expression/graph/evaluate.hpp>
#include <duet/spline/curve_formula.hpp>

#include <Eigen/Core>

namespace test_spline_curve_formula {
namespace {

/// Uneven parameters, steps of 0 and of more than a half turn among them.
const std::vector<double> parameters{0, 1, 2.5, 3, 4.2, 5};

duet::quaternion<double> rotation_at(std::size_t i) {
  const double x = i == 3 ? 2 : double(i);
  return duet::exp(duet::vector3<double>(.9 * x, .1 * x * x, -.2 * x));
}

template <class Curve, class F>
void check(const Curve& curve, F frame) {
  double error = 0;
  for (std::size_t span = 0; span + 1 < curve.breaks().size(); ++span) {
    const auto f = duet::formula_of(curve, span, frame);
    for (const double x : {0.0, 1e-9, 0.3, 0.99}) {
      const double u = curve.breaks()[span] + x * (curve.breaks()[span + 1] - curve.breaks()[span]);
      const auto values = evaluate(f, std::vector<double>{u});
      const auto m = curve.motion(u, frame);
      std::vector<double> expected;
      duet::expression::detail::for_each_number(m.value, [&](double s) { expected.push_back(s); });
      for (const auto* rate : {&m.velocity, &m.acceleration, &m.jerk}) {
        expected.insert(expected.end(), rate->data(), rate->data() + rate->size());
      }
      REQUIRE(values.size() == expected.size());
      for (std::size_t i = 0; i < values.size(); ++i) {
        error = std::max(error, std::abs(values[i] - expected[i]) / (1 + std::abs(expected[i])));
      }
    }
  }
  CHECK(error < 1e-14);
}

TEST_CASE("formula_of a curve: the motion on each span of rotations and poses") {
  std::vector<duet::quaternion<double>> rotations;
  std::vector<duet::dual_quaternion<double>> poses;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    rotations.push_back(rotation_at(i));
    poses.push_back(
        duet::pose(rotation_at(i), duet::vector3<double>(double(i), 1, -.5 * double(i))));
  }
  const auto of_rotations =
      duet::interpolate<duet::cumulative_bspline<double>>(parameters, rotations);
  check(of_rotations, duet::frame::body);
  check(of_rotations, duet::frame::spatial);
  const auto of_poses =
      duet::interpolate<duet::cumulative_bspline<duet::screw_dual<double>>>(parameters, poses);
  check(of_poses, duet::frame::body);
  check(of_poses, duet::frame::hybrid);
  const std::string message = duet_test::message_of<duet::invalid_input>(
      [&] { (void)duet::formula_of(of_poses, 5, duet::frame::body); });
  CHECK(message.find("span 5 does not exist, the curve has 5 spans") != std::string::npos);
  CHECK_THROWS_AS(
      (void)duet::formula_of(of_poses, std::numeric_limits<std::size_t>::max(), duet::frame::body),
      duet::invalid_input);
}

} // namespace
} // namespace test_spline_curve_formula
