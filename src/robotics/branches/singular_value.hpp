// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/math.hpp>
#include <duet/core/config.hpp>
#include <duet/core/select.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Smallest singular value of a Jacobian of six joints.

namespace duet::detail {
DUET_ABI_BEGIN

template <class S>
using six_numbers = std::array<S, 6>;
template <class S>
using six_rows = std::array<six_numbers<S>, 6>;

template <class S>
[[nodiscard]] S sum_of_products(const six_numbers<S>& a, const six_numbers<S>& b,
                                std::size_t from) {
  S sum = a[from] * b[from];
  for (std::size_t i = from + 1; i < 6; ++i) {
    sum += a[i] * b[i];
  }
  return sum;
}

/// Largest eigenvalue of a symmetric positive semidefinite matrix G of six rows with
/// trace 1; G is overwritten.
///
/// Householder reflections make G tridiagonal. From ‖G‖ Laguerre's method descends to the largest
/// zero of det(x − G) without passing it, also if it is a multiple zero.
template <class S>
[[nodiscard]] S largest_eigenvalue(six_rows<S>& g) {
  using std::max;
  using std::sqrt;
  constexpr double tiny = 1e-290;
  six_numbers<S> squares; // squares of the off-diagonal entries
  for (std::size_t k = 0; k < 5; ++k) {
    six_numbers<S> v = g[k]; // ± |v| is added to the first off-diagonal entry
    squares[k] = sum_of_products(v, v, k + 1);
    const S first = v[k + 1], length = sqrt(squares[k]);
    v[k + 1] = select(
        first < S(0), [&] { return S(first - length); }, [&] { return S(first + length); });
    const S scale = S(1) / max(S(squares[k] + length * max(first, S(-first))), S(tiny));
    six_numbers<S> w; // G v / (v·v/2)
    for (std::size_t i = k + 1; i < 6; ++i) {
      w[i] = scale * sum_of_products(g[i], v, k + 1);
    }
    const S half = scale * sum_of_products(v, w, k + 1) / S(2);
    for (std::size_t i = k + 1; i < 6; ++i) {
      w[i] -= half * v[i];
    }
    for (std::size_t i = k + 1; i < 6; ++i) {
      for (std::size_t j = k + 1; j < 6; ++j) {
        g[i][j] -= v[i] * w[j] + w[i] * v[j];
      }
    }
  }
  S squared_norm = g[5][5] * g[5][5];
  for (std::size_t k = 0; k < 5; ++k) {
    squared_norm += g[k][k] * g[k][k] + S(2) * squares[k];
  }
  S x = sqrt(squared_norm);
  for (int round = 0; round < 60; ++round) {
    S p = x - g[0][0], dp(1), ddp(0), p0(1), dp0(0), ddp0(0);
    for (std::size_t k = 1; k < 6; ++k) {
      const S d = x - g[k][k], e = squares[k - 1];
      const S p2 = d * p - e * p0, dp2 = p + d * dp - e * dp0,
              ddp2 = S(2) * dp + d * ddp - e * ddp0;
      p0 = p, dp0 = dp, ddp0 = ddp;
      p = p2, dp = dp2, ddp = ddp2;
    }
    const S root = sqrt(max(S(S(5) * (S(5) * dp * dp - S(6) * p * ddp)), S(0)));
    const S step = S(6) * p / max(S(dp + root), S(tiny));
    x -= step;
    if (!any(step > S(1e-15) * x)) {
      break;
    }
  }
  return x;
}

/// Smallest singular value of a matrix of six rows; 0 if it is singular to round-off.
///
/// Gram–Schmidt orthogonalisation of the rows gives J = L Q, and the largest eigenvalue of L⁻¹L⁻ᵀ
/// is 1/σ². The effect of round-off does not depend on the lengths of the rows, hence not on the
/// unit of length.
template <class Jacobian>
[[nodiscard]] auto smallest_singular_value(const Jacobian& jacobian) {
  using std::sqrt;
  using S = typename Jacobian::Scalar;
  six_rows<S> j, m{}; // m is first −L below the diagonal, then L⁻¹
  six_numbers<S> norms2;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      j[i][k] = jacobian(int(i), int(k));
    }
    norms2[i] = sum_of_products(j[i], j[i], 0);
  }
  for (std::size_t k = 0; k < 6; ++k) {
    m[k][k] = S(1) / sqrt(sum_of_products(j[k], j[k], 0));
    for (S& x : j[k]) {
      x *= m[k][k];
    }
    for (std::size_t i = k + 1; i < 6; ++i) {
      m[i][k] = -sum_of_products(j[i], j[k], 0);
      for (std::size_t c = 0; c < 6; ++c) {
        j[i][c] += m[i][k] * j[k][c];
      }
    }
  }
  S inverse_norm2(0), condition2(0); // the latter for rows of length 1, a squared condition number
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < i; ++k) { // in place: m[i][k] is not read after that
      S sum(0);
      for (std::size_t c = k; c < i; ++c) {
        sum += m[i][c] * m[c][k];
      }
      m[i][k] = m[i][i] * sum;
    }
    for (std::size_t k = 0; k <= i; ++k) {
      const S square = m[i][k] * m[i][k];
      inverse_norm2 += square;
      condition2 += square * norms2[k];
    }
  }
  six_rows<S> g;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k <= i; ++k) {
      S sum(0);
      for (std::size_t c = 0; c <= k; ++c) {
        sum += m[i][c] * m[k][c];
      }
      g[i][k] = g[k][i] = sum / inverse_norm2;
    }
  }
  const S largest = largest_eigenvalue(g);
  return select(
      condition2 < S(1e31), [&] { return S(S(1) / sqrt(inverse_norm2 * largest)); },
      [] { return S(0); });
}

DUET_ABI_END
} // namespace duet::detail
