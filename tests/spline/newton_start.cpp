// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/duet.hpp>

namespace test_spline_newton_start {
namespace {

using vector3 = duet::vector3<double>;
using cumulative = duet::cumulative_bspline<double>;
template <int Order>
using rotation_vector = duet::rotation_vector_spline<double, Order>;

struct samples {
  std::vector<double> parameters;
  std::vector<duet::quaternion<double>> orientations;
};

/// A smooth motion that ends where it began, in steps of less than 0.024 rad.
samples small_steps() {
  constexpr int count = 400;
  samples result;
  for (int i = 0; i <= count; ++i) {
    const double u = 2 * std::numbers::pi * i / count;
    result.parameters.push_back(u);
    result.orientations.push_back(duet::from_euler<duet::zyx>(
        .8 * std::sin(u), .5 * std::cos(2 * u), .3 * std::sin(3 * u + 1)));
  }
  return result;
}

/// Distance of the initial guess of Newton's method from the solution, relative to the largest
/// unknown, and the number of iterations.
struct newton_run {
  double distance;
  int iterations;
};
template <class Spline, class Ends>
newton_run run_newton(const samples& data, const Ends& ends) {
  const duet::detail::equations_of_t<Spline> f(data.parameters, data.orientations,
                                               duet::curve_ends<double>(ends));
  const duet::detail::spline_newton newton(f);
  const auto start = f.start();
  double difference = 0, size = 0;
  for (std::size_t k = 0; k < start.size(); ++k) {
    difference = std::max(difference, (start[k] - newton.solution()[k]).norm());
    size = std::max(size, newton.solution()[k].norm());
  }
  return {difference / size, newton.iterations()};
}

/// \param max  bounds on distance and iterations, for all end conditions
template <class Spline>
void check_all_ends(const newton_run& max) {
  const samples data = small_steps();
  const auto free = duet::interpolate<Spline>(data.parameters, data.orientations);
  const auto first = free.motion(data.parameters.front(), duet::frame::spatial);
  const auto last = free.motion(data.parameters.back(), duet::frame::spatial);
  const auto check = [&](const char* name, const auto& ends) {
    CAPTURE(name);
    const newton_run result = run_newton<Spline>(data, ends);
    CHECK(result.distance <= max.distance);
    CHECK(result.iterations <= max.iterations);
  };
  check("natural", duet::natural{});
  check("clamped", duet::clamped{first.velocity, last.velocity});
  check("end_acceleration", duet::end_acceleration{first.acceleration, last.acceleration});
  check("not_a_knot", duet::not_a_knot{});
  check("periodic", duet::periodic{});
}

/// Largest error of the Jacobian, applied to central differences of the residuals, which should
/// give the unit vectors; at unknowns perturbed by `perturbation` from the solution.
template <class Spline>
double error_of_jacobian(const samples& data, const duet::curve_ends<double>& ends,
                         double perturbation) {
  const duet::detail::equations_of_t<Spline> f(data.parameters, data.orientations, ends);
  auto x = duet::detail::spline_newton(f).solution();
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (int k = 0; k < x[i].size(); ++k) {
      x[i][k] += perturbation * std::sin(3. * k + double(i));
    }
  }
  typename duet::detail::equations_of_t<Spline>::matrix jacobian;
  auto above = x, below = x;
  REQUIRE(f.linearise(x, above, jacobian));
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (int k = 0; k < x[i].size(); ++k) {
      auto moved = x;
      moved[i][k] = x[i][k] + 1e-5;
      f.residuals(moved, above);
      moved[i][k] = x[i][k] - 1e-5;
      f.residuals(moved, below);
      for (std::size_t j = 0; j < x.size(); ++j) {
        above[j] = (above[j] - below[j]) / 2e-5;
      }
      jacobian.solve(above);
      above[i][k] -= 1;
      for (const auto& each : above) {
        worst = std::max(worst, each.norm());
      }
    }
  }
  return worst;
}

template <class Spline>
void check_jacobians(double perturbation, double tolerance) {
  samples data;
  for (int i = 0; i <= 7; ++i) {
    data.parameters.push_back(i + .3 * std::sin(2. * i));
    data.orientations.push_back(
        duet::exp(vector3(.9 * std::sin(i), .8 * std::cos(1.3 * i), .5 * std::sin(.7 * i + 1))));
  }
  data.orientations = duet::align_quaternion_signs(data.orientations);
  const vector3 v(.3, -.2, .5), w(.1, .4, -.2);
  const auto check = [&](const char* name, const duet::curve_ends<double>& ends) {
    CAPTURE(name);
    CHECK(error_of_jacobian<Spline>(data, ends, perturbation) < tolerance);
  };
  check("natural", duet::natural{});
  check("clamped", duet::clamped{v, w});
  check("end_acceleration", duet::end_acceleration{v, w});
  check("not_a_knot", duet::not_a_knot{});
  if constexpr (Spline::order == 6) {
    check("fully_clamped", duet::fully_clamped{duet::clamped{v, w}, duet::end_acceleration{w, v}});
  }
  data.orientations.back() = data.orientations.front();
  data.orientations = duet::align_quaternion_signs(data.orientations);
  check("periodic", duet::periodic{});
}

TEST_CASE("interpolate: Jacobians of the equations agree with central differences") {
  check_jacobians<cumulative>(0, 1e-8); // off the solution it is exact only along Newton steps
  check_jacobians<rotation_vector<4>>(.1, 1e-8);
  check_jacobians<rotation_vector<6>>(.1, 1e-4);
}

TEST_CASE("relative_step: NaN in any component gives NaN") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(duet::detail::larger_or_nan(1.0, 2.0) == 2);
  CHECK(duet::detail::larger_or_nan(2.0, 1.0) == 2);
  CHECK(std::isnan(duet::detail::larger_or_nan(nan, 1.0)));
  CHECK(std::isnan(duet::detail::larger_or_nan(1.0, nan)));
  const auto check = [&]<class Spline>(std::type_identity<Spline>) {
    const samples data = small_steps();
    const duet::detail::equations_of_t<Spline> f(
        data.parameters, data.orientations,
        duet::curve_ends<double>(duet::detail::end_condition_kind::natural));
    auto change = f.start();
    change[change.size() / 2][0] = nan;
    CHECK(std::isnan(f.relative_step(f.start(), change)));
  };
  check(std::type_identity<cumulative>{});
  check(std::type_identity<rotation_vector<4>>{});
  check(std::type_identity<rotation_vector<6>>{});
}

} // namespace
} // namespace test_spline_newton_start
