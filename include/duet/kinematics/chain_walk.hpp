// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/vector_sine_cosine.hpp>
#include <duet/core/compiler/vector.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/math.hpp>
#include <duet/dual/partials.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual/rules/elementary.hpp>
#include <duet/dual_quaternion/displacement.hpp>
#include <duet/kinematics/joint.hpp>
#include <duet/kinematics/joint_step.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

/// \file
/// Traversal of a chain from its base to one of its links, as a loop over a table in memory or
/// unrolled over a table known to the compiler. For those who extend duet.

namespace duet {

/// A serial chain, whose evaluation steps are in `steps()`.
template <class C>
concept SerialChain = requires(const C& chain) {
  typename C::scalar_type;
  typename C::own_jacobian;
  C::joints;
  chain.steps();
};

namespace detail {

/// The scalar of a chain's results at a configuration of type X.
template <class C, class X>
using chain_scalar = promote_t<typename C::scalar_type, typename vector_argument<X>::scalar>;

template <class C, class X>
void require_size(const C& chain, const X& theta) {
  using argument = vector_argument<X>;
  if constexpr (C::joints > 0 && argument::size_at_compile_time > 0) {
    static_assert(C::joints == argument::size_at_compile_time,
                  "duet: a chain takes as many coordinates as it has moving joints");
  } else if (argument::size(theta) != chain.size()) {
    raise(invalid_input("duet: serial_chain: " + std::to_string(argument::size(theta)) +
                        " coordinates (expected " + std::to_string(chain.size()) + ")"));
  }
}

/// sin(θ/2) and cos(θ/2) of the joints of a chain. For doubles, and values of duals over doubles,
/// they are computed in SIMD vectors, in a quarter of the time of one call of the C library after
/// the other.
///
/// \tparam S  scalar of the results
/// \tparam N  number of joints; negative: up to −N; 0: any
/// \tparam X  type of the configuration θ
template <class S, int N, class X>
class half_angle_sincos {
  static constexpr int max_joints = N > 0 ? N : -N;
  static constexpr bool at_once = max_joints > 1 && std::same_as<real_type_t<S>, double>;
  // Eight lanes are not faster.
  static constexpr int lanes = DUET_VECTOR_BYTES < 32 ? 2 : 4;
  static constexpr int vectors = at_once ? (max_joints + lanes - 1) / lanes : 0;
  using packet = vector_of<double, lanes>;

public:
  /// \param size   number of joints
  /// \param count  number of joints from the base on whose sines are required
  DUET_ALWAYS_INLINE half_angle_sincos(const X& theta, int size, int count) : theta_(theta) {
    if constexpr (at_once) {
      const auto take = [&](int v) DUET_INLINE_LAMBDA {
        const auto at = [&](int k) DUET_INLINE_LAMBDA {
          const int i = v * lanes + k;
          return i < (N > 0 ? N : size) ? innermost(half(i)) : 0.;
        };
        if (v * lanes < count) {
          if constexpr (lanes == 2) {
            values_[std::size_t(v)] = vector_sine_and_cosine(packet{at(0), at(1)});
          } else {
            values_[std::size_t(v)] = vector_sine_and_cosine(packet{at(0), at(1), at(2), at(3)});
          }
        }
      };
      if constexpr (N > 0) { // constant indices keep coordinates in registers
        unrolled<vectors>(take);
      } else {
        for (int v = 0; v * lanes < count; ++v) {
          take(v);
        }
      }
    }
  }
  [[nodiscard]] DUET_ALWAYS_INLINE sine_cosine<S> operator[](int i) const {
    if constexpr (at_once) {
      const auto& both = values_[std::size_t(i / lanes)];
      return sine_and_cosine_from(sine_cosine<double>{both.sine[i % lanes], both.cosine[i % lanes]},
                                  half(i));
    } else {
      return sine_and_cosine_of(half(i));
    }
  }

private:
  [[nodiscard]] DUET_ALWAYS_INLINE S half(int i) const {
    return S(S(vector_argument<X>::get(theta_, i)) / 2);
  }

  const X& theta_;
  std::array<sine_cosine<packet>, std::size_t(vectors)> values_;
};

/// Pose of a link relative to the base.
template <class S>
using link_displacement = displacement<quaternion<S>, three_vector<S>>;

/// Traversal from the I-th joint on of a table known to the compiler.
template <bool WithRotation, class C, int I, class S, class Link, class X, class HalfAngles,
          class Visit>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S>
traverse_static(const Link& link, const X& theta, const HalfAngles& half_angles, int links,
                const Visit& visit) {
  if constexpr (I == C::joints) {
    return link;
  } else {
    if (I == links) {
      return link;
    }
    const known_step<typename C::arm, std::size_t(I)> step;
    const S x(vector_argument<X>::get(theta, I));
    if constexpr (!WithRotation) {
      if (I + 1 == links) {
        return after_joint<false>(link, step, I, x, half_angles, visit);
      }
    }
    return traverse_static<WithRotation, C, I + 1, S>(
        after_joint<true>(link, step, I, x, half_angles, visit), theta, half_angles, links, visit);
  }
}

/// Calls visit(i, step, axis, point on it) for the first `links` joints and returns the frame of
/// the last of them, with its rotation only if required.
template <bool WithRotation, class S, class C, class X, class Visit>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S> walk(const C& chain, const X& theta,
                                                           int links, const Visit& visit) {
  require_size(chain, theta);
  const half_angle_sincos<S, C::joints, X> half_angles(theta, chain.size(), links);
  if constexpr (requires { typename C::arm; }) {
    const known_one one;
    const known_zero zero;
    return traverse_static<WithRotation, C, 0, S>(
        displacement{partially_constant_quaternion{one, zero, zero, zero},
                     three_vector{zero, zero, zero}},
        theta, half_angles, links, visit);
  } else {
    link_displacement<S> link{quaternion<S>(S(1)), {S(0), S(0), S(0)}};
    for (int i = 0; i < links; ++i) {
      const step_in_memory<typename C::scalar_type> step{chain.steps()[std::size_t(i)]};
      const S x(vector_argument<X>::get(theta, i));
      if (!WithRotation && i + 1 == links) {
        return after_joint<false>(link, step, i, x, half_angles, visit);
      }
      link = after_joint<true>(link, step, i, x, half_angles, visit);
    }
    return link;
  }
}

/// Pose of a frame attached to a link.
template <class S, class T>
[[nodiscard]] DUET_ALWAYS_INLINE link_displacement<S> attached(const link_displacement<S>& link,
                                                               const placement<T>& offset) {
  const bool has_rotation = !(offset.rotation == quaternion<T>(T(1)));
  return {has_rotation ? link.rotation * offset.rotation : link.rotation,
          link.point(components(offset.translation))};
}

inline constexpr auto visit_nothing = [](const auto&...) {};

} // namespace detail

/// Default frame of the functions of a chain: its tip.
struct tip_of_chain {};

/// A frame argument of a function of a chain: the tip, a link number, or a frame on a link.
template <class At, class C>
concept FrameOnChain = std::same_as<At, tip_of_chain> || std::integral<At> ||
    std::same_as<At, attached_frame<typename C::scalar_type>>;

namespace detail {

template <class C, FrameOnChain<C> At>
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
