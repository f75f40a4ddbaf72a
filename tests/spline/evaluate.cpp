// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/identical.hpp"
#include "support/lanes.hpp"
#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/duet.hpp>

#include <span>

namespace test_spline_evaluate {
namespace {

using screw = duet::dual<double, 1, duet::screw_tag>;
using pose_type = duet::dual_quaternion<double>;
using cumulative = duet::cumulative_bspline<screw>;
using rotation_vector = duet::rotation_vector_spline<screw>;

template <class Spline>
Spline some_spline() {
  std::vector<double> u;
  std::vector<pose_type> samples;
  for (int i = 0; i <= 20; ++i) {
    u.push_back(i + 0.3 * std::sin(i));
    const duet::vector3<double> angles(0.3 * std::sin(i), 0.1 * i, 0.4 * std::cos(2 * i));
    samples.push_back(
        duet::pose(duet::from_rotation_vector(angles), duet::vector3<double>(i, std::sin(i), 0)));
  }
  return duet::interpolate<Spline>(u, samples, duet::not_a_knot{});
}

/// Increasing parameters with a few random ones among them.
std::vector<double> many_parameters() {
  duet_test::random_source random(3);
  std::vector<double> u;
  for (int i = 0; i < 1000; ++i) {
    u.push_back(i % 50 == 0 ? random.uniform(0, 20) : 0.02 * i);
  }
  return u;
}

TEST_CASE_TEMPLATE(
    "evaluate: many parameters give the results of single ones, with any number of threads", Spline,
    cumulative, rotation_vector) {
  const auto s = some_spline<Spline>();
  const auto u = many_parameters();
  std::vector<pose_type> poses(u.size());
  std::vector<duet::motion<screw>> motions(u.size());
  duet::evaluate(s, u, poses);
  duet::evaluate_motion(s, u, duet::frame::body, motions);
  double worst = 0; // in ulps: SIMD batches have sines other than the C library's
  const auto compare = [&](const auto& a, const auto& b) {
    worst = std::max(worst, duet_test::ulps_apart(a, b));
  };
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto m = s.motion(u[i], duet::frame::body);
    compare(poses[i], s(u[i]));
    compare(motions[i].value, m.value);
    compare(motions[i].velocity, m.velocity);
    compare(motions[i].acceleration, m.acceleration);
    compare(motions[i].jerk, m.jerk);
  }
  CHECK(worst <= 8 + duet_test::if_fused(8));
  for (const duet::execution how : {duet::execution{3}, duet::all_cores}) {
    std::vector<pose_type> poses_again(u.size());
    std::vector<duet::motion<screw>> again(u.size());
    duet::evaluate(s, u, poses_again, how);
    duet::evaluate_motion(s, u, duet::frame::body, again, how);
    bool are_same = true;
    for (std::size_t i = 0; i < u.size(); ++i) {
      are_same = are_same && poses_again[i] == poses[i] && again[i].value == motions[i].value &&
                 again[i].velocity == motions[i].velocity && again[i].jerk == motions[i].jerk;
    }
    CHECK(are_same);
  }
}

TEST_CASE("evaluate: a cancelled run reports how many results are complete") {
  const auto s = some_spline<cumulative>();
  const auto u = many_parameters();
  std::vector<pose_type> all(u.size()), out(u.size());
  duet::evaluate(s, u, all);
  const auto half = [](const duet::progress& p) { return p.share() < 0.5; };
  for (const unsigned threads : {1U, 3U}) {
    std::size_t completed = 0;
    try {
      duet::evaluate(s, u, out, {threads, half});
    } catch (const duet::cancelled& early) {
      completed = early.completed();
    }
    CHECK(completed >= u.size() / 2);
    CHECK(completed < u.size());
    bool are_same = true;
    for (std::size_t i = 0; i < completed; ++i) {
      are_same = are_same && out[i] == all[i];
    }
    CHECK(are_same);
  }
}

TEST_CASE("evaluate: errors name differing sizes and the first parameter outside the domain") {
  const auto s = some_spline<cumulative>();
  const auto message = [&](std::vector<double> u, std::size_t size, duet::execution how) {
    std::vector<pose_type> out(size);
    return duet_test::message_of([&] { duet::evaluate(s, u, out, how); });
  };
  CHECK(message({0, 1}, 3, duet::one_core) ==
        "duet: evaluate: 2 parameters, but room for 3 results");
  auto u = many_parameters();
  u[700] = 99;
  u[900] = -1;
  for (const duet::execution how : {duet::one_core, duet::execution{4}}) {
    CHECK(message(u, u.size(), how)
              .starts_with("duet: sample 700: spline evaluated at 99, outside its domain [0, "));
  }
}

TEST_CASE("evaluate: an error that single parameters do not reproduce is rethrown unchanged") {
  const std::vector<double> u = {0, 1, 2};
  const auto error_after = [&](const auto& f) {
    return duet_test::message_of([&] {
      try {
        throw duet::invalid_input("duet: error of a batch");
      } catch (const duet::invalid_input&) {
        duet::detail::rethrow_with_index(std::span<const double>(u), 1, f);
      }
    });
  };
  const auto at_two = [](double x, duet::span_hint&) {
    return x < 2 ? x : throw duet::invalid_input("duet: too far");
  };
  CHECK(error_after([](double x, duet::span_hint&) { return x; }) == "duet: error of a batch");
  CHECK(error_after(at_two) == "duet: sample 2: too far");
}

} // namespace
} // namespace test_spline_evaluate
