// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "../../src/robotics/timed_curve.hpp"
#include "support/message.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/core/text/number_text.hpp>
#include <duet/robotics/time_parametrised.hpp>

#include <Eigen/Core>

namespace test_robotics_time_parametrised {
namespace {

using namespace duet;
using vector = Eigen::Matrix<double, 3, 1>;

/// Checks limits on a fine grid, coordinates between those of the waypoints, and consistent
/// derivatives; returns the average fraction of the limits that is used.
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
    // The velocity is the derivative of the coordinates.
    if (i > 0) {
      const vector middle = q(t - h / 2).velocity;
      CHECK(((m.value - before) / h - middle).cwiseAbs().cwiseQuotient(a).maxCoeff() < h);
    }
    before = m.value;
    // The acceleration is the derivative of the velocity, except at jumps.
    const double e = 1e-5 * h;
    if (t > e && t + e < q.duration()) {
      const vector rate = (q(t + e).velocity - q(t - e).velocity) / (2 * e);
      smooth += (rate - m.acceleration).cwiseQuotient(a).cwiseAbs().maxCoeff() < 1e-3;
    }
  }
  CHECK(smooth > .97 * count);
  return use;
}

/// Checks limits on a fine grid; returns the largest fraction of a limit that is used.
template <class Trajectory>
double check_shares(const Trajectory& q, const vector& v, const vector& a) {
  const int count = 1000;
  double largest = 0;
  for (int i = 0; i <= count; ++i) {
    const auto now = q(q.duration() * i / count);
    largest = std::max({largest, now.velocity.cwiseQuotient(v).cwiseAbs().maxCoeff(),
                        now.acceleration.cwiseQuotient(a).cwiseAbs().maxCoeff()});
  }
  CHECK(largest <= 1 + 1e-9);
  return largest;
}

/// Minimum time with the limits sampled at both ends of each of 200 segments of each edge, by
/// bisection.
double sampled_optimum(const std::vector<detail::joint_cubic>& curve, const vector& v,
                       const vector& a) {
  struct part {
    double h, cap;
    std::array<double, 6> x, y; // |x ṡ₀² + y ṡ₁²| ≤ limit
  };
  std::vector<part> parts;
  for (const auto& edge : curve) {
    for (int i = 0; i < 200; ++i) {
      part next{edge.length / 200, INFINITY, {}, {}};
      for (std::size_t end = 0; end < 2; ++end) {
        const double s = next.h * (i + int(end));
        const vector first = edge.first(s), second = edge.second(s);
        for (Eigen::Index j = 0; j < 3; ++j) {
          const double change = first[j] / (2 * next.h);
          const auto at = 3 * end + std::size_t(j);
          next.x[at] = (end == 0 ? second[j] : 0) - change;
          next.y[at] = (end == 1 ? second[j] : 0) + change;
          next.cap = std::min(next.cap, std::pow(v[j] / std::max(std::abs(first[j]), 1e-50), 2));
        }
      }
      parts.push_back(next);
    }
  }
  const auto range = [&](const part& at, double x, double most) {
    double low = 0, high = most;
    for (std::size_t k = 0; k < 6; ++k) {
      const double limit = a[Eigen::Index(k % 3)], y = at.y[k];
      if (y != 0) {
        low = std::max(low, -at.x[k] * x / y - limit / std::abs(y));
        high = std::min(high, -at.x[k] * x / y + limit / std::abs(y));
      } else if (std::abs(at.x[k]) * x > limit) {
        high = -1;
      }
    }
    return std::array{low, high};
  };
  std::vector<double> most(parts.size() + 1, 0.0);
  for (std::size_t i = parts.size(); i-- > 1;) {
    double low = 0, high = std::min(parts[i].cap, parts[i - 1].cap);
    for (int n = 0; n < 45; ++n) {
      const double middle = n == 0 ? high : (low + high) / 2;
      const auto [from, to] = range(parts[i], middle, most[i + 1]);
      (from <= to ? low : high) = middle;
    }
    most[i] = low;
  }
  double time = 0, x = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double next = std::max(0.0, range(parts[i], x, most[i + 1])[1]);
    time += 2 * parts[i].h / (std::sqrt(x) + std::sqrt(next));
    x = next;
  }
  return time;
}

TEST_CASE("time_optimal_trajectory: one joint takes the time of the trapezoidal velocity profile") {
  for (const double distance : {1e-3, .1, 1.0, 30.0}) {
    const double v = 2, a = 5;
    const double exact = distance > v * v / a ? distance / v + v / a : 2 * std::sqrt(distance / a);
    const std::vector<Eigen::Matrix<double, 1, 1>> ends{Eigen::Matrix<double, 1, 1>(1.0),
                                                        Eigen::Matrix<double, 1, 1>(1 + distance)};
    const auto q = time_optimal_trajectory(ends, std::array{v}, std::array{a});
    CHECK(q.duration() >= exact * (1 - 1e-12));
    CHECK(q.duration() < exact * (1 + 3e-4));
    CHECK(q.times() == std::vector<double>{0, q.duration()});
    // Without velocity limit.
    const auto free = time_optimal_trajectory(
        ends, std::array{std::numeric_limits<double>::infinity()}, std::array{a});
    CHECK(free.duration() == doctest::Approx(2 * std::sqrt(distance / a)).epsilon(2e-4));
  }
}

TEST_CASE("time_optimal_trajectory: one joint in motion at its ends takes the time of the closed "
          "form, and reverses if it starts backwards") {
  using one = Eigen::Matrix<double, 1, 1>;
  const double v = 2, a = 5;
  for (const double distance : {.7, 30.0}) {
    const std::vector<one> ends{one(1.0), one(1 + distance)};
    for (const auto& rates : {std::array{1.5, 0.0}, {0.0, 1.9}, {1.7, .4}, {2.0, 2.0}}) {
      const double v_0 = rates[0], v_1 = rates[1];
      CAPTURE(distance);
      CAPTURE(v_0);
      const double squares = v_0 * v_0 + v_1 * v_1;
      const double peak = std::min(v, std::sqrt(a * distance + squares / 2));
      const double exact =
          (2 * peak - v_0 - v_1) / a + (distance - (2 * peak * peak - squares) / (2 * a)) / peak;
      const auto q =
          time_optimal_trajectory(ends, std::array{v}, std::array{a},
                                  {.initial_velocities = {v_0}, .final_velocities = {v_1}});
      CHECK(q.duration() >= exact * (1 - 1e-12));
      CHECK(q.duration() < exact * (1 + 1e-3));
      CHECK(q(0).velocity[0] == doctest::Approx(v_0));
      CHECK(q(q.duration()).velocity[0] == doctest::Approx(v_1));
    }
    const auto back =
        time_optimal_trajectory(ends, std::array{v}, std::array{a}, {.initial_velocities = {-.3}});
    CHECK(back(0).velocity[0] == doctest::Approx(-.3));
    CHECK(back(back.duration()).value[0] == doctest::Approx(1 + distance));
    double least = 1;
    for (int i = 0; i <= 1000; ++i) {
      const auto now = back(back.duration() * i / 1000);
      CHECK(std::abs(now.velocity[0]) <= v * (1 + 1e-9));
      CHECK(std::abs(now.acceleration[0]) <= a * (1 + 1e-9));
      least = std::min(least, now.value[0]);
    }
    CHECK(least < 1);
  }
}

TEST_CASE("time_optimal_trajectory: on a line the slowest joint determines the duration") {
  const std::vector<vector> ends{vector(0, 1, 0), vector(1, .5, 0)};
  const vector v(1, 1, 1), a(4, 1, 1e-3);
  // The second joint moves half as far with a quarter of the acceleration.
  const auto q = time_optimal_trajectory(ends, v, a);
  check(q, ends, v, a);
  CHECK(q.duration() == doctest::Approx(1 / 1.0 + 1 / 2.0).epsilon(1e-4));
}

TEST_CASE("time_optimal_trajectory: limits are satisfied on smooth paths, at corners and with "
          "unequal steps") {
  duet_test::random_source random(1);
  const vector v(1, 2, .7), a(3, 2, 10);
  for (int k = 0; k < 6; ++k) {
    std::vector<vector> waypoints;
    vector current(0, 0, 0);
    const int count = random.integer(2, 30);
    for (int i = 0; i < count; ++i) {
      waypoints.push_back(current);
      if (i % 7 == 3) {
        waypoints.push_back(current); // a pause
      }
      const double x = double(i) / count;
      current = k % 3 == 0
                    ? vector(std::cos(5 * x), std::sin(5 * x), x)
                    : vector(current + vector(random.normal(), random.normal(), random.normal()) *
                                           (k % 3 == 1 ? 1 : random.log_uniform(1e-6, 1)));
    }
    CAPTURE(k);
    CHECK(check(time_optimal_trajectory(waypoints, v, a), waypoints, v, a) > .8);
  }
}

TEST_CASE("time_optimal_trajectory: more waypoints of one path keep the duration, more intervals "
          "shorten it") {
  const vector v(1, 1, 1), a(2, 2, 2);
  const auto circle = [](int count) {
    std::vector<vector> points;
    for (int i = 0; i <= count; ++i) {
      const double x = 1.5 * i / count;
      points.emplace_back(std::cos(x), std::sin(x), 0);
    }
    return points;
  };
  const double coarse = time_optimal_trajectory(circle(20), v, a).duration();
  const double fine = time_optimal_trajectory(circle(80), v, a).duration();
  CHECK(std::abs(coarse - fine) < .03 * fine);
  const double few = time_optimal_trajectory(circle(4), v, a, {.min_intervals = 1}).duration();
  const double many = time_optimal_trajectory(circle(4), v, a, {.min_intervals = 800}).duration();
  CHECK(many < few);
  CHECK(few < 1.1 * many);
}

TEST_CASE(
    "time_optimal_trajectory: limits are satisfied to round-off between nearly equal waypoints") {
  const vector v(1, 2, .5), a(3, 5, 2);
  random_source random(11);
  const auto direction = [&] {
    const auto d = random.direction<3>();
    return vector(d[0], d[1], d[2]);
  };
  for (const double tiny : {1e-6, 1e-7, 1e-9}) {
    for (const waypoint_interpolation curve :
         {waypoint_interpolation::pchip, waypoint_interpolation::natural_cubic}) {
      for (int kind = 0; kind < 4; ++kind) {
        std::vector<vector> waypoints{vector(.1, .2, .3)};
        for (int k = 0; k < 5; ++k) {
          const vector d = kind == 2 ? vector(.3, .4, 0) : direction();
          waypoints.push_back(waypoints.back() + d);
          if (kind == 1) {
            waypoints.push_back(waypoints.back());
          }
          waypoints.push_back(waypoints.back() + tiny * (kind == 0 || kind == 3 ? direction() : d));
        }
        time_parametrisation_options options;
        options.curve = curve;
        const double speed = kind == 3 ? .1 : 0;
        const vector last = waypoints[1] - waypoints[0];
        options.initial_velocities = {speed * last[0], speed * last[1], speed * last[2]};
        const auto q = time_optimal_trajectory(waypoints, v, a, options);
        double largest = 0;
        for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
          const double from = q.times()[i], to = q.times()[i + 1];
          for (int k = 0; k <= 100; ++k) {
            const auto now = q(std::min(from + (to - from) * k / 100, q.duration()));
            largest = std::max({largest, now.velocity.cwiseQuotient(v).cwiseAbs().maxCoeff(),
                                now.acceleration.cwiseQuotient(a).cwiseAbs().maxCoeff()});
          }
          CHECK((q(from).value - waypoints[i]).norm() < 1e-9);
        }
        CAPTURE(tiny);
        CAPTURE(kind);
        CHECK_LE(largest, 1 + 1e-12);
        CHECK_LT(std::abs(q(0).velocity.norm() - speed * last.norm()), 1e-12);
      }
    }
  }
}

TEST_CASE("time_optimal_trajectory: plans and plans of zero length are accepted, invalid input is "
          "rejected") {
  motion_plan plan;
  plan.joints = {vector(0, 1, 2), vector(1, 1, 3)};
  const vector v(1, 1, 1), a(1, 1, 1);
  const auto q = time_optimal_trajectory(plan, v, a);
  CHECK(q.duration() == doctest::Approx(2).epsilon(1e-4));
  DUET_CHECK_REFUSED(doctest::Contains("t is 3 (expected 0 to "), q(3));
  CHECK_THROWS_AS((void)q(std::nan("")), invalid_input);

  // A time beyond an end by round-off counts as the end.
  const double end = q.duration(), ulp = std::nextafter(end, 9) - end;
  for (const int k : {1, 8}) {
    CHECK(q(end + k * ulp).value == q(end).value);
    CHECK(q(-k * ulp).value == q(0).value);
  }
  const auto exceeding = duet_test::message_of([&] { (void)q(end + 9 * ulp); });
  CHECK(exceeding == "duet: joint_trajectory: t is " + to_text(end + 9 * ulp) + " (expected 0 to " +
                         to_text(end) + "; std::clamp gives the state at an end)");
  CHECK_THROWS_AS((void)q(-9 * ulp), invalid_input);

  plan.joints = {vector(0, 1, 2), vector(0, 1, 2)};
  const auto still = time_optimal_trajectory(plan, v, a);
  CHECK(still.duration() == 0);
  CHECK(still(0).value == vector(0, 1, 2));
  CHECK_THROWS_AS((void)still(1e-300), invalid_input);
  CHECK(still.times() == std::vector<double>{0, 0});

  plan.joints.clear();
  DUET_CHECK_REFUSED("duet: time_optimal_trajectory: there are no waypoints (expected at least 1)",
                     time_optimal_trajectory(plan, v, a));
  plan.joints = {vector(0, 1, 2), vector(0, std::nan(""), 2)};
  DUET_CHECK_REFUSED(
      "duet: time_optimal_trajectory: waypoint 1 is not finite or has another size than waypoint 0",
      time_optimal_trajectory(plan, v, a));
  plan.joints.pop_back();
  DUET_CHECK_REFUSED("duet: time_optimal_trajectory: the acceleration limit of joint 1 is 0 "
                     "(expected positive and finite)",
                     time_optimal_trajectory(plan, v, vector(1, 0, 1)));
  CHECK_THROWS_AS((void)time_optimal_trajectory(plan, v, vector(1, INFINITY, 1)), invalid_input);
  CHECK_THROWS_AS((void)time_optimal_trajectory(plan, vector(1, 1, -1), a), invalid_input);
  CHECK_THROWS_AS((void)time_optimal_trajectory(plan, v, a, {.min_intervals = 0}), invalid_input);
  const std::vector<double> two{1, 2};
  CHECK_THROWS_AS((void)time_optimal_trajectory(plan, v, Eigen::VectorXd(Eigen::Vector2d(1, 2))),
                  invalid_input);
}

TEST_CASE(
    "time_optimal_trajectory: durations are close to those with sampled limits on the same curve") {
  duet_test::random_source random(5);
  const vector v(1, 2, .7), a(3, 2, 10);
  for (int k = 0; k < 6; ++k) {
    CAPTURE(k);
    // Steps of all joints, of one joint at a time, and of very different lengths.
    std::vector<vector> waypoints{vector(0, 0, 0)};
    for (int i = random.integer(2, 7); i > 0; --i) {
      const vector step = k % 3 == 1 ? vector(random.normal() * vector::Unit(random.integer(0, 2)))
                                     : vector(random.normal(), random.normal(), random.normal());
      waypoints.push_back(waypoints.back() + (k % 3 == 2 ? random.log_uniform(1e-4, 1) : 1) * step);
    }
    for (const auto kind : {waypoint_interpolation::pchip, waypoint_interpolation::natural_cubic}) {
      const detail::joint_polygon polygon(detail::waypoints_of(waypoints));
      const auto curve =
          detail::hermite_curve(polygon, kind == waypoint_interpolation::natural_cubic
                                             ? detail::natural_cubic_slopes(polygon)
                                             : detail::pchip_slopes(polygon));
      const double sampled = sampled_optimum(curve, v, a);
      const double time = time_optimal_trajectory(waypoints, v, a, {.curve = kind}).duration();
      CHECK(time < 1.03 * sampled);
      CHECK(time > .99 * sampled);
    }
  }
}

TEST_CASE("natural_cubic_slopes: the second derivative is continuous and 0 at free ends") {
  duet_test::random_source random(8);
  std::vector<vector> waypoints;
  for (int i = 0; i < 7; ++i) {
    waypoints.emplace_back(random.normal(), random.normal(), random.normal());
  }
  for (const bool has_rates : {false, true}) {
    detail::joint_polygon polygon(detail::waypoints_of(waypoints));
    if (has_rates) {
      polygon.first_slope = vector(.6, 0, .8);
      polygon.last_slope = vector(0, -1, 0);
    }
    const auto curve = detail::hermite_curve(polygon, detail::natural_cubic_slopes(polygon));
    for (std::size_t k = 0; k < curve.size(); ++k) {
      const auto& q = curve[k];
      CHECK((q.value(0) - waypoints[k]).norm() < 1e-14);
      CHECK((q.value(q.length) - waypoints[k + 1]).norm() < 1e-13);
      if (k + 1 < curve.size()) {
        CHECK((q.first(q.length) - curve[k + 1].first(0)).norm() < 1e-12);
        CHECK((q.second(q.length) - curve[k + 1].second(0)).norm() < 1e-12);
      }
    }
    const auto& last = curve.back();
    if (has_rates) {
      CHECK((curve[0].first(0) - polygon.first_slope).norm() < 1e-15);
      CHECK((last.first(last.length) - polygon.last_slope).norm() < 1e-13);
    } else {
      CHECK(curve[0].second(0).norm() < 1e-13);
      CHECK(last.second(last.length).norm() < 1e-12);
    }
  }
}

TEST_CASE(
    "time_optimal_trajectory: velocities at the ends are attained, and infeasible ones rejected") {
  const std::vector<vector> waypoints{vector(0, 1, 0), vector(1, .5, .3), vector(2, .7, -.2)};
  const vector v(1, 1, 1), a(2, 3, 4);
  time_parametrisation_options options{.min_intervals = 60};
  const double from_rest = time_optimal_trajectory(waypoints, v, a, options).duration();
  options.initial_velocities = {.5, -.2, .1};
  options.final_velocities = {.3, .1, -.2};
  const auto q = time_optimal_trajectory(waypoints, v, a, options);
  CHECK(q.duration() < from_rest);
  CHECK((q(0).velocity - vector(.5, -.2, .1)).norm() < 1e-12);
  CHECK((q(q.duration()).velocity - vector(.3, .1, -.2)).norm() < 1e-12);
  CHECK((q(0).value - waypoints[0]).norm() < 1e-12);
  CHECK((q(q.duration()).value - waypoints[2]).norm() < 1e-12);
  check_shares(q, v, a);

  // Velocities of 0 are rest.
  options.initial_velocities = {0, 0, 0};
  options.final_velocities = {};
  CHECK(time_optimal_trajectory(waypoints, v, a, options).duration() == from_rest);

  // Too fast to slow down: the fraction in the message is feasible, a little more is not.
  for (const bool at_end : {false, true}) {
    CAPTURE(at_end);
    const std::vector<vector> short_path{vector(0, 0, 0), vector(.02, 0, 0)};
    auto& rates = at_end ? options.final_velocities : options.initial_velocities;
    auto& other = at_end ? options.initial_velocities : options.final_velocities;
    other.clear();
    rates = {.9, 0, 0};
    const auto message =
        duet_test::message_of([&] { (void)time_optimal_trajectory(short_path, v, a, options); });
    const std::string before = std::string("duet: time_optimal_trajectory: the ") +
                               (at_end ? "final" : "initial") +
                               " velocities are infeasible (expected at most ";
    REQUIRE(message.substr(0, before.size()) == before);
    const double part = std::stod(message.substr(before.size()));
    CHECK(message.substr(message.find(" times")) == " times as large)");
    rates[0] = .9 * part;
    CHECK(time_optimal_trajectory(short_path, v, a, options).duration() > 0);
    rates[0] = .9 * part * 1.003;
    CHECK_THROWS_AS((void)time_optimal_trajectory(short_path, v, a, options), invalid_input);
    // v² = 2 a s
    CHECK(.9 * part == doctest::Approx(std::sqrt(2 * 2 * .02)).epsilon(1e-3));
  }
  DUET_CHECK_REFUSED(
      "duet: time_optimal_trajectory: 2 initial velocities (expected 3, one per joint)",
      time_optimal_trajectory(waypoints, v, a, {.initial_velocities = {1, 2}}));
  DUET_CHECK_REFUSED("duet: time_optimal_trajectory: the final velocities are not finite",
                     time_optimal_trajectory(waypoints, v, a, {.final_velocities = {1, 2, NAN}}));
  const std::vector<vector> still{vector(0, 0, 0), vector(0, 0, 0)};
  CHECK_THROWS_AS((void)time_optimal_trajectory(still, v, a, {.initial_velocities = {1, 2, 3}}),
                  invalid_input);
  // Faster than the velocity limit of a joint.
  DUET_CHECK_REFUSED(
      doctest::Contains("the initial velocities are infeasible (expected at most 0."),
      time_optimal_trajectory(waypoints, v, a, {.initial_velocities = {2, 0, 0}}));
}

TEST_CASE("slopes_within_ranges: a natural cubic spline stays within the ranges of its waypoints") {
  duet_test::random_source random(9);
  const vector none = vector::Constant(INFINITY), one(1, 1, 1);
  int beyond = 0;
  for (int k = 0; k < 300; ++k) {
    std::vector<vector> waypoints;
    vector current(0, 0, 0);
    for (int i = random.integer(2, 15); i >= 0; --i) {
      const vector step(random.normal(), random.normal(), random.normal());
      current = (current + random.log_uniform(.01, 2) * step).cwiseMin(1).cwiseMax(-1);
      waypoints.push_back(current);
    }
    const detail::joint_polygon polygon(detail::waypoints_of(waypoints));
    const auto smooth = detail::natural_cubic_slopes(polygon);
    const detail::time_parametrisation_input problem{
        polygon, waypoints.size(), none, one, none, 0, 0, 1, -one, one};
    const auto largest = [&](const std::vector<Eigen::VectorXd>& slopes) {
      double result = 0;
      for (const auto& q : detail::hermite_curve(polygon, slopes)) {
        for (int i = 0; i <= 20; ++i) {
          result = std::max(result, q.value(q.length * i / 20).cwiseAbs().maxCoeff());
        }
      }
      return result;
    };
    beyond += largest(smooth) > 1.001;
    CHECK(largest(detail::slopes_within_ranges(problem, smooth)) < 1 + 1e-11);
  }
  CHECK(beyond > 100);
}

TEST_CASE("time_optimal_trajectory: the velocity and position limits of a chain are satisfied") {
  std::array<joint<>, 3> joints;
  for (std::size_t i = 0; i < 3; ++i) {
    joints[i].limits = {-1, 1, double(i) + 1};
  }
  const serial_chain<3> chain(joints);
  const vector a(9, 9, 9);
  motion_plan plan;
  plan.joints = {vector(0, 0, 0), vector(.9, .2, .1), vector(.5, .4, .2), vector(.2, .8, .7)};
  const auto q = time_optimal_trajectory(chain, plan, a);
  const vector v(1, 2, 3);
  CHECK(check_shares(q, v, a) > .99);
  CHECK(q.duration() ==
        time_optimal_trajectory(plan, v, a, {.curve = waypoint_interpolation::natural_cubic})
            .duration());
  CHECK(q.duration() == time_optimal_trajectory(chain, plan.joints, a).duration());
  CHECK(time_optimal_trajectory(chain, plan, a, {.curve = waypoint_interpolation::pchip})
            .duration() == time_optimal_trajectory(plan, v, a).duration());

  // The first joint reverses at its limit; the spline exceeds it.
  plan.joints[1][0] = 1;
  plan.joints[3][1] = 1;
  const auto largest = [](const auto& motion) {
    vector result = motion(0).value;
    for (int i = 0; i <= 3000; ++i) {
      result = result.cwiseMax(motion(motion.duration() * i / 3000).value);
    }
    return result;
  };
  CHECK(largest(time_optimal_trajectory(
            plan, v, a, {.curve = waypoint_interpolation::natural_cubic}))[0] > 1.01);
  CHECK(largest(time_optimal_trajectory(chain, plan, a)).maxCoeff() < 1 + 1e-12);
  // With an outward velocity at its limit the joint exceeds it on every curve.
  plan.joints[0][0] = 1;
  plan.joints[1][0] = .8;
  for (const auto kind : {waypoint_interpolation::natural_cubic, waypoint_interpolation::pchip}) {
    const auto message = duet_test::message_of([&] {
      (void)time_optimal_trajectory(chain, plan, a,
                                    {.initial_velocities = {.1, 0, 0}, .curve = kind});
    });
    CHECK(message.find("duet: time_optimal_trajectory: joint 0 leaves its limits by 0.0") == 0);
    CHECK(message.find(" between waypoints 0 and 1 because of its velocity at an end") !=
          std::string::npos);
    CHECK(time_optimal_trajectory(plan, v, a, {.initial_velocities = {.1, 0, 0}, .curve = kind})
              .duration() > 0);
  }
  CHECK_THROWS_AS((void)time_optimal_trajectory(chain, std::vector<Eigen::Vector2d>{{0, 0}, {1, 1}},
                                                Eigen::Vector2d(1, 1)),
                  invalid_input);
}

} // namespace
} // namespace test_robotics_time_parametrised
