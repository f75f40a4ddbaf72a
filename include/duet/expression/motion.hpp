// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/evaluate/call.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/velocity.hpp>

#include <type_traits>

/// \file
/// Rotations and poses that move with one parameter: velocity and acceleration.

namespace duet::expression {

/// A rotation or pose, its velocity and its acceleration, as columns ω or [v; ω].
template <class Q, class V>
struct moving_value {
  Q value;
  V velocity;
  V acceleration;
};

namespace detail {

/// The motion of a formula, to be called with values for its symbols.
template <class F, class Symbol, class Frame>
class motion_of : public called_by_name<motion_of<F, Symbol, Frame>, F> {
  using base = called_by_name<motion_of, F>;
  using typename base::node;

public:
  using base::base;

  template <class... Arguments>
  [[nodiscard]] DUET_ALWAYS_INLINE auto evaluate(const Arguments&... arguments) const {
    using by_symbol = movement_of_scalar<Symbol>;
    using velocity_node = decltype(velocity_of<Frame, node, by_symbol>());
    using acceleration_node = rate_t<velocity_node, by_symbol>;
    const auto values =
        called<node, velocity_node, acceleration_node>(this->f_.held(), arguments...);
    using S = typename base::template scalar<Arguments...>;
    const auto velocity = column<S>(values.template get<1>());
    return moving_value<std::decay_t<decltype(values.template get<0>())>,
                        std::decay_t<decltype(velocity)>>{values.template get<0>(), velocity,
                                                          column<S>(values.template get<2>())};
  }

private:
  template <class S, class V>
  DUET_ALWAYS_INLINE static auto column(const V& v) {
    if constexpr (is_screw_dual<typename V::Scalar>) {
      return vector6<S>(twist_of(v));
    } else {
      return vector3<S>(v[0], v[1], v[2]);
    }
  }
};

} // namespace detail

/// The motion of a rotation or pose with a scalar symbol, a function to be called by name:
/// `auto [q, omega, alpha] = motion(f, u, frame::body)(u = 0.3)`. ω and its derivative by u of a
/// rotation (N7), the twist [v; ω] and its derivative of a pose (N18), per unit of u, in
/// `frame::spatial` or `frame::body`.
template <Formula F, Symbol U, FrameConstant Frame>
[[nodiscard]] constexpr auto motion(const F& f, const U&, Frame frame) {
  static_cast<void>(duet::detail::is_spatial(frame));
  constexpr kind k = F::node_type::kind_of;
  static_assert((k == kind::quaternion || k == kind::pose) && U::node_type::kind_of == kind::scalar,
                "duet: motion(f, u, frame) is that of a rotation or pose with a scalar symbol");
  return detail::motion_of<F, typename U::node_type, Frame>(f);
}

} // namespace duet::expression
