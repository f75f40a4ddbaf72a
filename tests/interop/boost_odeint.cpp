// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/dual/eigen_traits.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/interop/boost_odeint.hpp>
#include <duet/quaternion/rate.hpp>
#include <duet/quaternion/rotation.hpp>

#include <boost/numeric/odeint/external/eigen/eigen.hpp>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/integrate/integrate_const.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

// Sensitivities of a pendulum's motion, ẍ = −p sin x, to p and to its initial angle: by states of
// dual numbers, against the variational equations.

namespace test_interop_boost_odeint {
namespace {

namespace odeint = boost::numeric::odeint;
using D = duet::dual<double, 2>; // ∂/∂p, ∂/∂x₀

constexpr double stiffness = 2;
constexpr double start = 0.7;
constexpr double end = 3;
constexpr double step = 0.01;

template <class P>
auto pendulum(const P& p) {
  return [p](const auto& x, auto& dx, double) {
    using std::sin;
    dx[0] = x[1];
    dx[1] = -p * sin(x[0]);
  };
}

/// x, v and their derivatives with respect to p and x₀, as six equations of plain numbers.
using extended = std::array<double, 6>;
void variational(const extended& y, extended& dy, double) {
  const double s = std::sin(y[0]);
  const double pc = stiffness * std::cos(y[0]);
  dy = {y[1], -stiffness * s, y[3], -s - pc * y[2], y[5], -pc * y[4]};
}
constexpr extended extended_start{start, 0, 0, 0, 1, 0};

template <class State>
State dual_start() {
  State x = [] {
    if constexpr (
        requires { State(2); } && !requires { typename State::Scalar; }) {
      return State(2);
    } else {
      return State();
    }
  }();
  x[0] = D::variable(start, 1);
  x[1] = D(0);
  return x;
}

template <class State>
void check(const State& x, const extended& exact, double tolerance) {
  for (int i = 0; i < 2; ++i) {
    CAPTURE(i);
    CHECK(std::abs(x[i].value() - exact[i]) <= tolerance);
    CHECK(std::abs(x[i].partial(0) - exact[2 + i]) <= tolerance);
    CHECK(std::abs(x[i].partial(1) - exact[4 + i]) <= tolerance);
  }
}

/// The same method and steps on the extended system are the same arithmetic except for rounding.
template <class Stepper, class State>
void check_constant_steps() {
  const auto p = D::variable(stiffness, 0);
  auto x = dual_start<State>();
  odeint::integrate_const(Stepper(), pendulum(p), x, 0.0, end, step);
  extended y = extended_start;
  odeint::integrate_const(odeint::runge_kutta4<extended>(), variational, y, 0.0, end, step);
  check(x, y, 1e-13);
}

template <class Stepper, class State>
void check_controlled_steps() {
  const double tolerance = 1e-10;
  const auto p = D::variable(stiffness, 0);
  auto x = dual_start<State>();
  const auto steps = odeint::integrate_adaptive(
      odeint::make_controlled<Stepper>(tolerance, tolerance), pendulum(p), x, 0.0, end, step);
  // The same number of steps and the same final state as with plain numbers.
  using plain = std::array<double, 2>;
  plain z{start, 0};
  const auto plain_steps = odeint::integrate_adaptive(
      odeint::make_controlled<odeint::runge_kutta_dopri5<plain>>(tolerance, tolerance),
      pendulum(stiffness), z, 0.0, end, step);
  CHECK(steps == plain_steps);
  CHECK(std::abs(x[0].value() - z[0]) <= 1e-13);
  CHECK(std::abs(x[1].value() - z[1]) <= 1e-13);
  // Reference: the variational equations, solved far more accurately.
  extended y = extended_start;
  odeint::integrate_adaptive(
      odeint::make_controlled<odeint::runge_kutta_dopri5<extended>>(1e-14, 1e-14), variational, y,
      0.0, end, step);
  check(x, y, 100 * tolerance);
}

using array_state = std::array<D, 2>;
using vector_state = std::vector<D>;
using eigen_state = Eigen::Matrix<D, 2, 1>;

TEST_CASE("runge_kutta4: constant steps give the sensitivities") {
  check_constant_steps<odeint::runge_kutta4<array_state>, array_state>();
  check_constant_steps<odeint::runge_kutta4<vector_state>, vector_state>();
  using odeint::range_algebra;
  using odeint::vector_space_algebra;
  check_constant_steps<
      odeint::runge_kutta4<eigen_state, double, eigen_state, double, vector_space_algebra>,
      eigen_state>();
  check_constant_steps<
      odeint::runge_kutta4<eigen_state, double, eigen_state, double, range_algebra>, eigen_state>();
}

TEST_CASE("runge_kutta4: rotations and poses are states with vector_space_algebra") {
  using odeint::vector_space_algebra;
  using rotation = duet::quaternion<D>;
  const duet::vector3<D> omega(D(0), D(0), D::variable(2, 0));
  rotation q(1);
  odeint::integrate_const(
      odeint::runge_kutta4<rotation, double, rotation, double, vector_space_algebra>(),
      [&](const rotation& at, rotation& rate, double) {
        rate = quaternion_rate(at, omega, duet::frame::body);
      },
      q, 0.0, 1.0, 1e-3);
  const auto vector = duet::rotation_vector(normalized(q));
  CHECK(std::abs(vector[2].value() - 2) <= 1e-12);
  CHECK(std::abs(vector[2].partial(0) - 1) <= 1e-12);

  using pose = duet::dual_quaternion<double>;
  pose a(1.0);
  const Eigen::Matrix<double, 6, 1> twist(1, 2, 3, 0, 0, 2);
  odeint::integrate_const(
      odeint::runge_kutta4<pose, double, pose, double, vector_space_algebra>(),
      [&](const pose& at, pose& rate, double) { rate = pose_rate(at, twist, duet::frame::hybrid); },
      a, 0.0, 1.0, 1e-3);
  a = normalized(a);
  CHECK((duet::translation(a) - Eigen::Vector3d(1, 2, 3)).norm() <= 1e-12);
  CHECK(std::abs(duet::rotation(a).z() - std::sin(1)) <= 1e-13);
}

TEST_CASE("runge_kutta_dopri5: step size control uses values only") {
  check_controlled_steps<odeint::runge_kutta_dopri5<array_state>, array_state>();
  check_controlled_steps<odeint::runge_kutta_dopri5<vector_state>, vector_state>();
  using stepper = odeint::runge_kutta_dopri5<eigen_state, double, eigen_state, double,
                                             odeint::vector_space_algebra>;
  check_controlled_steps<stepper, eigen_state>();
  using of_range =
      odeint::runge_kutta_dopri5<eigen_state, double, eigen_state, double, duet::odeint_algebra>;
  check_controlled_steps<of_range, eigen_state>();
}

TEST_CASE("runge_kutta_dopri5: large derivatives do not change the steps") {
  const auto steps_with = [](double slope) {
    array_state x{D(start), D(0)};
    x[0].set_partial(0, slope);
    return odeint::integrate_adaptive(
        odeint::make_controlled<odeint::runge_kutta_dopri5<array_state>>(1e-8, 1e-8),
        pendulum(D(stiffness)), x, 0.0, end, step);
  };
  CHECK(steps_with(1e6) == steps_with(0));
}

TEST_CASE("odeint over Taylor: second sensitivities of an oscillator agree with the closed form") {
  // ẍ = −p x: x = cos ωt, ω = √p; dx/dp = −t sin(ωt)/2ω, d²x/dp² = (t sin ωt − ωt² cos ωt)/4ω³.
  using T = duet::taylor<double, 2>;
  using state = std::vector<T>;
  const auto p = T::variable(stiffness);
  const auto oscillator = [&](const state& x, state& dx, double) {
    dx[0] = x[1];
    dx[1] = -p * x[0];
  };
  state x{T(1), T(0)};
  odeint::integrate_adaptive(
      odeint::make_controlled<odeint::runge_kutta_dopri5<state>>(1e-13, 1e-13), oscillator, x, 0.0,
      end, step);
  const double w = std::sqrt(stiffness);
  const double s = std::sin(w * end);
  const double c = std::cos(w * end);
  CHECK(std::abs(x[0].value() - c) <= 1e-11);
  CHECK(std::abs(x[0].derivative(1) + end * s / (2 * w)) <= 1e-11);
  CHECK(std::abs(x[0].derivative(2) - (end * s - w * end * end * c) / (4 * w * w * w)) <= 1e-11);
}

} // namespace
} // namespace test_interop_boost_odeint
