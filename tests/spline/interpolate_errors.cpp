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
  } catch (const duet::invalid_row& e) {
    const std::string text = std::to_string(e.row()) + ": " + e.reason();
    CHECK(e.what() == "duet: row " + text);
    return text;
  }
  return "no row";
}

template <class Exception>
std::string message_of(const parameters& u, const table& q) {
  try {
    static_cast<void>(duet::interpolate<spline>(u, q));
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
  CHECK(message_of<invalid_input>({}, {}) == "duet: interpolate: needs two rows or more, each a "
                                             "parameter and an orientation, got 0 and 0");
  CHECK(message_of<invalid_input>({1}, {one}) == "duet: interpolate: needs two rows or more, each "
                                                 "a parameter and an orientation, got 1 and 1");
  CHECK(message_of<invalid_input>({1, 2, 3}, {one, one}) ==
        "duet: interpolate: needs two rows or more, each a parameter and an orientation, got 3 and "
        "2");
}

TEST_CASE("rates that are not finite") {
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
        "duet: clamped: the angular velocity at the start, (0, nan, 0), is not finite");
  CHECK(with(zero, vector(infinity, 0, 0)) ==
        "duet: clamped: the angular velocity at the end, (inf, 0, 0), is not finite");
}

TEST_CASE("neighbours nearly half a turn apart, on random axes: no curve, and a word why") {
  int failures = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const table q = duet_test::turned_by(3.1, 30, seed);
    parameters u;
    while (u.size() < q.size()) {
      u.push_back(double(u.size()));
    }
    const std::string message = message_of<duet::no_convergence>(u, q);
    if (message == "nothing was thrown") {
      const spline s = duet::interpolate<spline>(u, q); // then it is one
      for (std::size_t i = 0; i < u.size(); ++i) {
        const quaternion at = s(u[i]);
        CHECK(std::min(duet_test::distance(at, q[i]), duet_test::distance(at, -q[i])) < 1e-13);
      }
      continue;
    }
    ++failures;
    CHECK(message.starts_with("duet: interpolate: Newton's method "));
    CHECK(message.find(" iterations, last step ") != std::string::npos);
    CHECK(message.ends_with(" rad; neighbouring orientations may be too far apart"));
  }
  CHECK(failures > 5);
}

} // namespace test_spline_interpolate_errors
