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

class moving_frame {
public:
  /// Turned about the I-th of its own axes, given sine and cosine of half the angle. IsFirst: these
  /// are still the fixed ones.
  template <int I, bool IsFirst>
  DUET_ALWAYS_INLINE void turn(double s, double c) {
    constexpr int j = (I + 1) % 3, k = (I + 2) % 3;
    vector_in_lanes &a = axis<j>(), &b = axis<k>();
    const double sine = 2 * s * c;
    const double cosine = 1 - 2 * s * s;
    if constexpr (IsFirst) {
      a = vector_in_lanes(j == 0   ? cosine
                          : k == 0 ? sine
                                   : 0,
                          j == 1   ? cosine
                          : k == 1 ? sine
                                   : 0,
                          j == 2   ? cosine
                          : k == 2 ? sine
                                   : 0);
      b = vector_in_lanes(j == 0   ? -sine
                          : k == 0 ? cosine
                                   : 0,
                          j == 1   ? -sine
                          : k == 1 ? cosine
                                   : 0,
                          j == 2   ? -sine
                          : k == 2 ? cosine
                                   : 0);
      q_ = quaternion_in_lanes(c, I == 0 ? s : 0, I == 1 ? s : 0, I == 2 ? s : 0);
    } else {
      const vector_in_lanes turned = cosine * a + sine * b;
      b = cosine * b - sine * a;
      a = turned;
      q_ = c * q_ + q_.template times_unit<I>(s);
    }
  }
  /// Shifted along the I-th of its own axes.
  template <int I>
  DUET_ALWAYS_INLINE void slide(double d) {
    place_ = place_ + d * axis<I>();
  }
  /// Followed by any rigid motion.
  DUET_ALWAYS_INLINE void append(const dual_quaternion<double>& a) {
    const auto r = rotation_matrix(rotation(a));
    const auto t = translation(a);
    place_ = place_ + carried(t[0], t[1], t[2]);
    const vector_in_lanes x = carried(r(0, 0), r(1, 0), r(2, 0));
    const vector_in_lanes y = carried(r(0, 1), r(1, 1), r(2, 1));
    z_ = carried(r(0, 2), r(1, 2), r(2, 2));
    x_ = x;
    y_ = y;
    const auto q = quaternion<double>(q_[0], q_[1], q_[2], q_[3]) * rotation(a);
    q_ = quaternion_in_lanes(q.w(), q.x(), q.y(), q.z());
  }

  /// The twist of a turn about the I-th axis at some rate, in fixed axes.
  template <bool IsSet, int I>
  DUET_ALWAYS_INLINE void write_turn(double* column, double rate) const {
    const vector_in_lanes omega = rate * axis<I>();
    write_twist<IsSet>(column, cross(place_, omega), omega);
  }
  template <bool IsSet, int I>
  DUET_ALWAYS_INLINE void write_slide(double* column, double rate) const {
    write_twist<IsSet>(column, rate * axis<I>(), vector_in_lanes(0, 0, 0));
  }
  /// Any twist ω + εv, told in the frame's own axes.
  template <bool IsSet>
  DUET_ALWAYS_INLINE void write_twist_of(double* column, const dual_vector<double>& twist) const {
    const vector_in_lanes omega = carried(twist[0].value(), twist[1].value(), twist[2].value());
    const vector_in_lanes v = carried(twist[0].epsilon(), twist[1].epsilon(), twist[2].epsilon());
    write_twist<IsSet>(column, v + cross(place_, omega), omega);
  }

  [[nodiscard]] DUET_ALWAYS_INLINE dual_quaternion<double> pose() const {
    const quaternion<double> q(q_[0], q_[1], q_[2], q_[3]);
    const quaternion<double> half(0, place_[0] / 2, place_[1] / 2, place_[2] / 2);
    return make_dual_quaternion(q, half * q);
  }

private:
  template <int I>
  [[nodiscard]] DUET_ALWAYS_INLINE vector_in_lanes& axis() {
    return I == 0 ? x_ : I == 1 ? y_ : z_;
  }
  template <int I>
  [[nodiscard]] DUET_ALWAYS_INLINE const vector_in_lanes& axis() const {
    return I == 0 ? x_ : I == 1 ? y_ : z_;
  }
  [[nodiscard]] DUET_ALWAYS_INLINE vector_in_lanes carried(double x, double y, double z) const {
    return x * x_ + y * y_ + z * z_;
  }

  vector_in_lanes x_{1, 0, 0}, y_{0, 1, 0}, z_{0, 0, 1};
  vector_in_lanes place_{0, 0, 0};
  quaternion_in_lanes q_{1, 0, 0, 0};
};

} // namespace duet::expression::detail
