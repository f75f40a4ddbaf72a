// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/lanes.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

namespace test_spline_batch {
namespace {

using namespace duet;
using duet_test::check_lanes;

constexpr double limit = 16;

template <class Spline>
Spline some_spline() {
  duet_test::random_source random(2);
  std::vector<double> u;
  std::vector<quaternion<double>> samples;
  for (int i = 0; i <= 12; ++i) {
    u.push_back(i + 0.3 * std::sin(i));
    // Steps of up to half a turn use both the series and the closed form of exp.
    samples.push_back(from_rotation_vector(vector3<double>(
        random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5))));
  }
  return interpolate<Spline>(u, samples, natural{});
}

TEST_CASE_TEMPLATE("curves of rotations over batches: lanes on different spans, at knots and "
                   "beyond the ends agree with single parameters",
                   Spline, cumulative_bspline<double>, rotation_vector_spline<double>) {
  auto s = some_spline<Spline>();
  const std::vector<double> inside{0, 3.3, 3.3, 12 + 0.3 * std::sin(12), 1 + 0.3 * std::sin(1),
                                   7, 5.5};
  const auto value = [&](const auto& u) { return s(u); };
  const auto velocity = [&](const auto& u) { return s.motion(u, frame::body).velocity; };
  const auto jerk = [&](const auto& u) { return s.motion(u, frame::spatial).jerk; };
  check_lanes<4>(value, limit, inside);
  check_lanes<4>(velocity, limit, inside);
  check_lanes<4>(jerk, 4 * limit, inside);
  check_lanes<4>(value, limit, std::vector<dual<double>>{{0.5, 1}, {3.1, 2}, {11, -1}});

  const std::vector<double> all{-0.5, 3.3, 13, 0.2};
  CHECK_THROWS_AS(check_lanes<4>(value, limit, all), invalid_input);
  for (const auto behaviour : {out_of_domain::clamp, out_of_domain::extrapolate}) {
    s.set_out_of_domain(behaviour);
    check_lanes<4>(value, limit, all);
    check_lanes<4>(velocity, limit, all);
  }
}

TEST_CASE(
    "curves of poses over batches: values, rates and derivatives agree with single parameters") {
  duet_test::random_source random(6);
  std::vector<double> u;
  std::vector<dual_quaternion<double>> samples;
  std::vector<vector6<double>> velocities;
  const auto number = [&] { return random.uniform(-1, 1); };
  for (int i = 0; i <= 8; ++i) {
    u.push_back(i + 0.2 * std::sin(i));
    const vector3<double> angles(number(), number(), i == 3 ? 0 : number());
    samples.push_back(pose(from_rotation_vector(angles), vector3<double>(number(), number(), i)));
    velocities.push_back(vector6<double>::Constant(i == 4 ? 0 : number()));
  }
  const std::vector<double> at{0, 2.3, u[3], 8 + 0.2 * std::sin(8), u[4], 5.5, 1e-9};
  const auto check = [&](const auto& s) {
    check_lanes<4>([&](const auto& x) { return s(x); }, limit, at);
    check_lanes<8>([&](const auto& x) { return s(x); }, limit, at);
    check_lanes<4>([&](const auto& x) { return s.motion(x, frame::hybrid).acceleration; },
                   4 * limit, at);
    check_lanes<4>([&](const auto& x) { return s.derivatives(x); }, 4 * limit, at);
  };
  check(interpolate<cumulative_bspline<screw_dual<double>>>(u, samples, natural{}));
  check(hermite_spline(u, samples, velocities, frame::body));
}

} // namespace
} // namespace test_spline_batch
