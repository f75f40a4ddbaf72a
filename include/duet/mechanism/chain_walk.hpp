// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/derivative/seed.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/mechanism/chain_step.hpp>
#include <duet/mechanism/half_turns.hpp>
#include <duet/mechanism/joint.hpp>

#include <concepts>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

/// \file
/// Along a chain from its base to one of its links, in a loop over a table in memory or unrolled
/// over one that the compiler knows.

namespace duet {

/// A chain: what it is made of is in `steps()`.
template <class C>
concept SerialChain = requires(const C& chain) {
  typename C::scalar_type;
  typename C::own_jacobian;
  C::joints;
  chain.steps();
};

namespace detail {

/// The scalar of a chain's results at coordinates X.
template <class C, class X>
using chain_scalar = promote_t<typename C::scalar_type, typename vector_argument<X>::scalar>;

template <class C, class X>
void require_size(const C& chain, const X& theta) {
  using argument = vector_argument<X>;
  if constexpr (C::joints > 0 && argument::size_at_compile_time > 0) {
    static_assert(C::joints == argument::size_at_compile_time,
                  "duet: a chain takes as many coordinates as it has moving joints");
  } else if (argument::size(theta) != chain.size()) {
    throw invalid_input("duet: a chain of " + std::to_string(chain.size()) +
                        " moving joints, but " + std::to_string(argument::size(theta)) +
                        " coordinates");
  }
}

template <class S>
using numeric_state = link_state<partly_known_quaternion<S, S, S, S>, partly_known_vector<S, S, S>>;

template <class S, class State>
[[nodiscard]] DUET_ALWAYS_INLINE numeric_state<S> as_numbers(const State& s) {
  return {{number<S>(s.rotation.w), number<S>(s.rotation.x), number<S>(s.rotation.y),
           number<S>(s.rotation.z)},
          {number<S>(s.position.x), number<S>(s.position.y), number<S>(s.position.z)}};
}

/// From the I-th joint on, the table being known.
template <bool WithRotation, class C, std::size_t I, class S, class State, class X, class Turns,
          class Visit>
[[nodiscard]] DUET_ALWAYS_INLINE numeric_state<S> walk_known(const State& state, const X& theta,
                                                             const Turns& turns, std::size_t links,
                                                             Visit&& visit) {
  if constexpr (I == std::size_t(C::joints)) {
    return as_numbers<S>(state);
  } else {
    if (I == links) {
      return as_numbers<S>(state);
    }
    using step = known_step<typename C::arm, I>;
    const S x(vector_argument<X>::get(theta, Eigen::Index(I)));
    const auto seen = [&](const auto&... a) DUET_INLINE_LAMBDA { visit(I, a...); };
    const auto turn = [&]() DUET_INLINE_LAMBDA { return turns[int(I)]; };
    if constexpr (!WithRotation) {
      if (I + 1 == links) {
        return as_numbers<S>(after_joint<false>(state, step{}, x, turn, seen));
      }
    }
    return walk_known<WithRotation, C, I + 1, S>(after_joint<true>(state, step{}, x, turn, seen),
                                                 theta, turns, links, visit);
  }
}

/// Calls visit(i, step, axis, point on it) for the first `links` joints; returns where the frame of
/// the last of them stands, its rotation only if asked for.
template <bool WithRotation, class S, class C, class X, class Visit>
[[nodiscard]] DUET_ALWAYS_INLINE numeric_state<S> walk(const C& chain, const X& theta, int links,
                                                       Visit&& visit) {
  require_size(chain, theta);
  if constexpr (requires { typename C::arm; }) {
    const known_unit<1> one;
    const known_zero zero;
    return walk_known<WithRotation, C, 0, S>(
        link_state{partly_known_quaternion{one, zero, zero, zero},
                   partly_known_vector{zero, zero, zero}},
        theta, half_turns<S, C::joints, X>(theta, C::joints, links), std::size_t(links), visit);
  } else {
    numeric_state<S> state{{S(1), S(0), S(0), S(0)}, {S(0), S(0), S(0)}};
    const auto count = std::size_t(links);
    const half_turns<S, C::joints, X> turns(theta, chain.size(), links);
    for (std::size_t i = 0; i < count; ++i) {
      const step_in_memory<typename C::scalar_type> step{chain.steps()[i]};
      const S x(vector_argument<X>::get(theta, Eigen::Index(i)));
      const auto seen = [&](const auto&... a) DUET_INLINE_LAMBDA { visit(i, a...); };
      const auto turn = [&]() DUET_INLINE_LAMBDA { return turns[int(i)]; };
      if (!WithRotation && i + 1 == count) {
        return as_numbers<S>(after_joint<false>(state, step, x, turn, seen));
      }
      state = after_joint<true>(state, step, x, turn, seen);
    }
    return state;
  }
}

/// The rotation and the position of a frame attached to a link.
template <class S>
struct attached_state {
  quaternion<S> rotation;
  vector3<S> position;
};

template <class S, class T>
[[nodiscard]] DUET_ALWAYS_INLINE attached_state<S> attach(const numeric_state<S>& link,
                                                          const placement<T>& offset) {
  const auto [q, p] = link;
  const auto& r = offset.rotation;
  const auto& t = offset.translation;
  const auto shift = turned(q, partly_known_vector{t[0], t[1], t[2]});
  const bool is_turned = !(r == quaternion<T>(T(1)));
  const quaternion<S> rotation(q.w, q.x, q.y, q.z);
  return {is_turned ? rotation * r : rotation,
          vector3<S>(p.x + shift.x, p.y + shift.y, p.z + shift.z)};
}

inline constexpr auto visit_nothing = [](const auto&...) {};

} // namespace detail

/// What functions of a chain are about unless told otherwise.
struct tip_of_chain {};

/// What a function of a chain may be about: its tip, the link of a number, a frame on a link.
template <class At, class C>
concept PlaceOnChain = std::same_as<At, tip_of_chain> || std::integral<At> ||
    std::same_as<At, attached_frame<typename C::scalar_type>>;

namespace detail {

template <class C, PlaceOnChain<C> At>
[[nodiscard]] constexpr decltype(auto) frame_on(const C& chain, const At& at) {
  if constexpr (std::same_as<At, tip_of_chain>) {
    return chain.tip();
  } else if constexpr (std::integral<At>) {
    return chain.link(int(at));
  } else {
    return (at);
  }
}

} // namespace detail
} // namespace duet
