// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <cstdint>

/// \file
/// Random number generator of searches.

namespace duet::detail {
DUET_ABI_BEGIN

/// Uniform random numbers from 0 to 1, identical on every machine: SplitMix64 (Steele, Lea, Flood,
/// Fast splittable pseudorandom number generators, 2014). `<random>` would cost the compiler more
/// than the search.
class splitmix64 {
public:
  explicit splitmix64(std::uint64_t seed) : state_(seed) {}

  [[nodiscard]] double operator()() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30U) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27U) * 0x94d049bb133111eb;
    return double((z ^ z >> 31U) >> 11U) * 0x1p-53;
  }

private:
  std::uint64_t state_;
};

DUET_ABI_END
} // namespace duet::detail
