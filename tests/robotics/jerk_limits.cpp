// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../src/robotics/timed_curve.hpp"
#include "support/message.hpp"
#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/dual/taylor.hpp>
#include <duet/robotics/time_parametrised.hpp>

#include <Eigen/Core>

namespace test_robotics_jerk_limits {
namespace {

using namespace duet;
using vector = Eigen::Matrix<double, 3, 1>;
using one = Eigen::Matrix<double, 1, 1>;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Minimum time from rest to rest on a straight line: seven phases with constant jerk, fewer if the
/// velocity or acceleration limit is not reached.
double seven_phases(double distance, double v, double a, double j) {
  // Duration of the acceleration from rest to a speed.
  const auto rise = [&](double speed) {
    return speed > a * a / j ? speed / a + a / j : 2 * std::sqrt(speed / j);
  };
  double low = 0, high = std::min(v, 1e9);
  if (high * rise(high) <= distance) {
    return 2 * rise(high) + (distance - high * rise(high)) / high;
  }
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (middle * rise(middle) < distance ? low : high) = middle;
  }
  return 2 * rise(high);
}

/// Largest fraction of a limit that is used, sampled at equidistant times.
template <class Trajectory, class V>
double max_fraction(const Trajectory& q, const V& v, const V& a, const V& j, int count) {
  double result = 0;
  for (int i = 0; i <= count; ++i) {
    const double t = q.duration() * i / count;
    const auto now = q(t);
    result = std::max({result, now.velocity.cwiseQuotient(v).cwiseAbs().maxCoeff(),
                       now.acceleration.cwiseQuotient(a).cwiseAbs().maxCoeff(),
                       q.jerk(t).cwiseQuotient(j).cwiseAbs().maxCoeff()});
  }
  return result;
}

vector limits(duet_test::random_source& random, double from, double to) {
  const auto any = [&] { return random.log_uniform(from, to); };
  return {any(), any(), any()};
}

std::vector<double> numbers(const vector& x) { return {x.begin(), x.end()}; }

/// Random waypoints with, by `kind`: steps of all joints, of one joint at a time, of very different
/// lengths, and back and forth.
std::vector<vector> random_waypoints(duet_test::random_source& random, int kind) {
  std::vector<vector> result{vector(0, 0, 0)};
  for (int i = random.integer(2, 8); i > 0; --i) {
    vector step(random.normal(), random.normal(), random.normal());
    if (kind == 1) {
      step = random.normal() * vector::Unit(random.integer(0, 2));
    } else if (kind == 2) {
      step *= random.log_uniform(1e-3, 1);
    } else if (kind == 3) {
      step = (i % 2 == 0 ? 1 : -.7) * vector(1, 2, .5);
    }
    result.push_back(result.back() + step);
  }
  return result;
}

TEST_CASE(
    "time_optimal_trajectory: one joint with a jerk limit takes the time of the closed form") {
  for (const double distance : {1e-3, .1, 1.0, 30.0}) {
    for (const double v : {2.0, infinity}) {
      for (const double j : {.5, 10.0, 400.0}) {
        CAPTURE(distance);
        CAPTURE(v);
        CAPTURE(j);
        const double a = 5, exact = seven_phases(distance, v, a, j);
        const std::vector<one> ends{one(1.0), one(1 + distance)};
        const auto q = time_optimal_trajectory(ends, std::array{v}, std::array{a}, {.jerk = {j}});
        CHECK(q.duration() >= exact * (1 - 1e-12));
        CHECK(q.duration() < exact * 1.02);
        CHECK(max_fraction(q, one(v), one(a), one(j), 3000) <= 1 + 1e-12);
        CHECK(q.times() == std::vector<double>{0, q.duration()});
      }
    }
  }
  // The same motion backwards, through a waypoint, and in other units.
  const auto time = [](double scale, double units) {
    const std::vector<one> line{one(0.0), one(-.3 * scale), one(-1 * scale)};
    return units * time_optimal_trajectory(line, std::array{2 * scale * units},
                                           std::array{5 * scale * units * units},
                                           {.jerk = {40 * scale * units * units * units}})
                       .duration();
  };
  CHECK(time(1, 1) < seven_phases(1, 2, 5, 40) * 1.02);
  CHECK(time(1e6, 1e3) == doctest::Approx(time(1, 1)).epsilon(1e-3));
  CHECK(time(1e-6, 1e-3) == doctest::Approx(time(1, 1)).epsilon(1e-3));
}

TEST_CASE("time_optimal_trajectory: on a line with jerk limits the slowest joint determines the "
          "duration") {
  const std::vector<vector> ends{vector(0, 1, 0), vector(1, .5, 0)};
  const vector v(1, 1, 1e-3), a(4, .5, 1e-3);
  for (const double j : {1.0, 20.0}) {
    const vector jerk(3 * j, j, 1e-3);
    const auto q = time_optimal_trajectory(ends, v, a, {.jerk = numbers(jerk)});
    // The second joint moves half as far.
    const double exact = seven_phases(1, 1, 1, std::min(3 * j, 2 * j));
    CHECK(q.duration() >= exact * (1 - 1e-12));
    CHECK(q.duration() < exact * 1.02);
  }
}

TEST_CASE(
    "time_optimal_trajectory: random curves satisfy all jerk limits and are at rest at both ends") {
  duet_test::random_source random(3);
  for (int k = 0; k < 120; ++k) {
    CAPTURE(k);
    const auto waypoints = random_waypoints(random, k % 4);
    const vector v = limits(random, .3, 3), a = limits(random, .5, 20);
    vector j = limits(random, 1, 500);
    if (k % 7 == 0) {
      j[k % 3] = infinity;
    }
    const time_parametrisation_options options{.min_intervals = 60 + k % 50, .jerk = numbers(j)};
    const auto q = time_optimal_trajectory(waypoints, v, a, options);
    const double fraction = max_fraction(q, v, a, j, 500);
    CHECK(fraction <= 1 + 1e-10);
    CHECK(fraction > .9);
    CHECK(q(0).velocity.norm() < 1e-12);
    CHECK(q(0).acceleration.norm() < 1e-12);
    CHECK(q(q.duration()).velocity.cwiseQuotient(v).norm() < 1e-9);
    CHECK(q(q.duration()).acceleration.cwiseQuotient(a).norm() < 1e-9);
    REQUIRE(q.times().size() == waypoints.size());
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
      CHECK((q(q.times()[i]).value - waypoints[i]).norm() < 1e-9);
    }
    // Jerk limits do not shorten the motion.
    CHECK(q.duration() >
          .99 * time_optimal_trajectory(waypoints, v, a,
                                        {.curve = waypoint_interpolation::natural_cubic})
                    .duration());
  }
}

TEST_CASE("time_optimal_trajectory: one joint in motion at both ends takes the time of the "
          "closed form with jerk limits") {
  // From `from` with the maximum acceleration at once, which decreases to 0 at the maximum
  // velocity.
  const auto rise = [](double from, double v, double a, double j) {
    const double constant = (v - from - a * a / (2 * j)) / a, ramp = a / j;
    REQUIRE(constant >= 0);
    const double before = from + a * constant;
    const double distance = (from + before) / 2 * constant + before * ramp + a * ramp * ramp / 3;
    return std::array{constant + ramp, distance};
  };
  for (const double first : {0.01, .5, 1.0}) {
    for (const double last : {.2, 1.1}) {
      CAPTURE(first);
      CAPTURE(last);
      const double v = 2, a = 5, j = 40, distance = 3;
      const auto up = rise(first, v, a, j), down = rise(last, v, a, j);
      const double exact = up[0] + down[0] + (distance - up[1] - down[1]) / v;
      for (const double sign : {-1.0, 1.0}) {
        const std::vector<one> ends{one(1.0), one(1 + sign * distance)};
        const auto q = time_optimal_trajectory(
            ends, std::array{v}, std::array{a},
            {.initial_velocities = {sign * first}, .final_velocities = {sign * last}, .jerk = {j}});
        CHECK(q.duration() >= exact * (1 - 1e-12));
        CHECK(q.duration() <
              exact * (first < .1 ? 1.03 : 1.01)); // nearly at rest: intervals are coarse
        CHECK(max_fraction(q, one(v), one(a), one(j), 3000) <= 1 + 1e-12);
        CHECK(q(0).velocity[0] == doctest::Approx(sign * first).epsilon(1e-12));
        CHECK(q(q.duration()).velocity[0] == doctest::Approx(sign * last).epsilon(1e-9));
      }
    }
  }
  // At the velocity limit at both ends: constant velocity.
  const std::vector<one> ends{one(0.0), one(0.0), one(1.0), one(2.0)};
  for (const double v : {.3, 1.0, 7.0}) {
    const auto q =
        time_optimal_trajectory(ends, std::array{v}, std::array{2.0},
                                {.initial_velocities = {v}, .final_velocities = {v}, .jerk = {5}});
    CHECK(q.duration() >= 2 / v * (1 - 1e-12));
    CHECK(q.duration() < 2 / v * 1.002);
    CHECK(max_fraction(q, one(v), one(2.0), one(5.0), 3000) <= 1 + 1e-12);
  }
  // It moves away from the goal at first, and back to it from beyond.
  const std::vector<one> line{one(0.0), one(1.0)};
  const auto q = time_optimal_trajectory(
      line, std::array{1.0}, std::array{2.0},
      {.initial_velocities = {-.2}, .final_velocities = {-.1}, .jerk = {20}});
  CHECK(max_fraction(q, one(1.0), one(2.0), one(20.0), 3000) <= 1 + 1e-12);
  CHECK(q(0).velocity[0] == doctest::Approx(-.2).epsilon(1e-12));
  CHECK(q(.01).value[0] < 0);
  CHECK(q(q.duration() - .01).value[0] > 1);
}

TEST_CASE(
    "time_optimal_trajectory: a segment of a feasible motion, with its velocities at the ends, is "
    "feasible") {
  duet_test::random_source random(9);
  for (int k = 0; k < 24; ++k) {
    CAPTURE(k);
    const vector v = limits(random, .3, 3), a = limits(random, .5, 20), j = limits(random, 1, 500);
    const auto waypoints = random_waypoints(random, k % 4);
    const time_parametrisation_options options{.min_intervals = 120, .jerk = numbers(j)};
    auto problem = detail::validated_input(detail::waypoints_of(waypoints), v, a, options);
    auto& polygon = problem.polygon;
    const auto curve = detail::hermite_curve(polygon, detail::natural_cubic_slopes(polygon));
    const auto complete = detail::timed_within_jerks(problem, curve);
    // Arc lengths and path velocities at two times.
    double from = random.uniform(0, .8) * complete.duration;
    const double to =
        std::min(complete.duration, from + random.uniform(.02, 1) * complete.duration);
    from *= k % 5 == 0 ? 0 : 1;
    const auto at = [&](double t) {
      double s = 0;
      std::size_t i = 0;
      for (; i + 1 < complete.pieces.size() && complete.pieces[i + 1].scaling.time <= t; ++i) {
        s += complete.pieces[i].path.length;
      }
      const auto [distance, speed, acceleration, jerk] =
          complete.pieces[i].scaling.at(t, complete.pieces[i].path.length);
      return std::array{s + distance, speed};
    };
    const auto [first, first_speed] = at(from);
    const auto [last, last_speed] = at(to);
    std::vector<detail::joint_cubic> middle;
    std::vector<double> knots{0};
    for (std::size_t e = 0; e < curve.size(); ++e) {
      const double begin = std::max(polygon.s[e], first), end = std::min(polygon.s[e + 1], last);
      if (end - begin > 1e-12) {
        middle.push_back(curve[e].part(begin - polygon.s[e], end - begin));
        knots.push_back(knots.back() + end - begin);
      }
    }
    polygon.s = polygon.waypoint_s = knots;
    problem.waypoints = knots.size();
    problem.initial_speed = from > 0 ? first_speed : 0;
    problem.final_speed = to < complete.duration ? last_speed : 0;
    const auto q = detail::timed(problem, middle);
    CHECK(max_fraction(q, v, a, j, 500) <= 1 + 1e-10);
    CHECK(q.duration() < 1.1 * (to - from));
    const auto& end = middle.back();
    CHECK((q(0).velocity - problem.initial_speed * middle[0].first(0)).norm() < 1e-9);
    CHECK((q(q.duration()).velocity - problem.final_speed * end.first(end.length)).norm() < 1e-9);
    CHECK((q(q.duration()).value - end.value(end.length)).norm() < 1e-9);
  }
}

TEST_CASE(
    "time_optimal_trajectory: with random velocities at the ends the jerk limits are satisfied, or "
    "the message states a feasible fraction") {
  duet_test::random_source random(10);
  const vector v(1, 2, .7), a(3, 2, 10), j(20, 40, 30), rest(0, 0, 0);
  int infeasible = 0;
  for (int k = 0; k < 16; ++k) {
    CAPTURE(k);
    const auto waypoints = random_waypoints(random, k % 4);
    // Velocities in random directions, which the curve has at its ends.
    const double size = k % 6 == 5 ? .6 : .1;
    vector first = size * vector(random.normal(), random.normal(), .2);
    vector last = size * vector(random.normal(), random.normal(), .2);
    (k % 3 == 1 ? first : last) *= k % 3 == 2 ? 1 : 0;
    const auto timed = [&] {
      return time_optimal_trajectory(waypoints, v, a,
                                     {.min_intervals = 120,
                                      .initial_velocities = numbers(first),
                                      .final_velocities = numbers(last),
                                      .jerk = numbers(j)});
    };
    std::string message = duet_test::message_of([&] { (void)timed(); });
    if (message.find("in absolute value") != std::string::npos) {
      const double max_ratio = std::max(first.cwiseQuotient(v).cwiseAbs().maxCoeff(),
                                        last.cwiseQuotient(v).cwiseAbs().maxCoeff());
      CHECK(max_ratio > 1);
      first *= .999 / max_ratio;
      last *= .999 / max_ratio;
      message = duet_test::message_of([&] { (void)timed(); });
    }
    if (!message.empty()) {
      ++infeasible;
      const std::string before = "(expected at most ";
      const auto at = message.find(before);
      REQUIRE(at != std::string::npos);
      const double fraction = std::stod(message.substr(at + before.size()));
      CHECK(fraction > 0);
      CHECK(fraction < 1);
      CHECK(message.find(" of them; joint ") != std::string::npos);
      first *= .95 * fraction;
      last *= .95 * fraction;
    }
    const auto q = timed();
    CHECK(max_fraction(q, v, a, j, 500) <= 1 + 1e-10);
    CHECK((q(0).velocity - first).norm() < 1e-12);
    CHECK((q(q.duration()).velocity - last).norm() < 1e-9);
    CHECK((q(q.duration()).value - waypoints.back()).norm() < 1e-9);
  }
  CHECK(infeasible > 0);
  CHECK(infeasible < 8);
}

TEST_CASE("time_optimal_trajectory: a joint that cannot stop in time is rejected") {
  // From velocity 1 to rest, without acceleration at the end: distance ≥ √(2 / j) / 3.
  const double min_length = std::sqrt(2.0 / 8) / 3;
  const auto stop = [&](double distance) {
    const std::vector<one> line{one(0.0), one(distance)};
    return duet_test::message_of([&] {
      (void)time_optimal_trajectory(line, std::array{2.0}, std::array{100.0},
                                    {.initial_velocities = {1}, .jerk = {8}});
    });
  };
  CHECK(stop(min_length * 1.01) == "");
  const std::string message = stop(min_length * .9);
  CAPTURE(message);
  CHECK(message.find("duet: time_optimal_trajectory: the initial velocities are too large "
                     "for the limits (expected at most 0.9") == 0);
  CHECK(message.find(" of them; joint 0, with the velocity 1, is nearest to its limits)") !=
        std::string::npos);
}

TEST_CASE("joint_trajectory: with jerk limits accelerations are continuous, and velocities, "
          "accelerations and jerks are consistent derivatives") {
  duet_test::random_source random(4);
  const vector v(1, 2, .7), a(3, 2, 10), j(20, 40, 30);
  for (int k = 0; k < 4; ++k) {
    const auto waypoints = random_waypoints(random, k);
    const auto q = time_optimal_trajectory(waypoints, v, a, {.jerk = numbers(j)});
    const int count = 4000;
    const double h = q.duration() / count;
    int smooth = 0;
    auto before = q(0);
    vector jerk_before = q.jerk(0);
    for (int i = 1; i <= count; ++i) {
      const double t = std::min(q.duration(), i * h);
      const auto now = q(t);
      const vector jerk = q.jerk(t);
      const double off = 1 + 1e-9;
      CHECK(((now.acceleration - before.acceleration) / h).cwiseQuotient(j).cwiseAbs().maxCoeff() <=
            off);
      CHECK(((now.velocity - before.velocity) / h).cwiseQuotient(a).cwiseAbs().maxCoeff() <= off);
      // Simpson's rule and the trapezoidal rule, with errors of third order at most.
      const vector rate = (now.velocity + before.velocity) / 2;
      const vector change = (now.acceleration + before.acceleration) / 2;
      CHECK(((now.value - before.value) / h - rate).cwiseQuotient(j).cwiseAbs().maxCoeff() <
            h * h / 6);
      CHECK(((now.velocity - before.velocity) / h - change).cwiseQuotient(j).cwiseAbs().maxCoeff() <
            h / 3);
      const vector third = (jerk + jerk_before) / 2;
      smooth += ((now.acceleration - before.acceleration) / h - third)
                    .cwiseQuotient(j)
                    .cwiseAbs()
                    .maxCoeff() < .01;
      before = now;
      jerk_before = jerk;
    }
    CHECK(smooth > .9 * count); // the others are at jumps of the jerk
  }
}

TEST_CASE("reference_parametrisation: a knot next to a node does not change the time scaling") {
  std::vector<double> arc_lengths;
  for (int i = 0; i <= 16; ++i) {
    arc_lengths.push_back(i * i * (3 - i / 8.0));
  }
  const detail::reference_parametrisation reference(arc_lengths);
  const auto complete = reference.pieces({0, arc_lengths.back()});
  REQUIRE(complete.size() == 16);
  for (const double off : {-1e-9, -1e-12, -1e-14, 0.0, 1e-14, 1e-12, 1e-9}) {
    CAPTURE(off);
    const double knot = complete[6].start + off;
    const auto path = reference.pieces({0, knot, arc_lengths.back()});
    CHECK(path.size() <= 17);
    const auto straight = [](double from, double length) {
      const auto number = [](double x) { return Eigen::VectorXd::Constant(1, x); };
      return detail::joint_cubic{number(from), number(1), number(0), number(0), length};
    };
    Eigen::VectorXd squared_velocity(18);
    for (int i = 0; i < 18; ++i) {
      squared_velocity[i] = 1 + .1 * std::sin(i);
    }
    const auto motion = detail::trajectory_from_path_velocity(
        std::vector{straight(0, knot), straight(knot, arc_lengths.back() - knot)}, path, 16,
        squared_velocity);
    const auto uncut = detail::trajectory_from_path_velocity(
        std::vector{straight(0, arc_lengths.back())}, complete, 16, squared_velocity);
    CHECK(motion.duration == doctest::Approx(uncut.duration).epsilon(1e-13));
    double length = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const auto& [scaling, line] = motion.pieces[i];
      const auto& expected = uncut.pieces[path[i].interval];
      CHECK(scaling.growth == expected.scaling.growth);
      CHECK(scaling.speed ==
            doctest::Approx(std::sqrt(squared_velocity[0])).epsilon(.2)); // no cancellation
      CHECK(std::abs(scaling.acceleration - expected.scaling.acceleration -
                     scaling.growth * path[i].from) < 1e-14);
      CHECK(line.c0[0] == doctest::Approx(length).epsilon(1e-13));
      length += line.length;
    }
    CHECK(length == doctest::Approx(arc_lengths.back()).epsilon(1e-14));
  }
}

TEST_CASE(
    "time_optimal_trajectory: infinite jerk limits have no effect, and invalid ones are rejected") {
  const std::vector<vector> waypoints{vector(0, 1, 0), vector(1, .5, .3), vector(2, .7, -.2)};
  const vector v(1, 1, 1), a(2, 3, 4);
  const std::vector<double> none(3, infinity), j{20, 20, 20};
  const double smooth =
      time_optimal_trajectory(waypoints, v, a, {.curve = waypoint_interpolation::natural_cubic})
          .duration();
  CHECK(time_optimal_trajectory(waypoints, v, a, {.jerk = none}).duration() == smooth);
  CHECK(time_optimal_trajectory(waypoints, v, a, {.jerk = j}).duration() > smooth);
  const auto error_message = [&](const time_parametrisation_options& options) {
    return duet_test::message_of([&] { (void)time_optimal_trajectory(waypoints, v, a, options); });
  };
  CHECK(error_message({.jerk = {1, 2}}) ==
        "duet: time_optimal_trajectory: 2 jerk limits (expected 3, one per joint)");
  CHECK(error_message({.jerk = {1, 2, 0}}) ==
        "duet: time_optimal_trajectory: the jerk limit of joint 2 is 0 (expected positive)");
  CHECK(error_message({.initial_velocities = {.1, 0, -1.5}, .jerk = j}) ==
        "duet: time_optimal_trajectory: the initial velocity of joint 2 is -1.5 (expected at most "
        "1 in absolute value)");
  CHECK(
      error_message({.final_velocities = {.1, 1.25, 0}, .jerk = j}) ==
      "duet: time_optimal_trajectory: the final velocity of joint 1 is 1.25 (expected at most 1 in "
      "absolute value)");
  CHECK(time_optimal_trajectory(waypoints, v, a, {.initial_velocities = {0, 0, 0}, .jerk = j})
            .duration() > 0);
  CHECK(error_message({.curve = waypoint_interpolation::pchip, .jerk = j}) ==
        "duet: time_optimal_trajectory: the second derivative of joint 1 jumps at waypoint 1 (with "
        "jerk limits expected continuous, as of waypoint_interpolation::natural_cubic if no joint "
        "leaves its range)");
  // On a line every interpolating curve is smooth, and coinciding waypoints are a path of length 0.
  const std::vector<vector> straight{vector(0, 0, 0), vector(1, 2, 3), vector(1, 2, 3),
                                     vector(3, 6, 9)};
  CHECK(time_optimal_trajectory(straight, v, a, {.curve = waypoint_interpolation::pchip, .jerk = j})
            .duration() > 0);
  CHECK(time_optimal_trajectory(std::vector<vector>{v, v}, v, a, {.jerk = j}).duration() == 0);

  // A joint of a chain leaves its range, and does not with a wider one.
  for (const double range : {1.0, 2.0}) {
    std::array<joint<>, 3> joints;
    for (auto& each : joints) {
      each.limits = {-range, range, 1};
    }
    const std::vector<vector> back{vector(0, 0, 0), vector(1, .3, .2), vector(0, .4, .6)};
    const auto message = duet_test::message_of(
        [&] { (void)time_optimal_trajectory(serial_chain<3>(joints), back, a, {.jerk = j}); });
    CHECK(message.empty() == (range == 2));
    if (range == 1) {
      CHECK(message.find("the second derivative of joint 0 jumps at waypoint 1") !=
            std::string::npos);
    }
  }
}

} // namespace
} // namespace test_robotics_jerk_limits
