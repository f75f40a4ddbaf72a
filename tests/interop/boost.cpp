// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/test.hpp"

#include <duet/interop/boost.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>

// boost::math::quaternion is the same algebra, over any real number.

namespace test_interop_boost {

using duet::quaternion;
using duet_test::random_source;

TEST_CASE_TEMPLATE("to_boost and from_boost: conversion there and back changes nothing", T, float,
                   double, long double, duet_test::real_50) {
  const quaternion<T> q(T(1), T(2), T(3), T(4));
  const boost::math::quaternion<T> b = duet::to_boost(q);
  CHECK(b.R_component_1() == 1);
  CHECK(b.R_component_4() == 4);
  CHECK(duet::from_boost(b) == q);
}

TEST_CASE("boost::math::quaternion: products, quotients, norms, exponentials and powers agree") {
  random_source random(1);
  const auto random_quaternion = [&] {
    return quaternion<double>(random.normal(), random.normal(), random.normal(), random.normal());
  };
  for (int i = 0; i < 100; ++i) {
    const auto p = random_quaternion();
    const auto q = random_quaternion();
    const auto bp = duet::to_boost(p);
    const auto bq = duet::to_boost(q);
    CHECK(norm(duet::from_boost(bp * bq) - p * q) <= 1e-14);
    CHECK(norm(duet::from_boost(bp / bq) - p * inverse(q)) <= 1e-14 * norm(p) / norm(q));
    CHECK(duet::from_boost(boost::math::conj(bp)) == conj(p));
    CHECK(boost::math::abs(bp) == doctest::Approx(norm(p)).epsilon(1e-15));
    CHECK(boost::math::norm(bp) == doctest::Approx(squared_norm(p)).epsilon(1e-15)); // Cayley's
    CHECK(norm(duet::from_boost(boost::math::exp(bp)) - exp(p)) <= 1e-14 * norm(exp(p)));
    CHECK(norm(duet::from_boost(boost::math::pow(bp, 3)) - pow(p, 3)) <= 1e-14 * norm(pow(p, 3)));
  }
}

} // namespace test_interop_boost
