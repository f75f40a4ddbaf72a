// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/expression/arm/lanes.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>

/// \file
/// Apart from duet::detail::displacement for the speed that lanes.hpp tells.
///
/// A rigid motion in doubles while factors are appended to it: the columns of its rotation, which
/// are the axes that joints turn about, its place and its quaternion.

namespace duet::expression::detail {

/// A turn about the I-th coordinate axis, by sine and cosine of half the angle.
template <int I>
struct about_axis {
  static constexpr bool turns = true;
};
/// A translation along the I-th coordinate axis.
template <int I>
struct along_axis {
  static constexpr bool turns = false;
};
/// Any rigid motion, by its value and its twists.
struct any_motion {
  static constexpr bool turns = true;
};

class moving_frame {
public:
  /// Moved along with its own axes. IsFirst: these still are the fixed ones.
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
      const four_lanes turned = cosine * a + sine * b;
      b = cosine * b - sine * a;
      a = turned;
      q_ = c * q_ + times_unit<I>(q_, s);
    }
  }
  template <bool, int I>
  DUET_ALWAYS_INLINE void append(along_axis<I>, double d) {
    place_ = place_ + d * axis<I>();
  }
  template <bool>
  DUET_ALWAYS_INLINE void append(any_motion, const dual_quaternion<double>& a) {
    const auto r = rotation_matrix(rotation(a));
    const auto t = translation(a);
    place_ = place_ + carried(t[0], t[1], t[2]);
    const four_lanes x = carried(r(0, 0), r(1, 0), r(2, 0));
    const four_lanes y = carried(r(0, 1), r(1, 1), r(2, 1));
    z_ = carried(r(0, 2), r(1, 2), r(2, 2));
    x_ = x;
    y_ = y;
    const auto q = quaternion<double>(q_[0], q_[1], q_[2], q_[3]) * rotation(a);
    q_ = lanes_of(q.w(), q.x(), q.y(), q.z());
  }

  /// The twist in fixed axes, of a turn or translation at some rate.
  template <bool IsSet, int I>
  DUET_ALWAYS_INLINE void write(about_axis<I>, double* column, double rate) const {
    const four_lanes omega = rate * axis<I>();
    write_twist<IsSet>(column, cross(place_, omega), omega);
  }
  template <bool IsSet, int I>
  DUET_ALWAYS_INLINE void write(along_axis<I>, double* column, double rate) const {
    write_twist<IsSet>(column, rate * axis<I>(), lanes_of(0, 0, 0, 0));
  }
  /// Any twist ω + εv, told in the frame's own axes.
  template <bool IsSet>
  DUET_ALWAYS_INLINE void write(any_motion, double* column,
                                const dual_vector<double>& twist) const {
    const four_lanes omega = carried(twist[0].value(), twist[1].value(), twist[2].value());
    const four_lanes v = carried(twist[0].epsilon(), twist[1].epsilon(), twist[2].epsilon());
    write_twist<IsSet>(column, v + cross(place_, omega), omega);
  }

  [[nodiscard]] DUET_ALWAYS_INLINE dual_quaternion<double> pose() const {
    const quaternion<double> q(q_[0], q_[1], q_[2], q_[3]);
    const quaternion<double> half(0, place_[0] / 2, place_[1] / 2, place_[2] / 2);
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
  /// p along the J-th axis and q along the K-th.
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
  [[nodiscard]] DUET_ALWAYS_INLINE four_lanes carried(double x, double y, double z) const {
    return x * x_ + y * y_ + z * z_;
  }

  four_lanes x_ = lanes_of(1, 0, 0, 0), y_ = lanes_of(0, 1, 0, 0), z_ = lanes_of(0, 0, 1, 0);
  four_lanes place_ = lanes_of(0, 0, 0, 0);
  four_lanes q_ = lanes_of(1, 0, 0, 0);
};

} // namespace duet::expression::detail
