// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/mixed_arguments.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

namespace test_spline_mixed_arguments {

using namespace test_support::mixed;

TEST_CASE("curves accept arguments of which some are constants and some have derivatives") {
  const std::vector<double> times{0, 1, 2.5, 3};
  const std::vector<quaternion<double>> rotations{p, q, r, s};
  const std::vector<dual_quaternion<double>> poses{A, A * B, B, pose(r, v)};
  check(
      "interpolate, clamped",
      [&](const auto& samples, const auto& start) {
        using D = promote_t<typename std::decay_t<decltype(samples[0])>::scalar_type,
                            typename std::decay_t<decltype(start)>::Scalar>;
        return interpolate<rotation_vector_spline<D>>(times, samples, clamped{start, start})(1.3);
      },
      rotations, u);
  check(
      "interpolate, poses",
      [&](const auto& samples, const auto& start) {
        using D = promote_t<typename std::decay_t<decltype(samples[0])>::scalar_type,
                            typename std::decay_t<decltype(start)>::Scalar>;
        return interpolate<cumulative_bspline<D>>(times, samples, clamped{start, start})(1.3);
      },
      poses, xi);
  check(
      "hermite_spline",
      [&](const auto& samples, const auto& velocity) {
        return hermite_spline(times, samples, std::vector(4, velocity), frame::body)(1.3);
      },
      rotations, u);
  check(
      "hermite_spline of poses",
      [&](const auto& samples, const auto& velocity) {
        return hermite_spline(times, samples, std::vector(4, velocity), frame::spatial)(1.3);
      },
      poses, xi);
  check(
      "a curve at a parameter",
      [&](const auto& samples, const auto& at) {
        using D = typename std::decay_t<decltype(samples[0])>::scalar_type;
        const auto m =
            interpolate<rotation_vector_spline<D>>(times, samples).motion(at, frame::body);
        return std::tuple(m.value, m.velocity, m.acceleration, m.jerk);
      },
      rotations, 1.3);
  check(
      "apply_time_scaling",
      [&](const auto& samples, const auto& du, const auto& ddu, const auto& dddu) {
        using D = typename std::decay_t<decltype(samples[0])>::scalar_type;
        const auto m = apply_time_scaling(
            interpolate<cumulative_bspline<D>>(times, samples).motion(1.3, frame::body), du, ddu,
            dddu);
        return std::tuple(m.value, m.velocity, m.acceleration, m.jerk);
      },
      rotations, 0.4, 0.3, -0.2);
}

} // namespace test_spline_mixed_arguments
