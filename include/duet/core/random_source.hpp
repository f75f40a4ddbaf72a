// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

/// \file
/// Random numbers that are the same on every standard library, so that a failure can be repeated.

namespace duet {

/// Random numbers, the same on every machine. Seeded by hand; the standard engine is specified
/// exactly, its distributions are not.
class random_source {
public:
  explicit random_source(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1), 53 bits.
  [[nodiscard]] double unit() { return double(engine_() >> 11) * 0x1p-53; }
  /// Uniform in [low, high).
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * unit(); }
  /// A whole number from low to high, both included.
  [[nodiscard]] int integer(int low, int high) {
    return low + int(engine_() % std::uint64_t(high - low + 1));
  }
  /// 1 or −1.
  [[nodiscard]] double sign() { return engine_() >> 63 != 0 ? -1.0 : 1.0; }
  /// Log-uniform in [low, high), both positive.
  [[nodiscard]] double magnitude(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  /// ± log-uniform.
  [[nodiscard]] double signed_magnitude(double low, double high) {
    return sign() * magnitude(low, high);
  }
  /// Standard normal.
  [[nodiscard]] double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - unit()));
    return radius * std::cos(6.283185307179586 * unit());
  }
  /// Uniform on the unit sphere of R^n.
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
