// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include <duet/comparison/domain.hpp>
#include <duet/comparison/rotations.hpp>
#include <duet/comparison/sampler.hpp>
#include <duet/core/errors.hpp>
#include <duet/interop/multiprecision.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

// Where compared functions are evaluated.

namespace test_comparison_samplers {

using duet::arrays;
using duet::coordinates;
using duet::quaternions;
using duet::real_50;
using duet::real_numbers;
using duet::rotations;
using duet::sampler;
using duet::vectors;

namespace {

template <class Domain>
void check_domain(const Domain& domain) {
  static_assert(duet::InputDomain<Domain>);
  duet::random_source random(1);
  std::vector<coordinates> points = domain.special_points();
  CHECK(!points.empty());
  for (int i = 0; i < 1000; ++i) {
    points.push_back(domain.random_point(random));
  }
  for (const coordinates& point : points) {
    CHECK(point.size() == domain.size());
    CHECK(domain.contains(point));
  }
}

bool has(const std::vector<coordinates>& points, const coordinates& point) {
  return std::find(points.begin(), points.end(), point) != points.end();
}

} // namespace

TEST_CASE("points of every domain are inside it") {
  check_domain(real_numbers{});
  check_domain(real_numbers{-0.19, 0.2});
  check_domain(vectors<3>{2});
  check_domain(arrays<4, vectors<2>>{{0.5}});
  check_domain(rotations{});
  check_domain(rotations{1.5});
  check_domain(quaternions{});
  check_domain(quaternions{1e140});
}

TEST_CASE("special points") {
  CHECK(has(real_numbers{-1, 1}.special_points(), {0}));
  CHECK(has(real_numbers{-1, 1}.special_points(), {1e-8}));
  CHECK(!has(real_numbers{0.1, 1}.special_points(), {0}));
  CHECK(has(vectors<2>{3}.special_points(), {0, 0}));
  CHECK(has(vectors<2>{3}.special_points(), {0, -3}));
  CHECK(has(rotations{}.special_points(), {0, 0, 0}));
  CHECK(has(rotations{}.special_points(), {0, 0, 3.141592653589793}));
  CHECK(!quaternions{}.contains(coordinates{0, 0, 0, 0}));
}

TEST_CASE("arguments are made in the precision they are asked for") {
  const coordinates point = {0.3, -1.1, 0.7};
  const auto q = rotations{}.make<real_50>(point);
  CHECK(abs(real_50(norm2(q) - 1)) < real_50(1e-49));
  CHECK(std::abs(norm2(rotations{}.make<float>(point)) - 1) < 3e-7f);
  CHECK(rotations{}.make<double>(coordinates{0, 0, 0}).w() == 1);
  CHECK(vectors<3>{2}.make<double>(point) == Eigen::Vector3d(0.3, -1.1, 0.7));
  const auto pair = arrays<2, real_numbers>{}.make<double>(coordinates{0.25, 0.5});
  CHECK(pair == std::array{0.25, 0.5});
}

TEST_CASE("few special points come in all combinations, many with random company") {
  const auto few = sampler(real_numbers{}, real_numbers{}).points(0, 1);
  const std::size_t one = real_numbers{}.special_points().size();
  CHECK(few.size() == one * one);
  CHECK(has(few, {0, 0}));
  CHECK(has(few, {1e-8, -1}));

  const auto many = sampler(rotations{}, rotations{}, rotations{}).points(0, 1);
  CHECK(many.size() == 3 * rotations{}.special_points().size());
  const auto third_is_identity = [](const coordinates& p) {
    return p[6] == 0 && p[7] == 0 && p[8] == 0 && p[0] != 0;
  };
  CHECK(std::any_of(many.begin(), many.end(), third_is_identity));
}

TEST_CASE("random points come after the special ones, and repeat with the seed") {
  const auto inputs = sampler(real_numbers{}, vectors<3>{});
  CHECK(inputs.points(1000, 1).size() == inputs.points(0, 1).size() + 1000);
  CHECK(inputs.points(1000, 1) == inputs.points(1000, 1));
  CHECK(inputs.points(1000, 1) != inputs.points(1000, 2));
}

TEST_CASE("points of the caller come first") {
  const auto inputs = sampler(real_numbers{0, 2}, vectors<2>{}).including({1.5, 0.25, 0.75});
  CHECK(inputs.points(10, 1).front() == coordinates{1.5, 0.25, 0.75});
  const auto [x, v] = inputs.make<double>(inputs.points(10, 1).front());
  CHECK(x == 1.5);
  CHECK(v == Eigen::Vector2d(0.25, 0.75));
  CHECK_THROWS_WITH_AS(static_cast<void>(inputs.including({1.5})),
                       "duet: sampler: a point of 1 coordinates, but the arguments have 3",
                       duet::invalid_input);
  CHECK_THROWS_WITH_AS(
      static_cast<void>(inputs.including({2.5, 0, 0})),
      "duet: sampler: the point (2.5, 0, 0) is outside the domain of the arguments",
      duet::invalid_input);
}

TEST_CASE("descriptions") {
  const coordinates point = {0.5, 0, 0, 1, 2, -2};
  CHECK(sampler(real_numbers{}, rotations{}, arrays<2, real_numbers>{{-3, 3}}).describe(point) ==
        "x1 = 0.5, x2 = rotation by (0, 0, 1), x3 = {2, -2}");
  CHECK(sampler(real_numbers{}).describe(coordinates{0.1}) == "x = 0.1");
  CHECK(sampler(quaternions{}).named("q").describe(coordinates{1, 0, 0, 0.5}) ==
        "q = (1, 0, 0, 0.5)");
}

} // namespace test_comparison_samplers
