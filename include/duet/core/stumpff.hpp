// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

/// \file
/// Stumpff functions c_n(s) = Σ_k (−s)^k / (2k+n)! of a real s ≥ 0: c₀ = cos √s, c₁ = sin √s / √s,
/// c₂ = (1 − c₀)/s, c₃ = (1 − c₁)/s, … They are what is left of sine and cosine when the removable
/// singularities of exp and log at the identity are taken out.

namespace duet::detail {

/// 1/(2k+n)!, k = 0, 1, …
template <class T, int N, int Terms>
[[nodiscard]] constexpr std::array<T, Terms> stumpff_coefficients() {
  std::array<T, Terms> result{};
  long double factorial = 1;
  for (int i = 2; i <= N; ++i) {
    factorial *= i;
  }
  for (int k = 0; k < Terms; ++k) {
    result[std::size_t(k)] = static_cast<T>(1 / factorial);
    factorial *= (2.0L * k + N + 1) * (2.0L * k + N + 2);
  }
  return result;
}

/// Every other term from the K-th on by Horner's rule, unrolled.
template <int N, int Terms, int K, class T>
[[nodiscard]] DUET_ALWAYS_INLINE T stumpff_half_polynomial(const T& square) {
  constexpr auto coefficient = stumpff_coefficients<lane_type_t<T>, N, Terms>()[K];
  if constexpr (K + 2 >= Terms) {
    return coefficient;
  } else {
    return coefficient + square * stumpff_half_polynomial<N, Terms, K + 2>(square);
  }
}

/// The first terms of the series. Even and odd ones apart take half as long, as neither sum waits
/// for the other.
template <int N, int Terms, class T>
[[nodiscard]] DUET_ALWAYS_INLINE T stumpff_polynomial(const T& s) {
  const T square = s * s;
  return stumpff_half_polynomial<N, Terms, 0>(square) -
         s * stumpff_half_polynomial<N, Terms, 1>(square);
}

/// The series, summed until its terms vanish, for types without a fixed number of digits.
template <int N, class T>
[[nodiscard]] T stumpff_series(const T& s) {
  T term(1);
  for (int i = 2; i <= N; ++i) {
    term /= i;
  }
  T sum = term;
  for (int k = 0; abs(term) > std::numeric_limits<T>::epsilon() * abs(sum) / 8; ++k) {
    term *= -s / ((2 * k + N + 1) * (2 * k + N + 2));
    sum += term;
  }
  return sum;
}

/// 1/(n−2)!, the value that the recurrence c_n = (1/(n−2)! − c_{n−2})/s starts from.
template <class T>
[[nodiscard]] constexpr T inverse_factorial(int n) {
  T factorial(1);
  for (int i = 2; i <= n; ++i) {
    factorial = factorial * T(i);
  }
  return T(1) / factorial;
}

/// Where the closed forms of c₂, c₃ … and of derivatives take over from the series: below, they
/// cancel; above, the series does.
template <Real T>
[[nodiscard]] constexpr auto is_beyond_series(const T& s) {
  return s > T(4);
}

/// c_n(s) of small s: up to 4, and up to 1 of c₀ and c₁ or where no more is asked for.
template <int N, int Limit = (N < 2 ? 1 : 4), Real T>
[[nodiscard]] DUET_ALWAYS_INLINE T stumpff_of_small(const T& s) {
  if constexpr (std::floating_point<lane_type_t<T>>) {
    // The first term left out is 4e-19 at s = 1 and 2e-22 at s = 4, with more digits 3e-27 and
    // 4e-27.
    constexpr int terms = Limit > 1 ? 13 : N < 2 ? 10 : 9;
    constexpr int more_terms = Limit > 1 ? 15 : N < 2 ? 13 : 12;
    constexpr int count = std::numeric_limits<T>::digits <= 53 ? terms : more_terms;
    return stumpff_polynomial<N, count>(s);
  } else {
    return stumpff_series<N>(s);
  }
}

template <int N, Real T>
[[nodiscard]] DUET_ALWAYS_INLINE T stumpff_of_real(const T& s);

/// c_n(s) of large s, by sine or cosine.
template <int N, Real T>
[[nodiscard]] DUET_ALWAYS_INLINE T stumpff_of_large(const T& s) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  if constexpr (N == 0) {
    return cos(T(sqrt(s)));
  } else if constexpr (N == 1) {
    const T root = sqrt(s);
    return sin(root) / root;
  } else {
    return (inverse_factorial<lane_type_t<T>>(N - 2) - stumpff_of_real<N - 2>(s)) / s;
  }
}

/// c_n(s) of a real number.
template <int N, Real T>
[[nodiscard]] DUET_ALWAYS_INLINE T stumpff_of_real(const T& s) {
  return select(
      N < 2 ? s <= T(1) : !is_beyond_series(s),
      [&]() DUET_INLINE_LAMBDA { return stumpff_of_small<N>(s); },
      [&]() DUET_INLINE_LAMBDA { return stumpff_of_large<N>(s); });
}

} // namespace duet::detail
