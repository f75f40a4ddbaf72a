// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/test.hpp"

#include <duet/comparison/domain.hpp>
#include <duet/comparison/rotations.hpp>
#include <duet/comparison/sampler.hpp>
#include <duet/core/errors.hpp>
#include <duet/interop/multiprecision.hpp>

#include <span>

// Points at which compared functions are evaluated.

namespace test_comparison_samplers {
namespace {

using duet::arrays, duet::coordinates, duet::quaternions, duet::real_50, duet::real_numbers,
    duet::rotations, duet::sampler, duet::vectors;

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

TEST_CASE("sampler: points of every domain are inside it") {
  check_domain(real_numbers{});
  check_domain(real_numbers{-0.19, 0.2});
  check_domain(vectors<3>{2});
  check_domain(arrays<4, vectors<2>>{{0.5}});
  check_domain(rotations{});
  check_domain(rotations{1.5});
  check_domain(quaternions{});
  check_domain(quaternions{1e140});
  check_domain(real_numbers{}.without(0).without(0.5, 0.1));
  check_domain(vectors<2>{2}.where([](const auto& v) { return v[0] > v[1]; }));
  check_domain(arrays<2, real_numbers>{}.without({0, 0}));
}

TEST_CASE("sampler: special points are those documented for each domain") {
  CHECK(has(real_numbers{-1, 1}.special_points(), {0}));
  CHECK(has(real_numbers{-1, 1}.special_points(), {1e-8}));
  CHECK(!has(real_numbers{0.1, 1}.special_points(), {0}));
  CHECK(has(vectors<2>{3}.special_points(), {0, 0}));
  CHECK(has(vectors<2>{3}.special_points(), {0, -3}));
  CHECK(has(rotations{}.special_points(), {0, 0, 0}));
  CHECK(has(rotations{}.special_points(), {0, 0, 3.141592653589793}));
  CHECK(!quaternions{}.contains(coordinates{0, 0, 0, 0}));
}

TEST_CASE("sampler: arguments are constructed in the requested precision") {
  const coordinates point = {0.3, -1.1, 0.7};
  const auto q = rotations{}.make<real_50>(point);
  CHECK(abs(real_50(squared_norm(q) - 1)) < real_50(1e-49));
  CHECK(std::abs(squared_norm(rotations{}.make<float>(point)) - 1) < 3e-7f);
  CHECK(rotations{}.make<double>(coordinates{0, 0, 0}).w() == 1);
  CHECK(vectors<3>{2}.make<double>(point) == Eigen::Vector3d(0.3, -1.1, 0.7));
  const auto pair = arrays<2, real_numbers>{}.make<double>(coordinates{0.25, 0.5});
  CHECK(pair == std::array{0.25, 0.5});
}

TEST_CASE(
    "sampler: few special points occur in all combinations, many in some, each in random company") {
  const auto few = sampler(real_numbers{}, real_numbers{}).points(0, 1);
  for (const coordinates& x : real_numbers{}.special_points()) {
    for (const coordinates& y : real_numbers{}.special_points()) {
      CHECK(has(few, {x[0], y[0]}));
    }
  }

  const auto many = sampler(rotations{}, rotations{}, rotations{}).points(0, 1);
  CHECK(has(many, coordinates(9, 0.0)));
  for (const coordinates& special : rotations{}.special_points()) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto has_special = [&](const coordinates& p) {
        return std::equal(special.begin(), special.end(), p.begin() + std::ptrdiff_t(3 * i));
      };
      CHECK(std::any_of(many.begin(), many.end(), has_special));
    }
  }
}

/// Checks that there are points at distances from `centre` of every decade from 1e-12 to 1e-3, on
/// both sides if both are in the domain.
template <class Domain>
void check_decades_near(const Domain& domain, const coordinates& centre, int sides = 2) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    std::array<std::array<int, 2>, 9> counts{};
    for (const coordinates& p : sampler(domain).points(1000, seed)) {
      double distance = 0, projection = 0;
      for (std::size_t i = 0; i < p.size(); ++i) {
        distance = std::hypot(distance, p[i] - centre[i]);
        projection += (p[i] - centre[i]) * (p.size() == 1 || i != 1 ? 1 : 0.7);
      }
      if (distance >= 1e-12 && distance < 1e-3) {
        ++counts[std::size_t(12 + std::floor(std::log10(distance)))][projection < 0 ? 1 : 0];
      }
    }
    for (const auto& decade : counts) {
      CHECK(decade[0] + decade[1] >= 2);
      CHECK(std::min(decade[0], decade[1]) >= (sides == 2 ? 1 : 0));
    }
  }
}

/// Checks that there are points within 1e-6 of `centre`.
template <class Domain>
void check_near(const Domain& domain, const coordinates& centre) {
  const auto points = sampler(domain).points(1000, 1);
  CHECK(std::count_if(points.begin(), points.end(), [&](const coordinates& p) {
          double distance = 0;
          for (std::size_t i = 0; i < p.size(); ++i) {
            distance = std::hypot(distance, p[i] - centre[i]);
          }
          return distance > 0 && distance < 1e-6;
        }) >= 2);
}

TEST_CASE("sampler: points near zero occur at every order of magnitude down to 1e-12") {
  check_decades_near(real_numbers{-2, 2}, {0});
  check_decades_near(real_numbers{-1e3, 1e3}, {0});
  check_decades_near(real_numbers{0, 2}, {0}, 1);
  check_decades_near(real_numbers{-2, 2}.without(0), {0});
  check_decades_near(vectors<2>{}, {0, 0});
  check_decades_near(vectors<3>{5}, {0, 0, 0});
  check_decades_near(rotations{}, {0, 0, 0});
  check_decades_near(quaternions{}, {0, 0, 0, 0});
  check_decades_near(arrays<1, vectors<2>>{}, {0, 0});
}

TEST_CASE("sampler: points near the other special points occur within 1e-6") {
  const double pi = 3.141592653589793;
  for (const double x : {-4.0, 4.0, 1.0, -1.0, 0.5, 2.0, pi, -pi, pi / 2}) {
    check_near(real_numbers{-4, 4}, {x});
  }
  check_near(real_numbers{5, 6}, {5});
  check_near(vectors<3>{4}, {pi, 0, 0});
  check_near(rotations{}, {0, pi, 0});
  check_near(rotations{}, {0, 0, 6.283185});
  check_near(quaternions{1}, {-1, 0, 0, 0});
  check_near(quaternions{1}, {0, 1, 0, 0});
}

TEST_CASE("sampler: some components are zero or equal while others are not") {
  const auto points = sampler(vectors<3>{}).points(1000, 1);
  const auto count = [&](const auto& is) {
    return std::count_if(points.begin(), points.end(), is);
  };
  CHECK(count([](const auto& p) { return p[1] == 0 && p[0] != 0 && p[2] != 0; }) > 5);
  CHECK(count([](const auto& p) { return p[1] == p[2] && p[0] != p[1] && p[1] != 0; }) > 5);
  CHECK(count([](const auto& p) { return p[0] == -p[2] && p[0] != p[1] && p[0] != 0; }) > 5);
}

/// The components of q_i* q_j for rotations i and j of each point.
template <class Inputs>
std::vector<duet::quaternion<double>> relative(const Inputs& inputs, std::size_t samples,
                                               std::size_t i, std::size_t j) {
  std::vector<duet::quaternion<double>> result;
  for (const coordinates& p : inputs.points(samples, 1)) {
    const auto at = [&](std::size_t k) {
      return rotations{}.make<double>(std::span(p).subspan(3 * k, 3));
    };
    result.push_back(conj(at(i)) * at(j));
  }
  return result;
}

TEST_CASE("sampler: equal, nearly equal and opposite arguments occur for any number of arguments") {
  const auto check = [](const auto& inputs, std::size_t arguments) {
    for (std::size_t j = 1; j < arguments; ++j) {
      for (std::size_t i = 0; i < j; ++i) {
        int equal = 0, nearly = 0, half_turn = 0, opposite = 0;
        for (const auto& q : relative(inputs, 0, i, j)) {
          const double s = std::hypot(q.x(), q.y(), q.z());
          equal += s < 1e-15 ? 1 : 0;
          nearly += s > 1e-13 && s < 1e-3 && q.w() > 0 ? 1 : 0;
          half_turn += std::abs(q.w()) < 1e-3 ? 1 : 0;
          opposite += s < 1e-3 && q.w() < 0 ? 1 : 0;
        }
        CHECK(equal >= 1);
        CHECK(nearly >= 2);
        CHECK(half_turn >= 1);
        CHECK(opposite >= 1);
      }
    }
  };
  check(sampler(rotations{}, rotations{}), 2);
  check(sampler(rotations{}, rotations{}, rotations{}), 3);
  check(sampler(rotations{}, rotations{}, rotations{}, rotations{}), 4);
  check(sampler(arrays<3, rotations>{}), 3);
  check(sampler(rotations{}.without({0, 0, 0}), arrays<2, rotations>{}), 3);

  const auto points =
      sampler(real_numbers{-9, 9}, real_numbers{}, real_numbers{-9, 9}).points(1000, 1);
  const auto count = [&](const auto& is) {
    return std::count_if(points.begin(), points.end(), is);
  };
  CHECK(count([](const auto& p) { return p[0] == p[2] && p[0] != p[1] && p[0] != 0; }) > 5);
  CHECK(count([](const auto& p) { return p[0] == p[1] && p[1] != p[2]; }) > 5);
  CHECK(count([](const auto& p) { return p[0] == -p[1] && p[1] != 0; }) > 2);
  CHECK(count([](const auto& p) {
          return p[0] != p[2] && std::abs(p[0] - p[2]) < 1e-6 && std::abs(p[0]) > 1e-3;
        }) > 10);
  CHECK(count([](const auto& p) { return p[0] == p[1] && p[1] == p[2] && p[0] != 0; }) > 5);
  const double pi = 3.141592653589793;
  CHECK(count([&](const auto& p) { return std::abs(std::abs(p[0] - p[2]) - pi) < 1e-15; }) > 0);

  const auto pairs = sampler(vectors<3>{2}, vectors<3>{1}).points(1000, 1);
  const auto sine = [](const coordinates& p) { // of the angle between both
    const Eigen::Vector3d a(p[0], p[1], p[2]), b(p[3], p[4], p[5]);
    const double lengths = a.norm() * b.norm();
    return lengths > 1e-3 ? a.cross(b).norm() / lengths : 1.0;
  };
  const auto cosine = [](const coordinates& p) {
    const Eigen::Vector3d a(p[0], p[1], p[2]), b(p[3], p[4], p[5]);
    const double lengths = a.norm() * b.norm();
    return lengths > 1e-3 ? std::abs(a.dot(b)) / lengths : 1.0;
  };
  const auto among = [&](const auto& f, double smallest, double largest) {
    return std::count_if(pairs.begin(), pairs.end(),
                         [&](const coordinates& p) { return f(p) >= smallest && f(p) < largest; });
  };
  CHECK(among(sine, 0, 1e-15) > 5);
  CHECK(among(sine, 1e-12, 1e-4) > 5);
  CHECK(among(cosine, 0, 1e-12) > 5);
}

TEST_CASE("sampler: excluded points never occur") {
  const auto check = [](const auto& inputs, const auto& is_excluded) {
    for (const coordinates& p : inputs.points(1000, 1)) {
      CHECK(!is_excluded(p));
    }
  };
  const auto is_zero = [](const coordinates& p) { return p[0] == 0; };
  check(sampler(real_numbers{}.without(0)), is_zero);
  check(sampler(real_numbers{}.without(0), real_numbers{}), is_zero);
  check(sampler(real_numbers{}).without({0}), is_zero);
  check(sampler(real_numbers{}.without(0.5, 0.25)),
        [](const coordinates& p) { return std::abs(p[0] - 0.5) <= 0.25; });
  check(sampler(real_numbers{}.where([](double x) { return x < 0.5; }).without(0)),
        [](const coordinates& p) { return p[0] >= 0.5 || p[0] == 0; });
  check(sampler(real_numbers{}, real_numbers{}).where([](double x, double y) { return x != y; }),
        [](const coordinates& p) { return p[0] == p[1]; });
  check(sampler(vectors<2>{}.without({0, 0}, 1e-3)),
        [](const coordinates& p) { return std::hypot(p[0], p[1]) <= 1e-3; });
  check(sampler(rotations{}.where([](const auto& q) { return std::abs(q.w()) > 1e-6; })),
        [](const coordinates& p) {
          return std::abs(std::hypot(p[0], p[1], p[2]) - 3.141592653589793) < 1e-7;
        });
  check(sampler(arrays<2, real_numbers>{{-1, 1}}.where([](const auto& x) { return x[0] < x[1]; })),
        [](const coordinates& p) { return p[0] >= p[1]; });
  check(sampler(quaternions{}.without({1, 0, 0, 0}, 0.5)), [](const coordinates& p) {
    return std::hypot(std::hypot(p[0] - 1, p[1]), p[2], p[3]) <= 0.5;
  });
}

TEST_CASE("sampler: invalid exclusions throw invalid_input") {
  const auto points_of = [](const auto& inputs) {
    return [inputs] { static_cast<void>(inputs.points(10, 1)); };
  };
  CHECK_THROWS_AS(points_of(sampler(real_numbers{}.without(0, 2)))(), duet::invalid_input);
  CHECK_THROWS_AS(points_of(sampler(vectors<2>{}).without({0, 0}, 9))(), duet::invalid_input);
  CHECK_THROWS_WITH_AS(
      points_of(sampler(arrays<1, real_numbers>{{1, 1}}.where([](auto) { return false; })))(),
      "duet: sampler: 1000 random inputs in a row are excluded, the last {1}", duet::invalid_input);
  CHECK_THROWS_WITH_AS(
      points_of(
          sampler(real_numbers{1, 1}, real_numbers{2, 2}).named("a", "b").where([](auto a, auto b) {
            return a == b;
          }))(),
      "duet: sampler: 1000 random inputs in a row are excluded, the last a = 1, b = 2",
      duet::invalid_input);
  DUET_CHECK_REFUSED("duet: sampler: the point has 2 coordinates, but the arguments have 3",
                     vectors<3>{}.without({0, 0}));
  DUET_CHECK_REFUSED("duet: sampler: the radius is not a number >= 0: -1",
                     sampler(real_numbers{}).without({0}, -1));
  DUET_CHECK_REFUSED("duet: sampler: the point (0) is outside the domain of the arguments",
                     sampler(real_numbers{}.without(0)).including({0}));
}

TEST_CASE("sampler: random points follow the special ones and are reproduced by the seed") {
  const auto inputs = sampler(real_numbers{}, vectors<3>{});
  CHECK(inputs.points(2000, 1).size() == inputs.points(1000, 1).size() + 1000);
  CHECK(inputs.points(1000, 1).size() > 1000);
  CHECK(inputs.points(1000, 1) == inputs.points(1000, 1));
  CHECK(inputs.points(1000, 1) != inputs.points(1000, 2));
}

TEST_CASE("sampler: points of the caller come first") {
  const auto inputs = sampler(real_numbers{0, 2}, vectors<2>{}).including({1.5, 0.25, 0.75});
  CHECK(inputs.points(10, 1).front() == coordinates{1.5, 0.25, 0.75});
  const auto [x, v] = inputs.make<double>(inputs.points(10, 1).front());
  CHECK(x == 1.5);
  CHECK(v == Eigen::Vector2d(0.25, 0.75));
  DUET_CHECK_REFUSED("duet: sampler: the point has 1 coordinates, but the arguments have 3",
                     inputs.including({1.5}));
  DUET_CHECK_REFUSED("duet: sampler: the point (2.5, 0, 0) is outside the domain of the arguments",
                     inputs.including({2.5, 0, 0}));
}

TEST_CASE("sampler: points are described by name and coordinates") {
  const coordinates point = {0.5, 0, 0, 1, 2, -2};
  CHECK(sampler(real_numbers{}, rotations{}, arrays<2, real_numbers>{{-3, 3}}).describe(point) ==
        "x1 = 0.5, x2 = rotation by (0, 0, 1), x3 = {2, -2}");
  CHECK(sampler(real_numbers{}).describe(coordinates{0.1}) == "x = 0.1");
  CHECK(sampler(quaternions{}).named("q").describe(coordinates{1, 0, 0, 0.5}) ==
        "q = (1, 0, 0, 0.5)");
}

} // namespace
} // namespace test_comparison_samplers
