// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "spline/curves.hpp"

namespace test_spline_interpolate_errors {
namespace {

using cumulative = duet::cumulative_bspline<double>;
using cubic = duet::rotation_vector_spline<double>;
using quintic = duet::rotation_vector_spline<double, 6>;
using quaternion = duet::quaternion<double>;
using vector = duet::vector3<double>;
using parameters = std::vector<double>;
using table = std::vector<quaternion>;
using ends = duet::curve_ends<double>;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
const quaternion one(1);
const vector zero = vector::Zero();

template <class Spline = cumulative, class Error = duet::invalid_input>
std::string error_of(const parameters& u, const table& q, const ends& at_ends = duet::natural{}) {
  return duet_test::message_of<Error>([&] { (void)duet::interpolate<Spline>(u, q, at_ends); });
}

TEST_CASE("interpolate: errors name samples that no curve can pass through, and their number") {
  struct row {
    parameters u;
    table q;
    std::string message;
  };
  const parameters u = {0, 1, 2};
  const table four(4, one);
  for (const row& each : std::initializer_list<row>{
           {u,
            {one, one, {0, not_a_number, 0, 0}},
            "sample 2: quaternion (0, nan, 0, 0) is not finite"},
           {u,
            {{infinity, 0, 0, 0}, one, one},
            "sample 0: quaternion (inf, 0, 0, 0) is not finite"},
           {u,
            {one, {0.5, 0.5, 0.5, 0}, one},
            "sample 1: quaternion (0.5, 0.5, 0.5, 0) has norm 0.866025, not 1"},
           {u, {one, {}, one}, "sample 1: quaternion (0, 0, 0, 0) has norm 0, not 1"},
           {u,
            {one, {1e200, 0, 0, 0}, one},
            "sample 1: quaternion (1e+200, 0, 0, 0) has norm 1e+200, not 1"},
           {u,
            {one, one, {0, 0, 0.6, 0.8}},
            "sample 2: half a turn from the sample before: both arcs are equally short"},
           {{0, 1, 1, 2}, four, "sample 2: parameter 1 does not increase, the sample before has 1"},
           {{0, 1, 0.5, 2},
            four,
            "sample 2: parameter 0.5 does not increase, the sample before has 1"},
           {{0, 1, 2, not_a_number}, four, "sample 3: parameter nan is not finite"},
           {{-infinity, 1, 2, 3}, four, "sample 0: parameter -inf is not finite"},
           {{}, {}, "interpolate: needs 2 samples or more, got 0"},
           {{1}, {one}, "interpolate: needs 2 samples or more, got 1"},
           {{1, 2, 3, 4, 5}, four, "interpolate: 5 parameters, but 4 samples"}}) {
    CAPTURE(each.message);
    CHECK(error_of<cumulative>(each.u, each.q) == "duet: " + each.message);
    CHECK(error_of<cubic>(each.u, each.q) == "duet: " + each.message);
    CHECK(error_of<quintic>(each.u, each.q) == "duet: " + each.message);
  }
  try {
    (void)duet::interpolate<cumulative>(u, table{one, {}, one});
    FAIL("nothing was thrown");
  } catch (const duet::invalid_sample& e) {
    CHECK(e.index() == 1);
    CHECK(e.reason() == "quaternion (0, 0, 0, 0) has norm 0, not 1");
  }
}

TEST_CASE("interpolate: end conditions need samples enough, and rates that are finite") {
  const auto few = [](int needed, int got) {
    return "duet: interpolate: needs " + std::to_string(needed) +
           " samples or more with these end conditions, got " + std::to_string(got);
  };
  CHECK(error_of({1, 2, 3}, table(3, one), duet::not_a_knot{}) == few(4, 3));
  CHECK(error_of({1, 2}, table(2, one), duet::periodic{}) == few(3, 2));
  CHECK(error_of<cubic>({1, 2, 3}, table(3, one), duet::not_a_knot{}) == few(4, 3));
  CHECK(error_of<quintic>({1, 2, 3, 4, 5}, table(5, one), duet::not_a_knot{}) == few(6, 5));
  CHECK(error_of<quintic>({1, 2, 3}, table(3, one), duet::clamped{zero, zero}) == few(4, 3));
  const auto of_rates = [](const vector& start, const vector& end) {
    return duet_test::message_of([&] { (void)ends(duet::clamped{start, end}); });
  };
  CHECK(of_rates(vector(0, not_a_number, 0), zero) ==
        "duet: clamped: the rate at the start, (0, nan, 0), is not finite");
  CHECK(of_rates(zero, vector(infinity, 0, 0)) ==
        "duet: clamped: the rate at the end, (inf, 0, 0), is not finite");
  const duet::vector6<double> twist(0, 0, 1, infinity, 0, 0);
  CHECK_THROWS_WITH_AS(
      (duet::curve_ends<duet::screw_dual<double>>(
          duet::end_acceleration{twist, duet::vector6<double>(0 * twist)})),
      "duet: end_acceleration: the rate at the start, (0, 0, 1, inf, 0, 0), is not finite",
      duet::invalid_input);
  const duet::fully_clamped both{duet::clamped{zero, zero}, duet::end_acceleration{zero, zero}};
  CHECK(error_of({0, 1, 2}, table(3, one), both) ==
        "duet: interpolate: fully_clamped ends need a quintic (a cubic can meet velocities or "
        "accelerations, not both)");
}

TEST_CASE("interpolate: periodic ends require that the last sample repeats the first") {
  const quaternion rotated = normalized(quaternion(1, 0.001, 0, 0));
  const std::string differs =
      "duet: sample 2: periodic ends: differs from sample 0 by 0.002 rad, but must repeat it";
  CHECK(error_of({1, 2, 3}, {one, rotated, rotated}, duet::periodic{}) == differs);
  CHECK(error_of<cubic>({1, 2, 3}, {one, rotated, rotated}, duet::periodic{}) == differs);
  CHECK(error_of({1, 2, 3}, {one, rotated, -one}, duet::periodic{}) == "");

  using pose = duet::dual_quaternion<double>;
  const std::vector<pose> poses = {pose(one), duet::pose(rotated, vector(1, 2, 3)),
                                   duet::pose(one, vector(0, 0.003, 0.004))};
  CHECK_THROWS_WITH_AS(
      (void)duet::interpolate<duet::cumulative_bspline<pose::scalar_type>>(parameters{1, 2, 3},
                                                                           poses, duet::periodic{}),
      "duet: sample 2: periodic ends: differs from sample 0 by 0.005 in translation, but must "
      "repeat it",
      duet::invalid_sample);
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
    const std::string message = error_of<cumulative, duet::no_convergence>(u, q);
    if (message.empty()) {
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

TEST_CASE("rotation_vector_spline: errors name rates and parameters that give no curve") {
  const auto of_rates = [](const std::vector<std::array<vector, 2>>& rates) {
    return duet_test::message_of([&] { quintic({0, 1}, {one, one}, rates); });
  };
  CHECK(of_rates({{zero, zero}}).find("2 samples need 2 rates, got 1") != std::string::npos);
  for (const double x : {not_a_number, infinity}) {
    for (const std::size_t i : {0, 1}) {
      std::vector<std::array<vector, 2>> rates(2, {zero, zero});
      rates[i][1 - i][2] = x;
      CHECK(of_rates(rates) == "duet: sample " + std::to_string(i) + ": a rate is not finite");
    }
  }
  const auto over = [](double from, double to) {
    return duet_test::message_of([&] {
      (void)cubic::from_pieces({from, to}, {one, one}, {{zero, zero, zero, zero}});
    });
  };
  CHECK(over(0, 1) == "");
  CHECK(over(0, 5e-324) ==
        "duet: rotation_vector_spline: parameter 0 = 0 and parameter 1 = 4.94066e-324 are too "
        "close: a derivative overflows");
  CHECK(over(0, 1e-102) == "");
  CHECK(over(0, 1e-104).ends_with("are too close: a derivative overflows"));
  CHECK(over(0, 1e102) == "");
  CHECK(over(0, 1e104).ends_with("are too far apart: a derivative underflows"));
  CHECK(over(-1.7e308, 1.7e308) ==
        "duet: rotation_vector_spline: the distance from -1.7e+308 to 1.7e+308 overflows");
}

} // namespace
} // namespace test_spline_interpolate_errors
