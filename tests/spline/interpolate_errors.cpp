// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

#include <duet/spline/interpolate.hpp>

namespace test_spline_interpolate_errors {

using spline = duet::cumulative_bspline<double>;
using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;
using parameters = std::vector<double>;
using table = std::vector<quaternion>;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
const quaternion one(1);

/// Index of the invalid sample and the reason, as "index: reason".
std::string invalid_sample_of(const parameters& u, const table& q) {
  try {
    static_cast<void>(duet::interpolate<spline>(u, q));
  } catch (const duet::invalid_sample& e) {
    const std::string text = std::to_string(e.index()) + ": " + e.reason();
    CHECK(e.what() == "duet: sample " + text);
    return text;
  }
  return "no invalid sample";
}

template <class Exception, class Ends = duet::natural>
std::string message_of(const parameters& u, const table& q, const Ends& ends = {}) {
  try {
    static_cast<void>(duet::interpolate<spline>(u, q, ends));
  } catch (const Exception& e) {
    return e.what();
  }
  return "nothing was thrown";
}

} // namespace

TEST_CASE("interpolate: errors name orientations that no curve can pass through") {
  const parameters u = {0, 1, 2};
  CHECK(invalid_sample_of(u, {one, one, {0, not_a_number, 0, 0}}) ==
        "2: quaternion (0, nan, 0, 0) is not finite");
  CHECK(invalid_sample_of(u, {{infinity, 0, 0, 0}, one, one}) ==
        "0: quaternion (inf, 0, 0, 0) is not finite");
  CHECK(invalid_sample_of(u, {one, {0.5, 0.5, 0.5, 0}, one}) ==
        "1: quaternion (0.5, 0.5, 0.5, 0) has norm 0.866025, not 1");
  CHECK(invalid_sample_of(u, {one, {}, one}) == "1: quaternion (0, 0, 0, 0) has norm 0, not 1");
  CHECK(invalid_sample_of(u, {one, {1e200, 0, 0, 0}, one}) ==
        "1: quaternion (1e+200, 0, 0, 0) has norm 1e+200, not 1");
  CHECK(invalid_sample_of(u, {one, one, {0, 0, 0.6, 0.8}}) ==
        "2: half a turn from the sample before: both arcs are equally short");
}

TEST_CASE("interpolate: errors name parameters that do not increase or are not finite") {
  const table q = {one, one, one, one};
  CHECK(invalid_sample_of({0, 1, 1, 2}, q) ==
        "2: parameter 1 does not increase, the sample before has 1");
  CHECK(invalid_sample_of({0, 1, 0.5, 2}, q) ==
        "2: parameter 0.5 does not increase, the sample before has 1");
  CHECK(invalid_sample_of({0, 1, 2, not_a_number}, q) == "3: parameter nan is not finite");
  CHECK(invalid_sample_of({-infinity, 1, 2, 3}, q) == "0: parameter -inf is not finite");
}

TEST_CASE("interpolate: errors for too few samples and for differing numbers of parameters") {
  using duet::invalid_input;
  CHECK(message_of<invalid_input>({}, {}) == "duet: interpolate: needs 2 samples or more, got 0");
  CHECK(message_of<invalid_input>({1}, {one}) ==
        "duet: interpolate: needs 2 samples or more, got 1");
  CHECK(message_of<invalid_input>({1, 2, 3, 4}, {one, one, one, one, one}) ==
        "duet: interpolate: 4 parameters, but 5 samples");
  CHECK(message_of<invalid_input>({1, 2, 3}, {one, one, one}, duet::not_a_knot{}) ==
        "duet: interpolate: needs 4 samples or more with these end conditions, got 3");
  CHECK(message_of<invalid_input>({1, 2}, {one, one}, duet::periodic{}) ==
        "duet: interpolate: needs 3 samples or more with these end conditions, got 2");
}

TEST_CASE("interpolate: periodic ends require that the last sample repeats the first") {
  const quaternion rotated = normalized(quaternion(1, 0.001, 0, 0));
  CHECK(message_of<duet::invalid_sample>({1, 2, 3}, {one, rotated, rotated}, duet::periodic{}) ==
        "duet: sample 2: periodic ends: differs from sample 0 by 0.002 rad, but must repeat it");
  CHECK(message_of<duet::invalid_sample>({1, 2, 3}, {one, rotated, -one}, duet::periodic{}) ==
        "nothing was thrown");

  using pose = duet::dual_quaternion<double>;
  const std::vector<pose> poses = {pose(one), duet::pose(rotated, vector(1, 2, 3)),
                                   duet::pose(one, vector(0, 0.003, 0.004))};
  try {
    static_cast<void>(duet::interpolate<duet::cumulative_bspline<pose::scalar_type>>(
        parameters{1, 2, 3}, poses, duet::periodic{}));
    FAIL("nothing was thrown");
  } catch (const duet::invalid_sample& e) {
    CHECK(e.index() == 2);
    CHECK(e.reason() ==
          "periodic ends: differs from sample 0 by 0.005 in translation, but must repeat it");
  }
}

TEST_CASE("interpolate: errors name end rates that are not finite") {
  const duet::vector6<double> twist(0, 0, 1, infinity, 0, 0);
  CHECK_THROWS_WITH_AS(
      (duet::curve_ends<duet::screw_dual<double>>(
          duet::end_acceleration{twist, duet::vector6<double>(0 * twist)})),
      "duet: end_acceleration: the rate at the start, (0, 0, 1, inf, 0, 0), is not finite",
      duet::invalid_input);
  const vector zero = vector::Zero();
  const auto with = [&](const vector& start, const vector& end) -> std::string {
    try {
      static_cast<void>(duet::interpolate<spline>(parameters{0, 1, 2}, table{one, one, one},
                                                  duet::clamped{start, end}));
    } catch (const duet::invalid_input& e) {
      return e.what();
    }
    return "nothing was thrown";
  };
  CHECK(with(vector(0, not_a_number, 0), zero) ==
        "duet: clamped: the rate at the start, (0, nan, 0), is not finite");
  CHECK(with(zero, vector(infinity, 0, 0)) ==
        "duet: clamped: the rate at the end, (inf, 0, 0), is not finite");
}

TEST_CASE("interpolate: cubics reject velocities and accelerations at the same end") {
  const vector zero = vector::Zero();
  const duet::fully_clamped both{duet::clamped{zero, zero}, duet::end_acceleration{zero, zero}};
  CHECK(message_of<duet::invalid_input>({0, 1, 2}, {one, one, one}, both) ==
        "duet: interpolate: fully_clamped ends need a quintic (a cubic can meet velocities or "
        "accelerations, not both)");
}

TEST_CASE("interpolate: rotations of 3.1 rad at uneven parameters give a curve or an error with "
          "the reason") {
  int failures = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    const table q = duet_test::rotated_by(3.1, 20, seed);
    duet_test::random_source random(seed + 1000);
    parameters u = {0};
    while (u.size() < q.size()) {
      u.push_back(u.back() + random.uniform(0.2, 2));
    }
    const std::string message = message_of<duet::no_convergence>(u, q);
    if (message == "nothing was thrown") {
      continue;
    }
    ++failures;
    CHECK(message.starts_with(
        "duet: interpolate: a curve exists for the rotations between samples scaled by 0."));
    CHECK(message.find(", but continuation from it fails after ") != std::string::npos);
    CHECK(message.find(" iterations; the largest rotation is 3.1 rad, from sample ") !=
          std::string::npos);
  }
  CHECK(failures > 0);
  CHECK(failures <= 4);
}

} // namespace test_spline_interpolate_errors
