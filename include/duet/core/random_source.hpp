// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

/// \file
/// Random numbers that are the same on every standard library, so that a failure can be reproduced.

namespace duet {

/// Random number generator, the same on every machine. It is seeded explicitly; the standard engine
/// is specified exactly, its distributions are not.
class random_source {
public:
  /// Generator with the given seed: equal seeds give equal sequences.
  explicit random_source(std::uint64_t seed) : engine_(seed) {}

  /// Uniform number in [0, 1), with 53 bits.
  [[nodiscard]] double unit() { return double(engine_() >> 11) * 0x1p-53; }
  /// Uniform number in [low, high).
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * unit(); }
  /// Uniform integer from low to high, both included.
  [[nodiscard]] int integer(int low, int high) {
    return low + int(engine_() % std::uint64_t(high - low + 1));
  }
  /// 1 or −1.
  [[nodiscard]] double sign() { return engine_() >> 63 != 0 ? -1.0 : 1.0; }
  /// Log-uniform number in [low, high), both positive.
  [[nodiscard]] double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  /// Log-uniform number with a random sign.
  [[nodiscard]] double signed_log_uniform(double low, double high) {
    return sign() * log_uniform(low, high);
  }
  /// Standard normal number.
  [[nodiscard]] double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - unit()));
    return radius * std::cos(6.283185307179586 * unit());
  }
  /// Unit vector, uniform on the unit sphere of R^n.
  template <int N>
  [[nodiscard]] std::array<double, std::size_t(N)> direction() {
    std::array<double, std::size_t(N)> result{};
    double square = 0;
    while (square < 1e-6) {
      square = 0;
      for (double& x : result) {
        x = normal();
        square += x * x;
      }
    }
    for (double& x : result) {
      x /= std::sqrt(square);
    }
    return result;
  }

private:
  std::mt19937_64 engine_;
};

} // namespace duet
