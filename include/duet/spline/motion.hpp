// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/quaternion/frame.hpp>
#include <duet/quaternion/rotation.hpp>

#include <array>
#include <cstddef>

/// \file
/// Products of exponentials and their exact rates: the recursion behind every cumulative curve.

namespace duet {

/// An orientation and its rates with respect to the parameter: angular velocity (rad per unit),
/// angular acceleration, angular jerk.
template <class T>
struct motion {
  quaternion<T> value;
  vector3<T> velocity;
  vector3<T> acceleration;
  vector3<T> jerk;
};

namespace detail {

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<T> cross(const vector3<T>& a, const vector3<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// c0 exp(ω_1 b_1) exp(ω_2 b_2) … and its rates in body axes, halved (P3, P4 in their true form).
///
/// With e = exp(ω b) the factors are taken in one after the other:
///   w ← e* w e + b′ω,
///   a ← e* a e + b″ω + 2 ŵ × b′ω,               ŵ = e* w e,
///   j ← e* j e + b‴ω + 2 ŵ × b″ω + 4 â × b′ω + 4 (ŵ × b′ω) × b′ω.
/// Q′ = Q w, and 2w, 2a, 2j are angular velocity, acceleration and jerk.
///
/// \tparam Rates  how many of w, a, j are wanted
template <int Rates, class T, std::size_t Factors, class Weights>
[[nodiscard]] DUET_ALWAYS_INLINE motion<T>
product_of_exponentials(const quaternion<T>& start, const vector3<T>* increments,
                        const std::array<Weights, Factors>& weights) {
  motion<T> m{start, {}, {}, {}};
  vector3<T>& w = m.velocity;
  vector3<T>& a = m.acceleration;
  vector3<T>& j = m.jerk;
  for (std::size_t i = 0; i < Factors; ++i) {
    const vector3<T>& omega = increments[i];
    const auto& b = weights[i];
    const quaternion<T> e = duet::exp(vector3<T>(omega * b[0]));
    m.value = m.value * e;
    if constexpr (Rates >= 1) {
      const vector3<T> first = omega * b[1];
      if (i == 0) {
        w = first;
        if constexpr (Rates >= 2) {
          a = omega * b[2];
        }
        if constexpr (Rates >= 3) {
          j = omega * b[3];
        }
        continue;
      }
      const quaternion<T> back = conj(e);
      const vector3<T> w_hat = rotate(back, w);
      w = w_hat + first;
      if constexpr (Rates >= 2) {
        const vector3<T> a_hat = rotate(back, a);
        const vector3<T> second = omega * b[2];
        const vector3<T> turn = cross(w_hat, first);
        a = a_hat + second + T(2) * turn;
        if constexpr (Rates >= 3) {
          j = rotate(back, j) + omega * b[3] + T(2) * cross(w_hat, second) +
              T(4) * (cross(a_hat, first) + cross(turn, first));
        }
      }
    }
  }
  return m;
}

} // namespace detail
} // namespace duet
