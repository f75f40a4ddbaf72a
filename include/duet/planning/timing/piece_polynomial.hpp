// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Polynomials over a short piece, and parabolas near them. For those who extend duet.

namespace duet::detail {

/// A polynomial of at most ninth degree of u, 0 ≤ u ≤ 1, by its powers.
struct piece_polynomial {
  std::array<double, 10> of{};

  friend piece_polynomial operator+(piece_polynomial p, const piece_polynomial& q) {
    for (std::size_t i = 0; i < 10; ++i) {
      p.of[i] += q.of[i];
    }
    return p;
  }
  friend piece_polynomial operator*(double x, piece_polynomial p) {
    for (double& each : p.of) {
      each *= x;
    }
    return p;
  }
  friend piece_polynomial operator*(const piece_polynomial& p, const piece_polynomial& q) {
    piece_polynomial result;
    for (std::size_t i = 0; i < 10; ++i) {
      for (std::size_t j = 0; p.of[i] != 0 && i + j < 10; ++j) {
        result.of[i + j] += p.of[i] * q.of[j];
      }
    }
    return result;
  }
};

/// A parabola by its Bernstein coefficients, and how far from it a polynomial is at most.
struct near_parabola {
  std::array<double, 3> at{};
  double error = 0;

  near_parabola() = default;
  /// The parabola that has its values at both ends and in the middle. The difference lies between
  /// its own Bernstein coefficients.
  explicit near_parabola(piece_polynomial p) {
    double middle = 0, end = 0, power = 1;
    for (const double x : p.of) {
      middle += x * power;
      end += x;
      power /= 2;
    }
    const double start = p.of[0];
    at = {start, 2 * middle - (start + end) / 2, end};
    p.of[0] = 0;
    p.of[1] -= 2 * (at[1] - at[0]);
    p.of[2] -= at[0] - 2 * at[1] + at[2];
    for (std::size_t j = 1; j < 10; ++j) {
      double sum = 0, share = 1; // binomial(j, i) / binomial(9, i)
      for (std::size_t i = 0; i <= j; ++i) {
        sum += share * p.of[i];
        share *= double(j - i) / double(9 - i);
      }
      error = std::max(error, std::abs(sum));
    }
  }
};

} // namespace duet::detail
