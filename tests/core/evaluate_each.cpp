// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/message.hpp"
#include "support/test.hpp"

#include <duet/core/batch/evaluate_each.hpp>
#include <duet/expression/elementary_functions.hpp>
#include <duet/expression/gradient.hpp>
#include <duet/expression/symbol.hpp>
#include <duet/quaternion/rotation.hpp>

namespace test_core_evaluate_each {
namespace {

std::vector<double> numbers(std::size_t size, double first) {
  std::vector<double> result(size);
  for (std::size_t i = 0; i < size; ++i) {
    result[i] = first + 0.37 * double(i);
  }
  return result;
}

TEST_CASE("evaluate_each: arrays of any length, on one core and several") {
  using namespace duet::expression;
  constexpr symbol<"u"> u;
  constexpr symbol<"w"> w;
  const auto formula = exp(-u) * sin(w * u);
  const auto f = [&](const auto& x, const auto& y) { return formula(u = x, w = y); };
  for (std::size_t size = 0; size < 40; ++size) {
    const std::vector<double> x = numbers(size, -1), y = numbers(size, 2);
    std::vector<double> one(size, -7), several(size, -7);
    duet::evaluate_each(f, one, x, y);
    duet::evaluate_each(duet::execution{2}, f, several, x, y);
    for (std::size_t i = 0; i < size; ++i) {
      CHECK(one[i] == doctest::Approx(f(x[i], y[i])).epsilon(1e-15));
      CHECK(several[i] == one[i]);
    }
    std::vector<double> alone(1);
    for (std::size_t i = 0; i < size; ++i) {
      duet::evaluate_each(f, alone, std::vector{x[i]}, std::vector{y[i]});
      CHECK(alone[0] == one[i]);
    }
  }
}

TEST_CASE("evaluate_each: rotations and vectors as results") {
  const std::array<double, 7> angles{0, .1, .2, 1, 2, 3, 4};
  std::array<duet::quaternion<double>, 7> rotations;
  duet::evaluate_each(
      [](const auto& x) { return duet::from_rotation_vector(duet::make_vector(x, 0, 0)); },
      rotations, angles);
  std::array<duet::vector3<double>, 7> vectors;
  duet::evaluate_each([](const auto& x) { return duet::make_vector(x, 2 * x, 1); }, vectors,
                      angles);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const auto expected = duet::from_rotation_vector(duet::vector3<double>(angles[i], 0, 0));
    CHECK(duet::norm(rotations[i] - expected) < 1e-15);
    CHECK(vectors[i] == duet::vector3<double>(angles[i], 2 * angles[i], 1));
  }
}

TEST_CASE("evaluate_each: arrays of other sizes") {
  std::vector<double> out(3);
  const auto f = [](const auto& x, const auto& y) { return x + y; };
  CHECK(duet_test::message_of<duet::invalid_input>([&] {
          duet::evaluate_each(f, out, std::vector<double>(3), std::vector<double>(4));
        }) == "duet: evaluate_each: 4 inputs, but room for 3 results");
}

} // namespace
} // namespace test_core_evaluate_each
