// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "toleranced_carrier.hpp"

#include <duet/core/random_source.hpp>

#include <boost/math/statistics/univariate_statistics.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

/// \file
/// Random errors of the hardpoints, and their statistics.

namespace tolerance_study {

/// Maps consecutive numbers to unrelated seeds (SplitMix64, by S. Vigna).
[[nodiscard]] inline std::uint64_t scattered(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

/// The errors of one sample: normally distributed, independent, with the given standard deviation.
/// They depend only on the number of the sample.
[[nodiscard]] inline errors sample_errors(std::uint64_t seed, std::uint64_t sample,
                                          double deviation) {
  duet::random_source random(scattered(scattered(seed) + sample));
  errors result;
  for (double& x : result) {
    x = deviation * random.normal();
  }
  return result;
}

struct statistics {
  double mean, deviation;
  double low, high; ///< quantiles 2.5 % and 97.5 %
};

/// Statistics of at least two numbers.
[[nodiscard]] inline statistics statistics_of(std::vector<double> numbers) {
  using boost::math::statistics::mean;
  using boost::math::statistics::sample_variance;
  const double average = mean(numbers);
  const double deviation = std::sqrt(sample_variance(numbers));
  std::sort(numbers.begin(), numbers.end());
  const auto quantile = [&numbers](double fraction) {
    const double position = fraction * double(numbers.size() - 1);
    const auto i = std::min(std::size_t(position), numbers.size() - 2);
    return std::lerp(numbers[i], numbers[i + 1], position - double(i));
  };
  return {average, deviation, quantile(0.025), quantile(0.975)};
}

} // namespace tolerance_study
