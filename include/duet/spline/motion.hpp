// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Products of exponentials and their exact rates: the recursion behind every cumulative curve.

namespace duet {

/// Rotation or pose with its rates with respect to the parameter: angular velocity (rad per unit),
/// acceleration and jerk; for poses the twist [v; ω], its first and its second derivative.
template <class T>
struct motion {
  using rate_type = Eigen::Matrix<typename manifold<quaternion<T>>::scalar,
                                  manifold<quaternion<T>>::dimension, 1>;
  quaternion<T> value = {}; ///< rotation or pose
  rate_type velocity =
      detail::zero_initialized<rate_type>(); ///< ω, rad per unit of u; for poses [v; ω]
  rate_type acceleration =
      detail::zero_initialized<rate_type>(); ///< derivative of `velocity`, per unit of u²
  rate_type jerk =
      detail::zero_initialized<rate_type>(); ///< derivative of `acceleration`, per unit of u³

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("value", value);
    f("velocity", velocity);
    f("acceleration", acceleration);
    f("jerk", jerk);
  }
};

template <class T>
struct structure<motion<T>> {
  using scalar = T;
  template <class F, class... Rest>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto map(F&& f, const motion<T>& m, const Rest&... rest) {
    const auto value = map_scalars(f, m.value, rest.value...);
    return motion<typename std::decay_t<decltype(value)>::scalar_type>{
        value, map_scalars(f, m.velocity, rest.velocity...),
        map_scalars(f, m.acceleration, rest.acceleration...), map_scalars(f, m.jerk, rest.jerk...)};
  }
};

/// Motion in time of a curve with time scaling u(t):
///   ω = δ u̇,   ω̇ = δ′u̇² + δ ü,   ω̈ = δ″u̇³ + 3 δ′u̇ü + δ u⃛,
/// where δ, δ′, δ″ are the rates of m with respect to u in any one frame.
///
/// \return `motion<T>`
template <class T, ScalarFor<T> A, ScalarFor<T> B, ScalarFor<T> C>
[[nodiscard]] auto apply_time_scaling(const motion<T>& m, const A& u_dot, const B& u_ddot,
                                      const C& u_dddot) {
  using S = promote_t<promote_t<A, B>, C>;
  using result = motion<promote_t<T, S>>;
  using rate = typename result::rate_type;
  using scalar = typename rate::Scalar;
  const rate v = m.velocity.template cast<scalar>();
  const rate a = m.acceleration.template cast<scalar>();
  const rate j = m.jerk.template cast<scalar>();
  const scalar first(u_dot), second(u_ddot), third(u_dddot);
  const scalar square = first * first;
  return result{quaternion<promote_t<T, S>>(m.value), rate(v * first),
                rate(a * square + v * second),
                rate(j * (square * first) + a * (3 * first * second) + v * third)};
}

namespace detail {

/// Motion whose rates are dual vectors, halved, in body axes.
template <class T>
struct half_motion {
  quaternion<T> value;
  three_vector<T> velocity;
  three_vector<T> acceleration;
  three_vector<T> jerk;
};

/// One step of the recursion below, with the i-th factor e.
template <int Rates, class T, class U, class Weights>
DUET_ALWAYS_INLINE void take_in_factor(half_motion<T>& m, std::size_t i, const quaternion<T>& e,
                                       const vector3<U>* omega, const Weights& b) {
  const auto times_omega = [&](const auto& factor) DUET_INLINE_LAMBDA {
    return three_vector<T>(factor * components(omega[i]));
  };
  if (i > 0) {
    m.value = m.value * e;
  }
  if constexpr (Rates >= 1) {
    if (i == 0) {
      m.velocity = times_omega(b[1][0]);
      if constexpr (Rates >= 2) {
        m.acceleration = times_omega(b[2][0]);
      }
      if constexpr (Rates >= 3) {
        m.jerk = times_omega(b[3][0]);
      }
      return;
    }
    const quaternion<T> back = conj(e);
    [[maybe_unused]] const real_type_t<T> two(2);
    three_vector<T> w_hat, a_hat, j_hat;
    if (i == 1) { // all rates are multiples of one vector, which e* … e rotates once
      const three_vector<T> omega_hat = rotated(back, components(omega[0]));
      w_hat = b[1][0] * omega_hat;
      if constexpr (Rates >= 2) {
        a_hat = b[2][0] * omega_hat;
      }
      if constexpr (Rates >= 3) {
        j_hat = b[3][0] * omega_hat;
      }
    } else {
      if constexpr (Rates == 1) {
        w_hat = rotated(back, m.velocity);
      } else {
        const rotation_of_many rotate_back(back);
        w_hat = rotate_back(m.velocity);
        a_hat = rotate_back(m.acceleration);
        if constexpr (Rates >= 3) {
          j_hat = rotate_back(m.jerk);
        }
      }
    }
    m.velocity = w_hat + times_omega(b[1][i]);
    if constexpr (Rates >= 2) {
      const auto w_hat_cross_rate = cross(w_hat, times_omega(b[1][i]));
      m.acceleration = a_hat + times_omega(b[2][i]) + two * w_hat_cross_rate;
      if constexpr (Rates >= 3) {
        const auto sum = b[2][i] * w_hat + two * (b[1][i] * (a_hat + w_hat_cross_rate));
        m.jerk = j_hat + times_omega(b[3][i]) + two * cross(sum, components(omega[i]));
      }
    }
  }
}

/// Product c0 exp(ω_1 b_1) exp(ω_2 b_2) … and its rates in body axes, halved (P3, P4 in their true
/// form).
///
/// With e = exp(ω b) the factors are taken in one after the other:
///   w ← e* w e + b′ω,
///   a ← e* a e + b″ω + 2 ŵ × b′ω,               ŵ = e* w e,
///   j ← e* j e + b‴ω + 2 (b″ŵ + 2b′(â + ŵ × b′ω)) × ω,   â = e* a e.
/// Q′ = Q w, and 2w, 2a, 2j are angular velocity, acceleration and jerk.
///
/// \tparam Rates   number of the rates w, a, j that are computed
/// \param weights  element [d][i] is the d-th derivative of b_{i+1}
template <int Rates, class T, class W, std::size_t Factors>
[[nodiscard]] DUET_ALWAYS_INLINE half_motion<promote_t<T, W>>
product_of_exponentials(const quaternion<T>& start, const vector3<T>* increments,
                        const std::array<std::array<W, Factors>, std::size_t(Rates) + 1>& weights) {
  using D = promote_t<T, W>;
  half_motion<D> m;
  const auto factor = [&](std::size_t i) DUET_INLINE_LAMBDA {
    return exp_of_multiple(weights[0][i], increments[i]);
  };
  if constexpr (sizeof(D) <= 4 * sizeof(real_type_t<D>)) {
    // All exponentials are computed first: then calls have no other values to spill to memory.
    [&]<std::size_t... I>(std::index_sequence<I...>) DUET_INLINE_LAMBDA {
      const std::array<quaternion<D>, Factors> e{factor(I)...};
      m.value = start * e[0];
      (take_in_factor<Rates>(m, I, e[I], increments, weights), ...);
    }
    (std::make_index_sequence<Factors>{});
  } else { // unrolled code of larger numbers would take the compiler too long
    for (std::size_t i = 0; i < Factors; ++i) {
      const quaternion<D> e = factor(i);
      if (i == 0) {
        m.value = start * e;
      }
      take_in_factor<Rates>(m, i, e, increments, weights);
    }
  }
  return m;
}

/// Converts twists in body axes to the motion of the body's origin, ṫ = R v, and to fixed axes,
/// without cancellation at any distance of the body from the origin:
///   ẗ = R(v̇ + ω × v),   t⃛ = R(v̈ + ω̇ × v + 2ω × v̇ + ω × (ω × v)).
template <class T>
void follow_origin(motion<T>& m) {
  using rate = typename motion<T>::rate_type;
  using vector = three_vector<typename rate::Scalar>;
  const rotation_of_many to_fixed_axes(rotation(m.value));
  const auto linear = [](const rate& r) { return vector{r[0], r[1], r[2]}; };
  const auto angular = [](const rate& r) { return vector{r[3], r[4], r[5]}; };
  const vector v = linear(m.velocity), omega = angular(m.velocity);
  const vector v_dot = linear(m.acceleration), alpha = angular(m.acceleration);
  const vector across = cross(omega, v);
  const auto set = [&](rate& r, const vector& along, const vector& about) {
    r << to_fixed_axes(along).eigen(), to_fixed_axes(about).eigen();
  };
  set(m.jerk, linear(m.jerk) + cross(alpha, v) + 2 * cross(omega, v_dot) + cross(omega, across),
      angular(m.jerk) + cross(omega, alpha));
  set(m.acceleration, v_dot + across, alpha);
  set(m.velocity, v, omega);
}

/// Full rates from halved ones. Rotating axes change only the second derivative of V^s = A V^b A*:
/// V̇^s = A V̇^b A*, V̈^s = A (V̈^b + V^b × V̇^b) A*.
template <class T, class Frame>
[[nodiscard]] DUET_ALWAYS_INLINE motion<T> motion_of(half_motion<T> m, Frame) {
  constexpr bool is_pose = contains_tag<T, screw_tag>();
  constexpr bool is_hybrid = is_pose && std::is_same_v<Frame, hybrid_frame>;
  constexpr bool is_rotated = [] {
    if constexpr (is_hybrid) {
      return false; // rotated by the rotation alone, below
    } else {
      return is_spatial(rotation_frame_of(Frame{}));
    }
  }();
  const real_type_t<T> two(2);
  if constexpr (is_rotated) {
    m.jerk = m.jerk + two * cross(m.velocity, m.acceleration);
    m.velocity = rotated(m.value, m.velocity);
    m.acceleration = rotated(m.value, m.acceleration);
    m.jerk = rotated(m.value, m.jerk);
  }
  m.velocity = two * m.velocity;
  m.acceleration = two * m.acceleration;
  m.jerk = two * m.jerk;
  if constexpr (!is_pose) {
    return {m.value, m.velocity, m.acceleration, m.jerk};
  } else {
    motion<T> result{m.value, twist_of(m.velocity.eigen()), twist_of(m.acceleration.eigen()),
                     twist_of(m.jerk.eigen())};
    if constexpr (is_hybrid) {
      follow_origin(result);
    }
    return result;
  }
}

} // namespace detail
} // namespace duet
