// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/mixed_arguments.hpp"
#include "support/test.hpp"

#include <duet/dual/math.hpp>

namespace test_dual_mixed_arguments {

using namespace test_support::mixed;

TEST_CASE("functions of several arguments: constants mix with derivatives") {
  using std::atan2, std::fdim, std::fma, std::fmax, std::fmin, std::fmod, std::hypot, std::pow,
      std::remainder;
  DUET_CHECK_MIXED(atan2, 0.7, -0.4);
  DUET_CHECK_MIXED(pow, 1.7, -0.4);
  DUET_CHECK_MIXED(hypot, 0.7, -0.4);
  DUET_CHECK_MIXED(hypot, 0.7, -0.4, 1.1);
  DUET_CHECK_MIXED(fma, 0.7, -0.4, 1.1);
  check(
      "fmod", [](const auto& x, const auto& y) { return fmod(x, y) * x * y; }, 2.7, 0.8);
  check(
      "remainder", [](const auto& x, const auto& y) { return remainder(x, y) * x * y; }, 2.7, 0.8);
  check(
      "fdim", [](const auto& x, const auto& y) { return fdim(x, y) * x * y; }, 2.7, 0.8);
  check(
      "fmin", [](const auto& x, const auto& y) { return fmin(x, y) * x * y; }, 2.7, 0.8);
  check(
      "fmax", [](const auto& x, const auto& y) { return fmax(x, y) * x * y; }, 2.7, 0.8);
  check(
      "lerp", [](const auto&... x) { return lerp(number(0) + x...); }, 0.7, -0.4, 0.3);
  check(
      "+ - * /", [](const auto& x, const auto& y) { return (x + y) * (x - y) / (x * y); }, 0.7,
      -0.4);
}

} // namespace test_dual_mixed_arguments
