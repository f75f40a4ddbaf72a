// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <cstring>

/// \file
/// Apart from the displacements that chains are followed by, as measured: a formula of an arm of
/// seven joints and its Jacobian take 1054 instructions in lanes, 1161 by displacements (g++ -O2;
/// clang -O2: 974 and 1066; twenty joints: 2839 and 3063, 2710 and 2991).
///
/// Three and four doubles for kernels: in one vector where the target has vectors of four, in two
/// of two where it has not.

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
  friend DUET_ALWAYS_INLINE four_lanes operator*(const four_lanes& a, double b) {
    return {a.lower * b, a.upper * b};
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

struct four_doubles {
  four_lanes v;
  DUET_ALWAYS_INLINE double operator[](int i) const { return v[i]; }
};

struct vector_in_lanes : four_doubles {
  DUET_ALWAYS_INLINE vector_in_lanes(double x, double y, double z)
      : four_doubles{lanes_of(x, y, z, 0)} {}
  DUET_ALWAYS_INLINE explicit vector_in_lanes(const four_lanes& a) : four_doubles{a} {}

  friend DUET_ALWAYS_INLINE vector_in_lanes operator*(double x, const vector_in_lanes& a) {
    return vector_in_lanes(a.v * x);
  }
  friend DUET_ALWAYS_INLINE vector_in_lanes operator+(const vector_in_lanes& a,
                                                      const vector_in_lanes& b) {
    return vector_in_lanes(a.v + b.v);
  }
  friend DUET_ALWAYS_INLINE vector_in_lanes operator-(const vector_in_lanes& a,
                                                      const vector_in_lanes& b) {
    return vector_in_lanes(a.v - b.v);
  }
};

[[nodiscard]] DUET_ALWAYS_INLINE vector_in_lanes cross(const vector_in_lanes& a,
                                                       const vector_in_lanes& b) {
  const four_lanes c = a.v * shuffled<1, 2, 0, 3>(b.v, b.v) - shuffled<1, 2, 0, 3>(a.v, a.v) * b.v;
  return vector_in_lanes(shuffled<1, 2, 0, 3>(c, c));
}

/// A quaternion, scalar first.
struct quaternion_in_lanes : four_doubles {
  DUET_ALWAYS_INLINE quaternion_in_lanes(double w, double x, double y, double z)
      : four_doubles{lanes_of(w, x, y, z)} {}
  DUET_ALWAYS_INLINE explicit quaternion_in_lanes(const four_lanes& a) : four_doubles{a} {}

  /// Times s times the I-th unit vector.
  template <int I>
  [[nodiscard]] DUET_ALWAYS_INLINE quaternion_in_lanes times_unit(double s) const {
    if constexpr (I == 0) {
      return quaternion_in_lanes(shuffled<1, 0, 3, 2>(v, v) * lanes_of(-s, s, s, -s));
    } else if constexpr (I == 1) {
      return quaternion_in_lanes(shuffled<2, 3, 0, 1>(v, v) * lanes_of(-s, -s, s, s));
    } else {
      return quaternion_in_lanes(shuffled<3, 2, 1, 0>(v, v) * lanes_of(-s, s, -s, s));
    }
  }

  friend DUET_ALWAYS_INLINE quaternion_in_lanes operator*(double x, const quaternion_in_lanes& a) {
    return quaternion_in_lanes(a.v * x);
  }
  friend DUET_ALWAYS_INLINE quaternion_in_lanes operator+(const quaternion_in_lanes& a,
                                                          const quaternion_in_lanes& b) {
    return quaternion_in_lanes(a.v + b.v);
  }
};

/// A column [v; ω] of a Jacobian, set or added to.
template <bool IsSet>
DUET_ALWAYS_INLINE void write_twist(double* column, const vector_in_lanes& v,
                                    const vector_in_lanes& omega) {
  four_lanes upper = shuffled<0, 1, 2, 4>(v.v, omega.v);
  const four_lanes rest = shuffled<1, 2, 1, 2>(omega.v, omega.v);
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
