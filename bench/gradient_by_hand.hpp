// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "workloads.hpp"

#include <duet/core/config.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

/// \file
/// The gradient of f_grad written by hand for speed: every statement differentiated on paper, its
/// rows of partial derivatives combined in one pass of compiler vectors, without checks for finite
/// derivatives.

namespace duet_bench {

/// A value and N partials in vectors of the width the target has.
template <std::size_t N>
struct row {
  static constexpr std::size_t width = DUET_VECTOR_BYTES / sizeof(double);
  static constexpr std::size_t count = (N + width - 1) / width;
  typedef double packet __attribute__((vector_size(DUET_VECTOR_BYTES)));

  double value;
  packet partials[count];

  /// Makes it the i-th variable; complete packets are stored.
  void set_variable(double x, std::size_t i) {
    const packet lanes = []<std::size_t... Lane>(std::index_sequence<Lane...>) {
      return packet{double(Lane)...};
    }
    (std::make_index_sequence<width>{});
    value = x;
    for (std::size_t p = 0; p < count; ++p) {
      partials[p] = lanes + double(p * width) == double(i) ? packet{} + 1.0 : packet{};
    }
  }
};

/// The value, then the gradient.
template <std::size_t N>
std::array<double, N + 1> gradient_by_hand(const inputs<double, N>& at) {
  using numbers = row<N>;
  std::array<numbers, N> x;
  for (std::size_t i = 0; i < N; ++i) {
    x[i].set_variable(at[i], i);
  }
  numbers sum = x[0];
  numbers carry = x[N - 1];
  numbers u;
  const auto chained = [&](double value, double outer_derivative) {
    carry.value = value;
    for (std::size_t p = 0; p < numbers::count; ++p) {
      carry.partials[p] = u.partials[p] * outer_derivative;
    }
  };
  for (std::size_t i = 0; i < N; ++i) {
    const numbers& a = x[i];
    const numbers& b = x[i + 1 < N ? i + 1 : 0];
    u.value = a.value * b.value + 0.5 * carry.value;
    for (std::size_t p = 0; p < numbers::count; ++p) {
      u.partials[p] = a.partials[p] * b.value + b.partials[p] * a.value + carry.partials[p] * 0.5;
    }
    switch (i % 4) {
    case 0:
      chained(std::sin(u.value), std::cos(u.value));
      break;
    case 1: {
      const double bell = std::exp(-u.value);
      chained(bell, -bell);
      break;
    }
    case 2: {
      const double root = std::sqrt(1.0 + u.value * u.value);
      chained(root, u.value / root);
      break;
    }
    default: {
      const double inverse = 1.0 / (2.0 + a.value);
      carry.value = u.value / (2.0 + a.value);
      for (std::size_t p = 0; p < numbers::count; ++p) {
        carry.partials[p] = (u.partials[p] - a.partials[p] * carry.value) * inverse;
      }
    }
    }
    const double step = a.value - b.value;
    sum.value += carry.value * step;
    for (std::size_t p = 0; p < numbers::count; ++p) {
      sum.partials[p] += carry.partials[p] * step + (a.partials[p] - b.partials[p]) * carry.value;
    }
  }
  for (std::size_t p = 0; p < numbers::count; ++p) {
    u.partials[p] = sum.partials[p] * carry.value + carry.partials[p] * sum.value;
  }
  std::array<double, N + 1> result;
  result[0] = sum.value * carry.value;
  std::memcpy(&result[1], u.partials, N * sizeof(double));
  return result;
}

} // namespace duet_bench
