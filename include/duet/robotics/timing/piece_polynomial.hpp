// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Polynomials on a short segment and their cubic approximations. For those who extend duet.

namespace duet::detail {

/// Polynomial of degree at most nine in u, 0 ≤ u ≤ 1, by its powers.
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

/// Cubic polynomial by its Bernstein coefficients, with the amount by which the middle two have to
/// be moved up and down to enclose another polynomial.
struct cubic_approximation {
  std::array<double, 4> at{};
  double error = 0;

  cubic_approximation() = default;
  /// Interpolates a polynomial at 0, 1/3, 2/3 and 1. The difference, with Bernstein coefficients
  /// e_j, e_0 = e_9 = 0, is u (1 − u) Σ 72 / (j (9 − j)) e_j B_{j−1}(u) with those of seventh
  /// degree, and the middle two coefficients are multiplied by 3 u (1 − u).
  explicit cubic_approximation(piece_polynomial p) {
    double end = 0, third = 0, two_thirds = 0;
    for (std::size_t i = 10; i-- > 0;) {
      end += p.of[i];
      third = third / 3 + p.of[i];
      two_thirds = two_thirds * 2 / 3 + p.of[i];
    }
    const double start = p.of[0];
    at = {start, 3 * third - 1.5 * two_thirds + end / 3 - 5 * start / 6,
          3 * two_thirds - 1.5 * third + start / 3 - 5 * end / 6, end};
    p.of[0] = 0;
    p.of[1] -= 3 * (at[1] - at[0]);
    p.of[2] -= 3 * (at[0] - 2 * at[1] + at[2]);
    p.of[3] -= at[3] - at[0] + 3 * (at[1] - at[2]);
    for (std::size_t j = 1; j < 9; ++j) {
      double sum = 0, share = 1; // binomial(j, i) / binomial(9, i)
      for (std::size_t i = 0; i <= j; ++i) {
        sum += share * p.of[i];
        share *= double(j - i) / double(9 - i);
      }
      error = std::max(error, 24.0 / double(j * (9 - j)) * std::abs(sum));
    }
  }
};

} // namespace duet::detail
