// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/core/compiler/vector.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>

#include <cstring>

/// \file
/// Frame in doubles that a product of rigid motions moves factor by factor: its axes, which are the
/// columns of the rotation matrix, its origin, and its quaternion.

// Faster here than duet::detail::displacement of kinematic chains: pose and Jacobian of seven
// joints take 1054 instructions instead of 1161 (g++ -O2; clang -O2: 974 and 1066), of twenty
// joints 2839 instead of 3063 (2710 and 2991).

namespace duet::expression::detail {

// Four doubles, a quaternion or a vector of three with last lane 0: one SIMD vector if the target
// has vectors of four doubles, otherwise two of two.

#if DUET_VECTOR_BYTES >= 32

using four_lanes = duet::detail::vector_of<double, 4>;

[[nodiscard]] DUET_ALWAYS_INLINE four_lanes lanes_of(double a, double b, double c, double d) {
  return four_lanes{a, b, c, d};
}

/// Four lanes of a and b by their numbers: 0 to 3 are lanes of a, 4 to 7 those of b.
template <int I, int J, int K, int L>
[[nodiscard]] DUET_ALWAYS_INLINE four_lanes shuffled(const four_lanes& a, const four_lanes& b) {
  return duet::detail::lanes_taken<I, J, K, L>(a, b);
}

#else

using two_lanes = duet::detail::vector_of<double, 2>;

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
/// Four lanes of a and b by their numbers: 0 to 3 are lanes of a, 4 to 7 those of b.
template <int I, int J, int K, int L>
[[nodiscard]] DUET_ALWAYS_INLINE four_lanes shuffled(const four_lanes& a, const four_lanes& b) {
  using duet::detail::lanes_taken;
  return {lanes_taken<I % 2, 2 + J % 2>(half_with<I>(a, b), half_with<J>(a, b)),
          lanes_taken<K % 2, 2 + L % 2>(half_with<K>(a, b), half_with<L>(a, b))};
}

#endif

/// a × b of vectors in three lanes.
[[nodiscard]] DUET_ALWAYS_INLINE four_lanes cross(const four_lanes& a, const four_lanes& b) {
  const four_lanes c = a * shuffled<1, 2, 0, 3>(b, b) - shuffled<1, 2, 0, 3>(a, a) * b;
  return shuffled<1, 2, 0, 3>(c, c);
}

/// Product q (s e_I) of a quaternion, scalar first, and the scaled I-th unit vector.
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

/// Sets a column of a Jacobian to [v; ω], or adds that to it.
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

/// Rotation about the I-th coordinate axis, by sine and cosine of half the angle.
template <int I>
struct about_axis {
  static constexpr bool rotates = true;
};
/// Translation along the I-th coordinate axis.
template <int I>
struct along_axis {
  static constexpr bool rotates = false;
};
/// Any rigid motion, by its pose and its twists.
struct any_motion {
  static constexpr bool rotates = true;
};

class moving_frame {
public:
  /// Appends a motion relative to the axes of the frame.
  ///
  /// \tparam IsFirst  true if these still are the fixed axes
  template <bool IsFirst, int I>
  DUET_ALWAYS_INLINE void append(about_axis<I>, double s, double c) {
    constexpr int j = (I + 1) % 3, k = (I + 2) % 3;
    four_lanes &a = axis<j>(), &b = axis<k>();
    const double sine = 2 * s * c;
    const double cosine = 1 - 2 * s * s;
    if constexpr (IsFirst) {
      a = in_plane<j, k>(cosine, sine);
      b = in_plane<j, k>(-sine, cosine);
      q_ = lanes_of(c, I == 0 ? s : 0, I == 1 ? s : 0, I == 2 ? s : 0);
    } else {
      const four_lanes new_a = cosine * a + sine * b;
      b = cosine * b - sine * a;
      a = new_a;
      q_ = c * q_ + times_unit<I>(q_, s);
    }
  }
  template <bool, int I>
  DUET_ALWAYS_INLINE void append(along_axis<I>, double d) {
    origin_ = origin_ + d * axis<I>();
  }
  template <bool>
  DUET_ALWAYS_INLINE void append(any_motion, const dual_quaternion<double>& a) {
    const auto r = rotation_matrix(rotation(a));
    const auto t = translation(a);
    origin_ = origin_ + carried(t[0], t[1], t[2]);
    const four_lanes x = carried(r(0, 0), r(1, 0), r(2, 0));
    const four_lanes y = carried(r(0, 1), r(1, 1), r(2, 1));
    z_ = carried(r(0, 2), r(1, 2), r(2, 2));
    x_ = x;
    y_ = y;
    const auto q = quaternion<double>(q_[0], q_[1], q_[2], q_[3]) * rotation(a);
    q_ = lanes_of(q.w(), q.x(), q.y(), q.z());
  }

  /// Writes the spatial twist of a rotation or translation with a rate.
  template <bool IsSet, int I>
  DUET_ALWAYS_INLINE void write(about_axis<I>, double* column, double rate) const {
    const four_lanes omega = rate * axis<I>();
    write_twist<IsSet>(column, cross(origin_, omega), omega);
  }
  template <bool IsSet, int I>
  DUET_ALWAYS_INLINE void write(along_axis<I>, double* column, double rate) const {
    write_twist<IsSet>(column, rate * axis<I>(), lanes_of(0, 0, 0, 0));
  }
  /// Writes the spatial twist of a twist ω + εv given in the axes of the frame.
  template <bool IsSet>
  DUET_ALWAYS_INLINE void write(any_motion, double* column,
                                const dual_vector<double>& twist) const {
    const four_lanes omega = carried(twist[0].value(), twist[1].value(), twist[2].value());
    const four_lanes v = carried(twist[0].epsilon(), twist[1].epsilon(), twist[2].epsilon());
    write_twist<IsSet>(column, v + cross(origin_, omega), omega);
  }

  [[nodiscard]] DUET_ALWAYS_INLINE dual_quaternion<double> pose() const {
    const quaternion<double> q(q_[0], q_[1], q_[2], q_[3]);
    const quaternion<double> half(0, origin_[0] / 2, origin_[1] / 2, origin_[2] / 2);
    return make_dual_quaternion(q, half * q);
  }

private:
  template <int I>
  [[nodiscard]] DUET_ALWAYS_INLINE four_lanes& axis() {
    return I == 0 ? x_ : I == 1 ? y_ : z_;
  }
  template <int I>
  [[nodiscard]] DUET_ALWAYS_INLINE const four_lanes& axis() const {
    return I == 0 ? x_ : I == 1 ? y_ : z_;
  }
  /// Vector p e_J + q e_K.
  template <int J, int K>
  [[nodiscard]] DUET_ALWAYS_INLINE static four_lanes in_plane(double p, double q) {
    return lanes_of(J == 0   ? p
                    : K == 0 ? q
                             : 0,
                    J == 1   ? p
                    : K == 1 ? q
                             : 0,
                    J == 2   ? p
                    : K == 2 ? q
                             : 0,
                    0);
  }
  /// Vector in fixed axes with the components x, y and z along the axes of the frame.
  [[nodiscard]] DUET_ALWAYS_INLINE four_lanes carried(double x, double y, double z) const {
    return x * x_ + y * y_ + z * z_;
  }

  four_lanes x_ = lanes_of(1, 0, 0, 0), y_ = lanes_of(0, 1, 0, 0), z_ = lanes_of(0, 0, 1, 0);
  four_lanes origin_ = lanes_of(0, 0, 0, 0);
  four_lanes q_ = lanes_of(1, 0, 0, 0);
};

} // namespace duet::expression::detail
