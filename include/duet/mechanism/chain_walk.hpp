// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/known_constant.hpp>
#include <duet/derivative/seed.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/mechanism/half_turns.hpp>
#include <duet/mechanism/joint.hpp>
#include <duet/mechanism/joint_step.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

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

/// Where a link stands in the base.
template <class S>
using link_displacement = displacement<quaternion<S>, three_vector<S>>;

/// From the I-th joint on, the table being known.
template <bool WithRotation, class C, std::size_t I, class S, class Link, class X, class Turns,
          class Visit>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S>
walk_known(const Link& link, const X& theta, const Turns& turns, std::size_t links, Visit&& visit) {
  if constexpr (I == std::size_t(C::joints)) {
    return link;
  } else {
    if (I == links) {
      return link;
    }
    using step = known_step<typename C::arm, I>;
    const S x(vector_argument<X>::get(theta, Eigen::Index(I)));
    const auto seen = [&](const auto&... a) DUET_INLINE_LAMBDA { visit(I, a...); };
    const auto turn = [&]() DUET_INLINE_LAMBDA { return turns[int(I)]; };
    if constexpr (!WithRotation) {
      if (I + 1 == links) {
        return after_joint<false>(link, step{}, x, turn, seen);
      }
    }
    return walk_known<WithRotation, C, I + 1, S>(after_joint<true>(link, step{}, x, turn, seen),
                                                 theta, turns, links, visit);
  }
}

/// Calls visit(i, step, axis, point on it) for the first `links` joints; returns where the frame of
/// the last of them stands, its rotation only if asked for.
template <bool WithRotation, class S, class C, class X, class Visit>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S> walk(const C& chain, const X& theta,
                                                           int links, Visit&& visit) {
  require_size(chain, theta);
  if constexpr (requires { typename C::arm; }) {
    const known_one one;
    const known_zero zero;
    return walk_known<WithRotation, C, 0, S>(
        displacement{partly_known_quaternion{one, zero, zero, zero},
                     three_vector{zero, zero, zero}},
        theta, half_turns<S, C::joints, X>(theta, C::joints, links), std::size_t(links), visit);
  } else {
    link_displacement<S> link{quaternion<S>(S(1)), {S(0), S(0), S(0)}};
    const auto count = std::size_t(links);
    const half_turns<S, C::joints, X> turns(theta, chain.size(), links);
    for (std::size_t i = 0; i < count; ++i) {
      const step_in_memory<typename C::scalar_type> step{chain.steps()[i]};
      const S x(vector_argument<X>::get(theta, Eigen::Index(i)));
      const auto seen = [&](const auto&... a) DUET_INLINE_LAMBDA { visit(i, a...); };
      const auto turn = [&]() DUET_INLINE_LAMBDA { return turns[int(i)]; };
      if (!WithRotation && i + 1 == count) {
        return after_joint<false>(link, step, x, turn, seen);
      }
      link = after_joint<true>(link, step, x, turn, seen);
    }
    return link;
  }
}

/// Where a frame attached to a link stands.
template <class S, class T>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S> attached(const link_displacement<S>& link,
                                                               const placement<T>& offset) {
  const bool is_turned = !(offset.rotation == quaternion<T>(T(1)));
  return {is_turned ? link.rotation * offset.rotation : link.rotation,
          link.point(components(offset.translation))};
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
