// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <cstring>

/// \file
/// Apart from the displacements that chains are followed by, as measured: a formula of an arm of
/// seven joints and its Jacobian take 1054 instructions in lanes, 1161 by displacements (g++ -O2;
/// clang -O2: 974 and 1066; twenty joints: 2839 and 3063, 2710 and 2991).
///
/// Vectors of three doubles, the last lane 0, and quaternions for kernels: in one vector where the
/// target has vectors of four, in two of two where it has not.

namespace duet::expression::detail {

#if DUET_VECTOR_BYTES >= 32

typedef double four_lanes __attribute__((vector_size(32)));

[[nodiscard]] DUET_ALWAYS_INLINE four_lanes lanes_of(double a, double b, double c, double d) {
  return four_lanes{a, b, c, d};
}

/// Some lanes of a, which are 0 to 3, and of b, 4 to 7.
template <int I, int J, int K, int L>
[[nodiscard]] DUET_ALWAYS_INLINE four_lanes shuffled(const four_lanes& a, const four_lanes& b) {
  return __builtin_shufflevector(a, b, I, J, K, L);
}

#else

typedef double two_lanes __attribute__((vector_size(16)));

struct four_lanes {
  two_lanes lower, upper;
  DUET_ALWAYS_INLINE double operator[](int i) const { return i < 2 ? lower[i] : upper[i - 2]; }

  friend DUET_ALWAYS_INLINE four_lanes operator+(const four_lanes& a, const four_lanes& b) {
    return {a.lower + b.lower, a.upper + b.upper};
  }
  friend DUET_ALWAYS_INLINE four_lanes operator-(const four_lanes& a, const four_lanes& b) {
    return {a.lower - b.lower, a.upper - b.upper};
  }
  friend DUET_ALWAYS_INLINE four_lanes operator*(const four_lanes& a, const four_lanes& b) {
    return {a.lower * b.lower, a.upper * b.upper};
  }
  friend DUET_ALWAYS_INLINE four_lanes operator*(double a, const four_lanes& b) {
    return {b.lower * a, b.upper * a};
  }
};

[[nodiscard]] DUET_ALWAYS_INLINE four_lanes lanes_of(double a, double b, double c, double d) {
  return {two_lanes{a, b}, two_lanes{c, d}};
}

template <int I>
[[nodiscard]] DUET_ALWAYS_INLINE const two_lanes& half_with(const four_lanes& a,
                                                            const four_lanes& b) {
  return I < 2 ? a.lower : I < 4 ? a.upper : I < 6 ? b.lower : b.upper;
}
/// Some lanes of a, which are 0 to 3, and of b, 4 to 7.
template <int I, int J, int K, int L>
[[nodiscard]] DUET_ALWAYS_INLINE four_lanes shuffled(const four_lanes& a, const four_lanes& b) {
  return {__builtin_shufflevector(half_with<I>(a, b), half_with<J>(a, b), I % 2, 2 + J % 2),
          __builtin_shufflevector(half_with<K>(a, b), half_with<L>(a, b), K % 2, 2 + L % 2)};
}

#endif

/// a × b of vectors in three lanes.
[[nodiscard]] DUET_ALWAYS_INLINE four_lanes cross(const four_lanes& a, const four_lanes& b) {
  const four_lanes c = a * shuffled<1, 2, 0, 3>(b, b) - shuffled<1, 2, 0, 3>(a, a) * b;
  return shuffled<1, 2, 0, 3>(c, c);
}

/// A quaternion, scalar first, times s times the I-th unit vector.
template <int I>
[[nodiscard]] DUET_ALWAYS_INLINE four_lanes times_unit(const four_lanes& q, double s) {
  if constexpr (I == 0) {
    return shuffled<1, 0, 3, 2>(q, q) * lanes_of(-s, s, s, -s);
  } else if constexpr (I == 1) {
    return shuffled<2, 3, 0, 1>(q, q) * lanes_of(-s, -s, s, s);
  } else {
    return shuffled<3, 2, 1, 0>(q, q) * lanes_of(-s, s, -s, s);
  }
}

/// A column [v; ω] of a Jacobian, set or added to.
template <bool IsSet>
DUET_ALWAYS_INLINE void write_twist(double* column, const four_lanes& v, const four_lanes& omega) {
  four_lanes upper = shuffled<0, 1, 2, 4>(v, omega);
  const four_lanes rest = shuffled<1, 2, 1, 2>(omega, omega);
  if constexpr (IsSet) {
    std::memcpy(column, &upper, sizeof upper);
    std::memcpy(column + 4, &rest, 2 * sizeof(double));
  } else {
    four_lanes before;
    std::memcpy(&before, column, sizeof before);
    upper = upper + before;
    std::memcpy(column, &upper, sizeof upper);
    column[4] += rest[0];
    column[5] += rest[1];
  }
}

} // namespace duet::expression::detail
