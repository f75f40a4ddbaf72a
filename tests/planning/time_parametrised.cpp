// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/random.hpp"

#include <duet/core/text/number_text.hpp>
#include <duet/planning/time_parametrised.hpp>

#include <doctest/doctest.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace test_planning_time_parametrised {
namespace {

using namespace duet;
using vector = Eigen::Matrix<double, 3, 1>;

/// Limits kept on a fine grid, coordinates between those of the waypoints, and all of it consistent
/// with itself; returns how much of the limits is used, on the average of the larger share.
template <class Trajectory>
double check(const Trajectory& q, const std::vector<vector>& waypoints, const vector& v,
             const vector& a) {
  const double tolerance = 1 + 1e-9;
  REQUIRE(q.times().size() == waypoints.size());
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    CHECK((q(q.times()[k]).value - waypoints[k]).norm() < 1e-9);
  }
  CHECK(q(0).velocity.norm() < 1e-12);
  CHECK(q(q.duration()).velocity.norm() < 1e-6);
  const int count = 2000;
  double use = 0;
  int smooth = 0;
  vector before = q(0).value;
  for (int i = 0; i <= count; ++i) {
    const double h = q.duration() / count, t = std::min(q.duration(), i * h);
    const auto m = q(t);
    const double speed = m.velocity.cwiseQuotient(v).cwiseAbs().maxCoeff();
    const double force = m.acceleration.cwiseQuotient(a).cwiseAbs().maxCoeff();
    CHECK(speed <= tolerance);
    CHECK(force <= tolerance);
    use += std::max(speed, force) / (count + 1);
    const auto next =
        std::size_t(std::upper_bound(q.times().begin(), q.times().end(), t) - q.times().begin());
    if (next > 0 && next < waypoints.size()) {
      const vector low = waypoints[next].cwiseMin(waypoints[next - 1]);
      const vector high = waypoints[next].cwiseMax(waypoints[next - 1]);
      CHECK((m.value - low).minCoeff() > -1e-12);
      CHECK((high - m.value).minCoeff() > -1e-12);
    }
    // The velocity is that of the coordinates.
    if (i > 0) {
      const vector middle = q(t - h / 2).velocity;
      CHECK(((m.value - before) / h - middle).cwiseAbs().cwiseQuotient(a).maxCoeff() < h);
    }
    before = m.value;
    // The acceleration is that of the velocity, save where it jumps.
    const double e = 1e-5 * h;
    if (t > e && t + e < q.duration()) {
      const vector rate = (q(t + e).velocity - q(t - e).velocity) / (2 * e);
      smooth += (rate - m.acceleration).cwiseQuotient(a).cwiseAbs().maxCoeff() < 1e-3;
    }
  }
  CHECK(smooth > .97 * count);
  return use;
}

} // namespace

TEST_CASE("the largest speed of two unknowns: none of a grid is larger, and it is allowed") {
  duet_test::random_source random(2);
  for (int k = 0; k < 200; ++k) {
    std::vector<detail::speed_bound> bounds;
    for (int i = random.integer(0, 12); i > 0; --i) {
      bounds.push_back({random.normal(), random.normal(), random.uniform(.01, 2)});
      bounds.push_back({-bounds.back().a, -bounds.back().b, bounds.back().c});
    }
    const double x = detail::largest_speed(bounds, 1, .7);
    const auto is_allowed = [&](double a, double b, double slack) {
      return std::all_of(bounds.begin(), bounds.end(), [&](const auto& each) {
        return each.a * a + each.b * b <= each.c + slack;
      });
    };
    double largest = 0;
    for (int i = 0; i <= 100; ++i) {
      for (int j = 0; j <= 100; ++j) {
        largest = is_allowed(i / 100.0, j * .007, 0) ? i / 100.0 : largest;
      }
    }
    CHECK(x <= 1);
    CHECK(x >= largest - 1e-12);
    // With the next speed that goes with it, all bounds are kept.
    const double next = detail::largest_next_speed(bounds, x, .7);
    CHECK(is_allowed(x, next, 1e-9));
  }
}

TEST_CASE("one joint: the trapezoid of the closed form") {
  for (const double way : {1e-3, .1, 1.0, 30.0}) {
    const double v = 2, a = 5;
    const double exact = way > v * v / a ? way / v + v / a : 2 * std::sqrt(way / a);
    const std::vector<Eigen::Matrix<double, 1, 1>> ends{Eigen::Matrix<double, 1, 1>(1.0),
                                                        Eigen::Matrix<double, 1, 1>(1 + way)};
    const auto q = time_parametrised(ends, std::array{v}, std::array{a});
    CHECK(q.duration() >= exact * (1 - 1e-12));
    CHECK(q.duration() < exact * (1 + 3e-4));
    CHECK(q.times() == std::vector<double>{0, q.duration()});
    // No limit of velocity.
    const auto free =
        time_parametrised(ends, std::array{std::numeric_limits<double>::infinity()}, std::array{a});
    CHECK(free.duration() == doctest::Approx(2 * std::sqrt(way / a)).epsilon(2e-4));
  }
}

TEST_CASE("straight on, the slowest joint sets the pace") {
  const std::vector<vector> ends{vector(0, 1, 0), vector(1, .5, 0)};
  const vector v(1, 1, 1), a(4, 1, 1e-3);
  // The second joint goes half as far at a quarter of the acceleration.
  const auto q = time_parametrised(ends, v, a);
  check(q, ends, v, a);
  CHECK(q.duration() == doctest::Approx(1 / 1.0 + 1 / 2.0).epsilon(1e-4));
}

TEST_CASE("limits are kept on smooth paths, around corners, and however unequal the steps") {
  duet_test::random_source random(1);
  const vector v(1, 2, .7), a(3, 2, 10);
  for (int k = 0; k < 6; ++k) {
    std::vector<vector> waypoints;
    vector here(0, 0, 0);
    const int count = random.integer(2, 30);
    for (int i = 0; i < count; ++i) {
      waypoints.push_back(here);
      if (i % 7 == 3) {
        waypoints.push_back(here); // a pause
      }
      const double x = double(i) / count;
      here = k % 3 == 0 ? vector(std::cos(5 * x), std::sin(5 * x), x)
                        : vector(here + vector(random.normal(), random.normal(), random.normal()) *
                                            (k % 3 == 1 ? 1 : random.magnitude(1e-6, 1)));
    }
    CAPTURE(k);
    CHECK(check(time_parametrised(waypoints, v, a), waypoints, v, a) > .8);
  }
}

TEST_CASE("more waypoints of the same path take no longer, and more parts less time") {
  const vector v(1, 1, 1), a(2, 2, 2);
  const auto circle = [](int count) {
    std::vector<vector> points;
    for (int i = 0; i <= count; ++i) {
      const double x = 1.5 * i / count;
      points.emplace_back(std::cos(x), std::sin(x), 0);
    }
    return points;
  };
  const double coarse = time_parametrised(circle(20), v, a).duration();
  const double fine = time_parametrised(circle(80), v, a).duration();
  CHECK(std::abs(coarse - fine) < .03 * fine);
  const double few = time_parametrised(circle(4), v, a, {.parts = 1}).duration();
  const double many = time_parametrised(circle(4), v, a, {.parts = 800}).duration();
  CHECK(many < few);
  CHECK(few < 1.1 * many);
}

TEST_CASE("along a plan; a plan that stays; bad input") {
  motion_plan<3> plan;
  plan.joints = {vector(0, 1, 2), vector(1, 1, 3)};
  const vector v(1, 1, 1), a(1, 1, 1);
  const auto q = time_parametrised(plan, v, a);
  CHECK(q.duration() == doctest::Approx(2).epsilon(1e-4));
  CHECK_THROWS_WITH_AS((void)q(3), doctest::Contains("t is 3, outside 0 to "), invalid_input);
  CHECK_THROWS_AS((void)q(std::nan("")), invalid_input);

  // The ends are those to rounding.
  const double end = q.duration(), ulp = std::nextafter(end, 9) - end;
  for (const int k : {1, 8}) {
    CHECK(q(end + k * ulp).value == q(end).value);
    CHECK(q(-k * ulp).value == q(0).value);
  }
  const auto exceeding = duet_test::message_of([&] { (void)q(end + 9 * ulp); });
  CHECK(exceeding == "duet: joint_trajectory: t is " + to_text(end + 9 * ulp) + ", outside 0 to " +
                         to_text(end) + "; std::clamp makes it stay at its end");
  CHECK_THROWS_AS((void)q(-9 * ulp), invalid_input);

  plan.joints = {vector(0, 1, 2), vector(0, 1, 2)};
  const auto still = time_parametrised(plan, v, a);
  CHECK(still.duration() == 0);
  CHECK(still(0).value == vector(0, 1, 2));
  CHECK_THROWS_AS((void)still(1e-300), invalid_input);
  CHECK(still.times() == std::vector<double>{0, 0});

  plan.joints.clear();
  CHECK_THROWS_WITH_AS((void)time_parametrised(plan, v, a), "duet: time_parametrised: no waypoints",
                       invalid_input);
  plan.joints = {vector(0, 1, 2), vector(0, std::nan(""), 2)};
  CHECK_THROWS_WITH_AS((void)time_parametrised(plan, v, a),
                       "duet: time_parametrised: waypoint 1 is not finite or of another size",
                       invalid_input);
  plan.joints.pop_back();
  CHECK_THROWS_WITH_AS((void)time_parametrised(plan, v, vector(1, 0, 1)),
                       "duet: time_parametrised: the acceleration limit of joint 1 is 0",
                       invalid_input);
  CHECK_THROWS_AS((void)time_parametrised(plan, v, vector(1, INFINITY, 1)), invalid_input);
  CHECK_THROWS_AS((void)time_parametrised(plan, vector(1, 1, -1), a), invalid_input);
  CHECK_THROWS_AS((void)time_parametrised(plan, v, a, {.parts = 0}), invalid_input);
  const std::vector<double> two{1, 2};
  CHECK_THROWS_AS((void)time_parametrised(plan, v, Eigen::VectorXd(Eigen::Vector2d(1, 2))),
                  invalid_input);
}

} // namespace test_planning_time_parametrised
