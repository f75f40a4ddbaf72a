// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/frame.hpp>
#include <duet/expression/algebra/product.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/evaluate/variables.hpp>
#include <duet/expression/rotation.hpp>
#include <duet/expression/screw.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/tree/number.hpp>
#include <duet/expression/vector.hpp>

#include <type_traits>

/// \file
/// Velocities of rotations and poses as formulas (N7, N18): three and six numbers instead of four
/// and eight, in the requested frame. In spatial axes the contribution of a factor of a product is
/// displaced by the factors before it, in body axes by those behind it.

namespace duet::expression::detail {

/// Rotation or pose that moves with a velocity, given in a frame.
template <class Symbol, class Velocity, class Frame>
struct rotating {};

template <class Symbol, class Velocity, class... Rest>
struct rate_of_symbol<Symbol, movement<rotating<Symbol, Velocity, spatial_frame>, Rest...>> {
  using type = decltype(number_node<bits_of(0.5)>{} * (apply<op::pure>(Velocity{}) * Symbol{}));
};
template <class Symbol, class Velocity, class... Rest>
struct rate_of_symbol<Symbol, movement<rotating<Symbol, Velocity, body_frame>, Rest...>> {
  using type = decltype(number_node<bits_of(0.5)>{} * (Symbol{} * apply<op::pure>(Velocity{})));
};

/// Velocity of a rotation or pose: the vector or dual vector ω of q̇ = ½ ω q (spatial) or ½ q ω
/// (body).
template <class Frame, class Q, class Motion>
[[nodiscard]] constexpr auto velocity_of();

template <class Frame, class Q, class Rate>
[[nodiscard]] constexpr auto velocity_by_rate(Q q, Rate rate) {
  if constexpr (std::is_same_v<Frame, spatial_frame>) {
    return whole<2> * apply<op::vec>(rate * apply<op::conj>(q));
  } else {
    return whole<2> * apply<op::vec>(apply<op::conj>(q) * rate);
  }
}

/// ω + ε(v ± x) of a twist ω + εv: the twist with the velocity of another point.
template <class Operation>
[[nodiscard]] constexpr auto at_point(auto twist, auto x) {
  return apply<op::dual_vector_of>(apply<op::part_of_dual<false>>(twist),
                                   apply<Operation>(apply<op::part_of_dual<true>>(twist), x));
}

template <class Node, class Motion, class Frame>
struct velocity {
  static constexpr auto make() { return velocity_by_rate<Frame>(Node{}, rate_t<Node, Motion>{}); }
};

template <class Symbol, class Motion, class Frame>
struct velocity_of_symbol;
template <class Symbol, class Rate, class... Rest, class Frame>
struct velocity_of_symbol<Symbol, movement<moving<Symbol, Rate>, Rest...>, Frame> {
  static constexpr auto make() { return velocity_by_rate<Frame>(Symbol{}, Rate{}); }
};
template <class Symbol, class V, class FrameOfV, class... Rest, class Frame>
struct velocity_of_symbol<Symbol, movement<rotating<Symbol, V, FrameOfV>, Rest...>, Frame> {
  static constexpr auto make() {
    if constexpr (std::is_same_v<Frame, FrameOfV>) {
      return V{};
    } else if constexpr (std::is_same_v<Frame, spatial_frame>) {
      return apply<op::rotate>(Symbol{}, V{});
    } else {
      return apply<op::rotate>(apply<op::conj>(Symbol{}), V{});
    }
  }
};
template <class Symbol, class Other, class... Rest, class Frame>
struct velocity_of_symbol<Symbol, movement<Other, Rest...>, Frame>
    : velocity_of_symbol<Symbol, movement<Rest...>, Frame> {};

template <kind K, char... Letters, class Motion, class Frame>
struct velocity<symbol_node<K, Letters...>, Motion, Frame>
    : velocity_of_symbol<symbol_node<K, Letters...>, Motion, Frame> {};

template <class A, class B, class Motion, class Frame>
  requires(A::kind_of != kind::scalar)
struct velocity<applied_node<op::product, A, B>, Motion, Frame> {
  static constexpr auto make() {
    constexpr auto a = velocity_of<Frame, A, Motion>();
    constexpr auto b = velocity_of<Frame, B, Motion>();
    if constexpr (std::is_same_v<Frame, spatial_frame>) {
      return a + apply<op::rotate>(A{}, b);
    } else {
      return apply<op::rotate>(apply<op::conj>(B{}), a) + b;
    }
  }
};

template <class A, class Motion, class Frame>
struct velocity<applied_node<op::conj, A>, Motion, Frame> {
  static constexpr auto make() {
    using other =
        std::conditional_t<std::is_same_v<Frame, spatial_frame>, body_frame, spatial_frame>;
    return -velocity_of<other, A, Motion>();
  }
};

template <class A, class Motion, class Frame>
struct velocity<applied_node<op::negative, A>, Motion, Frame> {
  static constexpr auto make() { return velocity_of<Frame, A, Motion>(); }
};

template <class A, class Motion, class Frame>
struct velocity<applied_node<op::rotation, A>, Motion, Frame> {
  static constexpr auto make() {
    return apply<op::part_of_dual<false>>(velocity_of<Frame, A, Motion>());
  }
};

template <class N, class Angle, class S, class C, class Motion, class Frame>
  requires is_zero<rate_t<N, Motion>>
struct velocity<applied_node<op::axis_exponential, N, Angle, S, C>, Motion, Frame> {
  static constexpr auto make() { return rate_t<Angle, Motion>{} * N{}; }
};

template <class V, class Motion, class Frame>
  requires(!is_zero<rate_along<V, rate_t<V, Motion>>>)
struct velocity<applied_node<op::exp_vector, V>, Motion, Frame> {
  static constexpr auto make() {
    return (whole<2> * rate_along<V, rate_t<V, Motion>>{}) * direction_t<V>{};
  }
};

template <class Frame, class Q, class Motion>
[[nodiscard]] constexpr auto velocity_of() {
  if constexpr (is_zero<rate_t<Q, Motion>>) {
    return zero_of<vector_kind(Q::kind_of)>();
  } else if constexpr (std::is_same_v<Frame, hybrid_frame>) {
    constexpr auto twist = velocity_of<spatial_frame, Q, Motion>();
    if constexpr (Q::kind_of == kind::pose) { // ṗ = v + ω × p
      constexpr auto p = apply<op::translation>(Q{});
      return at_point<op::sum>(twist, apply<op::cross>(apply<op::part_of_dual<false>>(twist), p));
    } else {
      return twist;
    }
  } else {
    return velocity<Q, Motion, Frame>::make();
  }
}

/// (q v q*)˙ = ω × q v q* + q v̇ q*, for unit q.
template <class Q, class V, class Motion>
struct rate<applied_node<op::rotate, Q, V>, Motion> {
  static constexpr auto make() {
    using node = applied_node<op::rotate, Q, V>;
    return apply<op::cross>(velocity_of<spatial_frame, Q, Motion>(), node{}) +
           apply<op::rotate>(Q{}, rate_t<V, Motion>{});
  }
  using type = decltype(make());
};

/// ṫ = v + ω × t of the twist ω + εv in spatial axes (N18).
template <class A, class Motion>
struct rate<applied_node<op::translation, A>, Motion> {
  static constexpr auto make() {
    constexpr auto twist = velocity_of<spatial_frame, A, Motion>();
    return apply<op::part_of_dual<true>>(twist) +
           apply<op::cross>(apply<op::part_of_dual<false>>(twist),
                            applied_node<op::translation, A>{});
  }
  using type = decltype(make());
};

template <class Symbol, class Frame, kind K, int... I>
using rotating_about_axes =
    motion_list<movement<rotating<Symbol, unit_vector_node<K, I>, Frame>>...>;

template <class Symbol, class Frame>
struct directions<Symbol, Frame, kind::quaternion> {
  using type = rotating_about_axes<Symbol, Frame, kind::vector, 0, 1, 2>;
};
template <class Symbol>
struct directions<Symbol, hybrid_frame, kind::quaternion>
    : directions<Symbol, spatial_frame, kind::quaternion> {};
/// Unit twists in the order [v; ω].
template <class Symbol, class Frame>
struct directions<Symbol, Frame, kind::pose> {
  using type = rotating_about_axes<Symbol, Frame, kind::dual_vector, 3, 4, 5, 0, 1, 2>;
};
template <class Symbol>
struct directions<Symbol, hybrid_frame, kind::pose> {
  template <int I>
  static constexpr auto spatial_twist() { // v = ṗ − ω × p
    constexpr auto e = unit_vector_node<kind::dual_vector, I>{};
    constexpr auto omega = apply<op::part_of_dual<false>>(e);
    return at_point<op::difference>(e, apply<op::cross>(omega, apply<op::translation>(Symbol{})));
  }
  template <int... I>
  using rotating_at_point =
      motion_list<movement<rotating<Symbol, decltype(spatial_twist<I>()), spatial_frame>>...>;
  using type = rotating_at_point<3, 4, 5, 0, 1, 2>;
};

/// Writes the components of a vector; of a twist ω + εv those of [v; ω].
template <class T, class V>
DUET_ALWAYS_INLINE void write_column(T* column, const V& v) {
  if constexpr (is_screw_dual<typename V::Scalar>) {
    for (int i = 0; i < 3; ++i) {
      column[i] = v[i].epsilon();
      column[3 + i] = v[i].value();
    }
  } else {
    for (int i = 0; i < int(V::SizeAtCompileTime); ++i) {
      column[i] = v.data()[i];
    }
  }
}

} // namespace duet::expression::detail
