// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

#include <duet/spline/interpolate.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

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

/// The row that is to blame and the reason, as "row: reason".
std::string bad_row(const parameters& u, const table& q) {
  try {
    static_cast<void>(duet::interpolate<spline>(u, q));
  } catch (const duet::invalid_sample& e) {
    const std::string text = std::to_string(e.row()) + ": " + e.reason();
    CHECK(e.what() == "duet: row " + text);
    return text;
  }
  return "no row";
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

TEST_CASE("orientations that no curve goes through") {
  const parameters u = {0, 1, 2};
  CHECK(bad_row(u, {one, one, {0, not_a_number, 0, 0}}) ==
        "2: quaternion (0, nan, 0, 0) is not finite");
  CHECK(bad_row(u, {{infinity, 0, 0, 0}, one, one}) ==
        "0: quaternion (inf, 0, 0, 0) is not finite");
  CHECK(bad_row(u, {one, {0.5, 0.5, 0.5, 0}, one}) ==
        "1: quaternion (0.5, 0.5, 0.5, 0) has norm 0.866025, not 1");
  CHECK(bad_row(u, {one, {}, one}) == "1: quaternion (0, 0, 0, 0) has norm 0, not 1");
  CHECK(bad_row(u, {one, {1e200, 0, 0, 0}, one}) ==
        "1: quaternion (1e+200, 0, 0, 0) has norm 1e+200, not 1");
  CHECK(bad_row(u, {one, one, {0, 0, 0.6, 0.8}}) ==
        "2: half a turn from the row before: either way round is as short");
}

TEST_CASE("parameters that do not increase") {
  const table q = {one, one, one, one};
  CHECK(bad_row({0, 1, 1, 2}, q) == "2: parameter 1 does not increase, the row before has 1");
  CHECK(bad_row({0, 1, 0.5, 2}, q) == "2: parameter 0.5 does not increase, the row before has 1");
  CHECK(bad_row({0, 1, 2, not_a_number}, q) == "3: parameter nan is not finite");
  CHECK(bad_row({-infinity, 1, 2, 3}, q) == "0: parameter -inf is not finite");
}

TEST_CASE("too few rows, and columns of different length") {
  using duet::invalid_input;
  CHECK(message_of<invalid_input>({}, {}) == "duet: interpolate: needs 2 rows or more, got 0");
  CHECK(message_of<invalid_input>({1}, {one}) == "duet: interpolate: needs 2 rows or more, got 1");
  CHECK(message_of<invalid_input>({1, 2, 3, 4}, {one, one, one, one, one}) ==
        "duet: interpolate: 4 parameters, but 5 rows");
  CHECK(message_of<invalid_input>({1, 2, 3}, {one, one, one}, duet::not_a_knot{}) ==
        "duet: interpolate: needs 4 rows or more with these ends, got 3");
  CHECK(message_of<invalid_input>({1, 2}, {one, one}, duet::periodic{}) ==
        "duet: interpolate: needs 3 rows or more with these ends, got 2");
}

TEST_CASE("periodic ends that do not meet") {
  const quaternion turned = normalized(quaternion(1, 0.001, 0, 0));
  CHECK(message_of<duet::invalid_sample>({1, 2, 3}, {one, turned, turned}, duet::periodic{}) ==
        "duet: row 2: periodic ends: differs from row 0 by 0.002 rad, but must repeat it");
  CHECK(message_of<duet::invalid_sample>({1, 2, 3}, {one, turned, -one}, duet::periodic{}) ==
        "nothing was thrown");

  using pose = duet::dual_quaternion<double>;
  const std::vector<pose> poses = {pose(one), duet::pose(turned, vector(1, 2, 3)),
                                   duet::pose(one, vector(0, 0.003, 0.004))};
  try {
    static_cast<void>(duet::interpolate<duet::cumulative_bspline<pose::scalar_type>>(
        parameters{1, 2, 3}, poses, duet::periodic{}));
    FAIL("nothing was thrown");
  } catch (const duet::invalid_sample& e) {
    CHECK(e.row() == 2);
    CHECK(e.reason() ==
          "periodic ends: differs from row 0 by 0.005 in translation, but must repeat it");
  }
}

TEST_CASE("rates that are not finite") {
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

TEST_CASE("cubics cannot be told velocities and accelerations") {
  const vector zero = vector::Zero();
  const duet::fully_clamped both{duet::clamped{zero, zero}, duet::end_acceleration{zero, zero}};
  CHECK(message_of<duet::invalid_input>({0, 1, 2}, {one, one, one}, both) ==
        "duet: interpolate: a cubic's ends take velocities or accelerations, not both");
}

TEST_CASE("neighbours far apart at uneven parameters: a curve, or a word why not") {
  int failures = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    const table q = duet_test::turned_by(3.1, 20, seed);
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
    CHECK(message.starts_with("duet: interpolate: with all steps between rows turning by no more "
                              "than 0."));
    CHECK(message.find(" of their angles there is a curve, but none was found that goes on from "
                       "there; after ") != std::string::npos);
    CHECK(message.find(" iterations. The largest step is 3.1 rad, from row ") != std::string::npos);
  }
  CHECK(failures > 0);
  CHECK(failures <= 4);
}

} // namespace test_spline_interpolate_errors
