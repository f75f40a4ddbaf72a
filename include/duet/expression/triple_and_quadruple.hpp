// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <cstring>

/// \file
/// Three and four doubles for kernels: in one vector where the target has vectors of four, number
/// by number where it has not.

namespace duet::expression::detail {

#if DUET_VECTOR_BYTES >= 32

typedef double four_lanes __attribute__((vector_size(32)));

struct four_doubles {
  four_lanes v;
  DUET_ALWAYS_INLINE double operator[](int i) const { return v[i]; }
};

struct triple : four_doubles {
  DUET_ALWAYS_INLINE triple(double x, double y, double z) : four_doubles{{x, y, z, 0}} {}
  DUET_ALWAYS_INLINE explicit triple(const four_lanes& a) : four_doubles{a} {}

  friend DUET_ALWAYS_INLINE triple operator*(const triple& a, double x) { return triple(a.v * x); }
  friend DUET_ALWAYS_INLINE triple operator+(const triple& a, const triple& b) {
    return triple(a.v + b.v);
  }
  friend DUET_ALWAYS_INLINE triple operator-(const triple& a, const triple& b) {
    return triple(a.v - b.v);
  }
};

[[nodiscard]] DUET_ALWAYS_INLINE triple cross_of(const triple& a, const triple& b) {
  const four_lanes c = a.v * __builtin_shufflevector(b.v, b.v, 1, 2, 0, 3) -
                       __builtin_shufflevector(a.v, a.v, 1, 2, 0, 3) * b.v;
  return triple(__builtin_shufflevector(c, c, 1, 2, 0, 3));
}

/// A quaternion, scalar first.
struct quadruple : four_doubles {
  DUET_ALWAYS_INLINE quadruple(double w, double x, double y, double z)
      : four_doubles{{w, x, y, z}} {}
  DUET_ALWAYS_INLINE explicit quadruple(const four_lanes& a) : four_doubles{a} {}

  /// Times s times the I-th unit vector.
  template <int I>
  [[nodiscard]] DUET_ALWAYS_INLINE quadruple times_unit(double s) const {
    if constexpr (I == 0) {
      return quadruple(__builtin_shufflevector(v, v, 1, 0, 3, 2) * four_lanes{-s, s, s, -s});
    } else if constexpr (I == 1) {
      return quadruple(__builtin_shufflevector(v, v, 2, 3, 0, 1) * four_lanes{-s, -s, s, s});
    } else {
      return quadruple(__builtin_shufflevector(v, v, 3, 2, 1, 0) * four_lanes{-s, s, -s, s});
    }
  }

  friend DUET_ALWAYS_INLINE quadruple operator*(const quadruple& a, double x) {
    return quadruple(a.v * x);
  }
  friend DUET_ALWAYS_INLINE quadruple operator+(const quadruple& a, const quadruple& b) {
    return quadruple(a.v + b.v);
  }
};

/// A column [v; ω] of a Jacobian, set or added to.
template <bool IsSet>
DUET_ALWAYS_INLINE void write_twist(double* column, const triple& v, const triple& omega) {
  four_lanes upper = __builtin_shufflevector(v.v, omega.v, 0, 1, 2, 4);
  const four_lanes rest = __builtin_shufflevector(omega.v, omega.v, 1, 2, 1, 2);
  if constexpr (IsSet) {
    std::memcpy(column, &upper, sizeof upper);
    std::memcpy(column + 4, &rest, 2 * sizeof(double));
  } else {
    four_lanes before;
    std::memcpy(&before, column, sizeof before);
    upper += before;
    std::memcpy(column, &upper, sizeof upper);
    column[4] += rest[0];
    column[5] += rest[1];
  }
}

#else

struct triple {
  double x, y, z;
  DUET_ALWAYS_INLINE triple(double a, double b, double c) : x(a), y(b), z(c) {}
  DUET_ALWAYS_INLINE double operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }

  friend DUET_ALWAYS_INLINE triple operator*(const triple& a, double b) {
    return {a.x * b, a.y * b, a.z * b};
  }
  friend DUET_ALWAYS_INLINE triple operator+(const triple& a, const triple& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend DUET_ALWAYS_INLINE triple operator-(const triple& a, const triple& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
};

[[nodiscard]] DUET_ALWAYS_INLINE triple cross_of(const triple& a, const triple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A quaternion, scalar first.
struct quadruple {
  double w, x, y, z;
  DUET_ALWAYS_INLINE quadruple(double a, double b, double c, double d) : w(a), x(b), y(c), z(d) {}
  DUET_ALWAYS_INLINE double operator[](int i) const {
    return i == 0 ? w : i == 1 ? x : i == 2 ? y : z;
  }

  /// Times s times the I-th unit vector.
  template <int I>
  [[nodiscard]] DUET_ALWAYS_INLINE quadruple times_unit(double s) const {
    if constexpr (I == 0) {
      return {-s * x, s * w, s * z, -s * y};
    } else if constexpr (I == 1) {
      return {-s * y, -s * z, s * w, s * x};
    } else {
      return {-s * z, s * y, -s * x, s * w};
    }
  }

  friend DUET_ALWAYS_INLINE quadruple operator*(const quadruple& a, double b) {
    return {a.w * b, a.x * b, a.y * b, a.z * b};
  }
  friend DUET_ALWAYS_INLINE quadruple operator+(const quadruple& a, const quadruple& b) {
    return {a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z};
  }
};

/// A column [v; ω] of a Jacobian, set or added to.
template <bool IsSet>
DUET_ALWAYS_INLINE void write_twist(double* column, const triple& v, const triple& omega) {
  const double twist[] = {v.x, v.y, v.z, omega.x, omega.y, omega.z};
  if constexpr (IsSet) {
    std::memcpy(column, twist, sizeof twist);
  } else {
    column[0] += twist[0];
    column[1] += twist[1];
    column[2] += twist[2];
    column[3] += twist[3];
    column[4] += twist[4];
    column[5] += twist[5];
  }
}

#endif

} // namespace duet::expression::detail
