// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

// Planar linkages, against closed forms. (The wheel carrier, whose unknown is a rotation, is in
// examples/wheel_carrier.)

namespace test_kinematics_constrained_mechanism {
namespace {

using namespace duet;
using std::numbers::pi;

/// Crank a, coupler b, rocker c, ground d: a e^{iθ} + b e^{iβ} = d + c e^{iψ}, for (β, ψ).
struct four_bar {
  double a, b, c, d;

  template <class X, class T>
  auto operator()(const X& x, const T& theta) const {
    using std::cos;
    using std::sin;
    return make_vector(a * cos(theta) + b * cos(x[0]) - d - c * cos(x[1]),
                       a * sin(theta) + b * sin(x[0]) - c * sin(x[1]));
  }

  /// ψ by Freudenstein's equation, A sin ψ + B cos ψ = C; `open` selects the assembly mode.
  template <class T>
  T rocker(const T& theta, double open) const {
    using std::atan2;
    using std::cos;
    using std::sin;
    using std::sqrt;
    const T s = a * sin(theta), k = a * cos(theta) - d;
    const T q = (b * b - c * c - s * s - k * k) / (-2 * c);
    return atan2(s, k) + open * atan2(sqrt(s * s + k * k - q * q), q) + 2 * pi * (k < 0 && s < 0);
  }

  Eigen::Vector2d position(double theta, double open) const {
    const double psi = rocker(theta, open);
    return {std::atan2(c * std::sin(psi) - a * std::sin(theta),
                       d + c * std::cos(psi) - a * std::cos(theta)),
            psi};
  }
};

/// Maximum difference of ψ, ψ′ and ψ″ from the closed form, each relative to its scale.
template <class Loop>
double rocker_error(const Loop& loop, const four_bar& bars, double theta, double open) {
  const auto x = derivatives<2>(loop, theta);
  const auto y = derivatives<2>([&](const auto& t) { return bars.rocker(t, open); }, theta);
  double worst = std::abs(std::sin((x[0][1] - y[0]) / 2));
  for (std::size_t k = 1; k <= 2; ++k) {
    worst = std::max(worst, std::abs(x[k][1] - y[k]) / std::max(1.0, std::abs(y[k])));
  }
  return worst;
}

template <class F>
std::string message(const F& f) {
  return duet_test::message_of<loop_closure_failure>(f);
}

TEST_CASE("constrained_mechanism: a crank-rocker agrees with the closed form over two turns in "
          "both assembly modes") {
  const four_bar bars{.2, .5, .4, .55};
  for (const double open : {-1.0, 1.0}) {
    CAPTURE(open);
    const constrained_mechanism loop(bars, bars.position(.3, open), .3);
    CHECK(loop.parameter() == .3);
    for (int i = -40; i <= 40; ++i) {
      const double theta = .3 + i * pi / 20;
      CAPTURE(theta);
      CHECK(rocker_error(loop, bars, theta, open) < 1e-13);
    }
    // An initial guess that is only near.
    const Eigen::Vector2d near = bars.position(.3, open) + Eigen::Vector2d(.2, -.1);
    CHECK((constrained_mechanism(bars, near, .3).position() - loop.position()).norm() < 1e-15);
    // Full turns do not change the angles, as the rocker never makes a full turn.
    CHECK((loop(.3 + 6 * pi) - loop.position()).norm() < 1e-14);
    const auto moved = loop.warm_started_at(2);
    CHECK(moved.parameter() == 2);
    CHECK((moved(1.5) - loop(1.5)).norm() < 1e-15);
  }
}

TEST_CASE("constrained_mechanism: a dead point is approached and reported, not passed") {
  const four_bar bars{.3, .25, .2, .4}; // a + d > b + c: the crank cannot go around
  const double dead = std::acos((.3 * .3 + .4 * .4 - .45 * .45) / (2 * .3 * .4));
  for (const double open : {-1.0, 1.0}) {
    const constrained_mechanism loop(bars, bars.position(.5, open), .5);
    for (const double before : {1e-1, 1e-3, 1e-6}) {
      // Rates are unbounded at the dead point: errors of the closed form itself grow by 1/before.
      CHECK(rocker_error(loop, bars, dead - before, open) < 1e-14 / before);
    }
    for (const double beyond : {1e-6, .1, 2.0}) {
      try {
        (void)loop(dead + beyond);
        FAIL("it closes beyond the dead point");
      } catch (const loop_closure_failure& e) {
        CHECK(e.parameter().size() == 1);
        CHECK(e.parameter()[0] == doctest::Approx(dead).epsilon(1e-6));
      }
    }
  }
}

TEST_CASE("constrained_mechanism: an assembly mode beyond a gap is not reached") {
  const four_bar bars{.975, .741, 1.076, .694};
  for (const double open : {-1.0, 1.0}) {
    const constrained_mechanism loop(bars, bars.position(1.5, open), 1.5, {.largest_step = 10});
    CHECK_THROWS_AS((void)loop(-1.5), loop_closure_failure);
    const constrained_mechanism other(bars, bars.position(-1.5, open), -1.5);
    CHECK(rocker_error(other, bars, -1.6, open) < 1e-13);
  }
}

TEST_CASE("constrained_mechanism: errors contain the parameter") {
  const four_bar too_short{.1, .2, .2, 1};
  CHECK(message([&] { constrained_mechanism(too_short, Eigen::Vector2d(0, 0), .5); }) ==
        "duet: constrained_mechanism: no position near the initial guess at u = 0.5");
  // A slider on a crank: x² = 1 − u².
  const auto circle = [](const auto& x, const auto& u) { return x * x + u * u - 1; };
  const constrained_mechanism slider(circle, 1.0, 0);
  CHECK(message([&] {
          (void)slider(2.0);
        }).find("duet: constrained_mechanism: the loops do not close beyond u = 0.99999") == 0);
  CHECK(message([&] { (void)slider(2.0); }).find(" on the line from 0 to 2") != std::string::npos);
  CHECK_THROWS_WITH_AS((void)slider(std::nan("")),
                       "duet: constrained_mechanism: u = nan is not finite", invalid_input);
  CHECK_THROWS_AS(constrained_mechanism(circle, 0.0, 1.0),
                  loop_closure_failure); // start at the dead point itself
}

TEST_CASE("constrained_mechanism: tiny steps and a constant position have exact derivatives") {
  const auto circle = [](const auto& x, const auto& u) { return x * x + u * u - 1; };
  const constrained_mechanism slider(circle, -.7, 0.0); // the other branch
  CHECK(slider.position() == -1);
  for (const double u : {1e-300, 1e-18, 1e-9, 1e-3, .6, .999}) {
    const auto x = derivatives<2>(slider, -u);
    const double root = std::sqrt((1 - u) * (1 + u));
    CHECK(x[0] == doctest::Approx(-root).epsilon(1e-14));
    CHECK(x[1] == doctest::Approx(-u / root).epsilon(1e-12));
    CHECK(x[2] == doctest::Approx(1 / (root * root * root)).epsilon(1e-12));
  }
  const constrained_mechanism still([](const auto& x, const auto&) { return x * x - 2; }, 1.0, 0.0);
  CHECK(still(5.0) == doctest::Approx(std::sqrt(2.0)).epsilon(1e-15));
}

TEST_CASE("constrained_mechanism: a five-bar with two parameters agrees with the closed form") {
  // Two cranks of length 1, their feet at ±½, two couplers of length 1.2 that meet in x.
  const auto five_bar = [](const auto& x, const auto& u) {
    using std::cos;
    using std::sin;
    const auto from = [&](double foot, const auto& angle) {
      const auto dx = x[0] - foot - cos(angle);
      const auto dy = x[1] - sin(angle);
      return dx * dx + dy * dy - 1.44;
    };
    return make_vector(from(-.5, u[0]), from(.5, u[1]));
  };
  const auto closed_form = [](const auto& u) {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const auto ax = cos(u[0]) - .5, ay = sin(u[0]), bx = cos(u[1]) + .5, by = sin(u[1]);
    const auto dx = bx - ax, dy = by - ay;
    const auto side = sqrt(1.44 / (dx * dx + dy * dy) - .25);
    return make_vector((ax + bx) / 2 - side * dy, (ay + by) / 2 + side * dx);
  };
  const Eigen::Vector2d start(2, 1);
  const constrained_mechanism loop(five_bar, Eigen::Vector2d(closed_form(start)), start);
  for (const Eigen::Vector2d& u : {Eigen::Vector2d(1.8, .8), Eigen::Vector2d(1.5, .2), start}) {
    const auto [x, j] = jacobian(loop, u);
    const auto [y, k] = jacobian(closed_form, u);
    CHECK((x - y).norm() < 1e-14);
    CHECK((j - k).norm() < 1e-13);
  }
  CHECK(message([&] {
          (void)loop(Eigen::Vector2d(3, 0));
        }).find("duet: constrained_mechanism: the loops do not close beyond u = (2.") == 0);
}

} // namespace
} // namespace test_kinematics_constrained_mechanism
