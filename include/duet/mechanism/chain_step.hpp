// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/sine_cosine.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/known_constant.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

/// \file
/// One joint after the other along a chain: what every function of a chain is made of.

namespace duet::detail {

/// A joint made ready for evaluation. With the joint's frame displaced by (a, l) from the one
/// before, and n its axis, the next rotation is q (cos(θ/2) a + sin(θ/2) a n).
template <class T>
struct chain_step {
  quaternion<T> a{T(1)};
  quaternion<T> an{};
  triple<T> offset{}; ///< l
  triple<T> axis{};   ///< a n a*, the axis in the frame of the joint before
  T pitch{};          ///< travel along the axis per unit of θ: 1 where it only slides
  bool turns = true;
  bool slides = false;
};

/// A step of a table in memory.
template <class T>
struct step_in_memory {
  const chain_step<T>& s;

  [[nodiscard]] bool turns() const { return s.turns; }
  [[nodiscard]] bool slides() const { return s.slides; }
  template <class S, class HalfTurn>
  [[nodiscard]] DUET_ALWAYS_INLINE partly_known_quaternion<S, S, S, S>
  rotation(const HalfTurn& half_turn) const {
    if (!s.turns) {
      return {S(s.a.w()), S(s.a.x()), S(s.a.y()), S(s.a.z())};
    }
    const sine_cosine<S> half = half_turn();
    const S &s_ = half.sine, &c = half.cosine;
    return {c * s.a.w() + s_ * s.an.w(), c * s.a.x() + s_ * s.an.x(), c * s.a.y() + s_ * s.an.y(),
            c * s.a.z() + s_ * s.an.z()};
  }
  [[nodiscard]] auto offset() const {
    return partly_known_vector{s.offset[0], s.offset[1], s.offset[2]};
  }
  [[nodiscard]] auto axis() const { return partly_known_vector{s.axis[0], s.axis[1], s.axis[2]}; }
  [[nodiscard]] T pitch() const { return s.pitch; }
};

/// The I-th step of a table that the compiler knows.
template <class Arm, std::size_t I>
struct known_step {
  static constexpr const auto& s() { return Arm::chain.steps()[I]; }

  [[nodiscard]] static constexpr bool turns() { return s().turns; }
  [[nodiscard]] static constexpr bool slides() { return s().slides; }
  template <class S, class HalfTurn>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto rotation(const HalfTurn& half_turn) {
    const auto aw = known([] { return s().a.w(); });
    const auto ax = known([] { return s().a.x(); });
    const auto ay = known([] { return s().a.y(); });
    const auto az = known([] { return s().a.z(); });
    if constexpr (!turns()) {
      return partly_known_quaternion{aw, ax, ay, az};
    } else {
      const sine_cosine<S> half = half_turn();
      const S &s_ = half.sine, &c = half.cosine;
      return partly_known_quaternion{c * aw + s_ * known([] { return s().an.w(); }),
                                     c * ax + s_ * known([] { return s().an.x(); }),
                                     c * ay + s_ * known([] { return s().an.y(); }),
                                     c * az + s_ * known([] { return s().an.z(); })};
    }
  }
  [[nodiscard]] static constexpr auto offset() {
    return partly_known_vector{known([] { return s().offset[0]; }),
                               known([] { return s().offset[1]; }),
                               known([] { return s().offset[2]; })};
  }
  [[nodiscard]] static constexpr auto axis() {
    return partly_known_vector{known([] { return s().axis[0]; }), known([] { return s().axis[1]; }),
                               known([] { return s().axis[2]; })};
  }
  [[nodiscard]] static constexpr auto pitch() { return s().pitch; }
};

/// q v q*, of numbers and known constants.
template <class Q, class V>
[[nodiscard]] DUET_ALWAYS_INLINE auto turned(const Q& q, const V& v) {
  const auto tx = 2 * (q.y * v.z - q.z * v.y);
  const auto ty = 2 * (q.z * v.x - q.x * v.z);
  const auto tz = 2 * (q.x * v.y - q.y * v.x);
  return partly_known_vector{v.x + q.w * tx + (q.y * tz - q.z * ty),
                             v.y + q.w * ty + (q.z * tx - q.x * tz),
                             v.z + q.w * tz + (q.x * ty - q.y * tx)};
}

/// N1, of numbers and known constants.
template <class P, class Q>
[[nodiscard]] DUET_ALWAYS_INLINE auto product(const P& p, const Q& q) {
  return partly_known_quaternion{
      p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z, p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
      p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x, p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w};
}

/// Where a link stands, and the axis of the joint that moves it: unit vector and a point on it.
template <class Q, class P>
struct link_state {
  Q rotation;
  P position;
};
template <class Q, class P>
link_state(Q, P) -> link_state<Q, P>;

/// The state after one more joint. `visit(step, axis, position)` is called with the joint's axis in
/// space and a point on it. `WithRotation`: is the rotation after the joint asked for?
template <bool WithRotation, class State, class Step, class S, class HalfTurn, class Visit>
[[nodiscard]] DUET_ALWAYS_INLINE auto after_joint(const State& state, const Step& step,
                                                  const S& theta, const HalfTurn& half_turn,
                                                  Visit&& visit) {
  const auto shift = turned(state.rotation, step.offset());
  const auto axis = turned(state.rotation, step.axis());
  const partly_known_vector<S, S, S> z{number<S>(axis.x), number<S>(axis.y), number<S>(axis.z)};
  partly_known_vector<S, S, S> p{number<S>(state.position.x + shift.x),
                                 number<S>(state.position.y + shift.y),
                                 number<S>(state.position.z + shift.z)};
  if (step.slides()) {
    const S travel = theta * step.pitch();
    p = {p.x + travel * z.x, p.y + travel * z.y, p.z + travel * z.z};
  }
  visit(step, z, p);
  if constexpr (WithRotation) {
    return link_state{product(state.rotation, step.template rotation<S>(half_turn)), p};
  } else {
    return link_state{state.rotation, p};
  }
}

} // namespace duet::detail
