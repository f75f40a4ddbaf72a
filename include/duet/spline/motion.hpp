// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/quaternion/rotation.hpp>

#include <array>
#include <cstddef>
#include <utility>

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

// Coefficient by coefficient: Eigen's expressions would load two coefficients at once just after
// they were stored one by one, and the processor waits for that.

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<T> cross(const vector3<T>& a, const vector3<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// f a, f of T or below.
template <class T, class F>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<T> product(const F& f, const vector3<T>& a) {
  return {f * a[0], f * a[1], f * a[2]};
}

/// a + b + b + …, n times b.
template <int N = 1, class T>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<T> sum(const vector3<T>& a, const vector3<T>& b) {
  const real_type_t<T> n(N);
  return {a[0] + n * b[0], a[1] + n * b[1], a[2] + n * b[2]};
}

/// One step of the recursion below, with the i-th factor e.
template <int Rates, class T, class Weights>
DUET_ALWAYS_INLINE void take_in_factor(motion<T>& m, std::size_t i, const quaternion<T>& e,
                                       const vector3<T>& omega, const Weights& b) {
  m.value = m.value * e;
  if constexpr (Rates >= 1) {
    const vector3<T> first = product(b[1][i], omega);
    if (i == 0) {
      m.velocity = first;
      if constexpr (Rates >= 2) {
        m.acceleration = product(b[2][i], omega);
      }
      if constexpr (Rates >= 3) {
        m.jerk = product(b[3][i], omega);
      }
      return;
    }
    const quaternion<T> back = conj(e);
    const vector3<T> w_hat = rotate(back, m.velocity);
    m.velocity = sum(w_hat, first);
    if constexpr (Rates >= 2) {
      const vector3<T> a_hat = rotate(back, m.acceleration);
      const vector3<T> second = product(b[2][i], omega);
      const vector3<T> turn = cross(w_hat, first);
      m.acceleration = sum<2>(sum(a_hat, second), turn);
      if constexpr (Rates >= 3) {
        m.jerk = sum(rotate(back, m.jerk), product(b[3][i], omega));
        m.jerk = sum<2>(m.jerk, cross(w_hat, second));
        m.jerk = sum<4>(m.jerk, sum(cross(a_hat, first), cross(turn, first)));
      }
    }
  }
}

/// c0 exp(ω_1 b_1) exp(ω_2 b_2) … and its rates in body axes, halved (P3, P4 in their true form).
///
/// With e = exp(ω b) the factors are taken in one after the other:
///   w ← e* w e + b′ω,
///   a ← e* a e + b″ω + 2 ŵ × b′ω,               ŵ = e* w e,
///   j ← e* j e + b‴ω + 2 ŵ × b″ω + 4 â × b′ω + 4 (ŵ × b′ω) × b′ω,   â = e* a e.
/// Q′ = Q w, and 2w, 2a, 2j are angular velocity, acceleration and jerk.
///
/// \tparam Rates  how many of w, a, j are wanted
/// \param weights  element [d][i] is the d-th derivative of b_{i+1}
template <int Rates, class T, class W, std::size_t Factors>
[[nodiscard]] DUET_ALWAYS_INLINE motion<T>
product_of_exponentials(const quaternion<T>& start, const vector3<T>* increments,
                        const std::array<std::array<W, Factors>, std::size_t(Rates) + 1>& weights) {
  motion<T> m{start, {}, {}, {}};
  const auto factor = [&](std::size_t i) DUET_INLINE_LAMBDA {
    return duet::exp(product(weights[0][i], increments[i]));
  };
  if constexpr (Real<T>) {
    // All exponentials first: between them nothing else is alive that calls could force to memory.
    [&]<std::size_t... I>(std::index_sequence<I...>) DUET_INLINE_LAMBDA {
      const std::array<quaternion<T>, Factors> e{factor(I)...};
      (take_in_factor<Rates>(m, I, e[I], increments[I], weights), ...);
    }
    (std::make_index_sequence<Factors>{});
  } else { // unrolled, dual numbers would take the compiler too long
    for (std::size_t i = 0; i < Factors; ++i) {
      take_in_factor<Rates>(m, i, factor(i), increments[i], weights);
    }
  }
  return m;
}

} // namespace detail
} // namespace duet
