// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "support/multiprecision.hpp"
#include "support/random.hpp"
#include "support/test.hpp"
#include "support/ulp.hpp"

#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/core/compiler/vector.hpp>

#include <boost/math/constants/constants.hpp>

#include <bit>

namespace test_core_vector_sine_cosine {
namespace {

using duet_test::real_50;

using two_lanes = duet::detail::vector_of<double, 2>;
using all_lanes = duet::detail::vector_of<double, int(DUET_VECTOR_BYTES / sizeof(double))>;

/// Arguments of every size, and next to multiples of π/2, where all leading bits cancel.
std::vector<double> moderate_inputs() {
  std::vector<double> result = {0.0, 1e-300, 0x1p-1074, 0.5, 1, 799999.9, 0x1.921fb54442d18p-1};
  duet_test::random_source random(3);
  for (int i = 0; i < 300; ++i) {
    result.push_back(random.uniform(0, 7));
    result.push_back(random.uniform(0, 8e5));
    result.push_back(std::ldexp(random.uniform(1, 2), -1 - i % 60));
    const double n = i < 40 ? i : std::floor(random.uniform(0, 509295));
    const double multiple = double(real_50(n * boost::math::constants::half_pi<real_50>()));
    result.insert(result.end(),
                  {multiple, std::nextafter(multiple, 8e5), std::nextafter(multiple, 0)});
  }
  // The double below 8e5 that is nearest to a multiple of π/2.
  const real_50 half_pi = boost::math::constants::half_pi<real_50>();
  double nearest = 1;
  real_50 smallest = 1;
  const double parts[] = {double(half_pi), double(real_50(half_pi - double(half_pi)))};
  for (double n = 1; n < 509295; ++n) {
    const double x = n * parts[0];
    const double distance = std::abs(std::fma(n, parts[0], -x) + n * parts[1]);
    if (distance < smallest) {
      smallest = distance;
      nearest = x;
    }
  }
  result.push_back(nearest);
  return result;
}

template <class V>
void check_lanes() {
  constexpr std::size_t lanes = sizeof(V) / sizeof(double);
  duet_test::worst_error sines("sin"), cosines("cos");
  const auto inputs = moderate_inputs();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const double size = inputs[i];
    V x{};
    for (std::size_t k = 0; k < lanes; ++k) {
      x[k] = k % 2 == 0 ? inputs[(i + k) % inputs.size()] : -size;
    }
    const auto y = duet::detail::vector_sine_and_cosine(x);
    const real_50 s = sin(real_50(x[1])), c = cos(real_50(x[1]));
    // The error in units of the last place of the computed value.
    const auto error = [](double computed, const real_50& exact) {
      const double unit = std::nextafter(std::abs(computed), 2.0) - std::abs(computed);
      return double(real_50(abs(real_50(computed - exact)) / unit));
    };
    sines.add(error(y.sine[1], s), x[1]);
    cosines.add(error(y.cosine[1], c), x[1]);
    for (std::size_t k = 0; k < lanes; ++k) { // all lanes do the same
      const auto alone = duet::detail::vector_sine_and_cosine(V{} + x[k]);
      CHECK(y.sine[k] == alone.sine[0]);
      CHECK(y.cosine[k] == alone.cosine[lanes - 1]);
    }
  }
  CHECK_MESSAGE(sines <= 1, sines);
  CHECK_MESSAGE(cosines <= 1, cosines);
}

TEST_CASE("vector_sine_cosine: accurate to one unit in the last place") {
  check_lanes<two_lanes>();
  check_lanes<all_lanes>();
}

TEST_CASE(
    "vector_sine_cosine: signs, zeros, large numbers, infinities and NaN as in the C library") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double size : {0.0, 8e5, 1e6, 1e22, 1.7e308, infinity, double(NAN)}) {
    for (const double x : {size, -size}) {
      const auto y = duet::detail::vector_sine_and_cosine(two_lanes{x, 0.25});
      if (std::isfinite(x)) {
        CHECK(std::bit_cast<std::uint64_t>(y.sine[0]) == std::bit_cast<std::uint64_t>(std::sin(x)));
        CHECK(y.cosine[0] == std::cos(x));
      } else {
        CHECK(std::isnan(y.sine[0]));
        CHECK(std::isnan(y.cosine[0]));
      }
      CHECK(y.sine[1] == doctest::Approx(std::sin(0.25)).epsilon(1e-15));
    }
  }
}

} // namespace
} // namespace test_core_vector_sine_cosine
