// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/expression/derivative.hpp>
#include <duet/expression/jacobian.hpp>
#include <duet/expression/tape/derivation.hpp>
#include <duet/expression/tape/program.hpp>
#include <duet/expression/tree/bindings.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>

#include <Eigen/Core>

#include <type_traits>

/// \file
/// Rotations and poses that move with one parameter: velocity and acceleration.

namespace duet::expression {

/// A rotation or pose, its velocity and its acceleration, as columns ω or [v; ω].
template <class Q, class V>
struct moving_value {
  Q value;        ///< the rotation or pose
  V velocity;     ///< ω or [v; ω], per unit of the parameter
  V acceleration; ///< the derivative of `velocity`, per unit of the parameter

  /// For those who extend duet: the fields with their names.
  void for_each_field(const auto& f) const {
    f("value", value);
    f("velocity", velocity);
    f("acceleration", acceleration);
  }
};

namespace detail {

/// Evaluates a formula, its velocity and its acceleration.
template <class Symbol, class Frame>
struct motion_of {
  using result = moving_value<quaternion<double>, Eigen::VectorXd>;

  template <class Node, class Bindings>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto of(const Bindings& b) {
    return evaluated_program<build_derivatives<Node, 2, Frame, moving_scalar<Symbol>>>(
        b, [](auto& values) DUET_INLINE_LAMBDA {
          using value = std::decay_t<decltype(values.template get<0>())>;
          constexpr int rows = Node::kind_of == kind::pose ? 6 : 3;
          moving_value<value, Eigen::Matrix<typename Bindings::scalar, rows, 1>> result;
          result.value = values.template get<0>();
          write_column(result.velocity.data(), values.template get<1>());
          write_column(result.acceleration.data(), values.template get<2>());
          return result;
        });
  }
};

} // namespace detail

/// Value, velocity and acceleration of a rotation or pose with respect to a scalar symbol u, a
/// function to be called by name: `auto [q, omega, alpha] = motion(f, u, frame::body)(u = 0.3)`.
/// The velocity is ω of a rotation (N7) or the twist [v; ω] of a pose (N18), the acceleration its
/// derivative, per unit of u, in `frame::spatial`, `frame::body` or `frame::hybrid`, that of [ṗ; ω]
/// in fixed axes.
template <Formula F, Symbol U, FrameConstant Frame>
[[nodiscard]] constexpr auto motion(const F& f, const U&, Frame) {
  constexpr kind k = F::node_type::kind_of;
  static_assert((k == kind::quaternion || k == kind::pose) && U::node_type::kind_of == kind::scalar,
                "duet: motion(f, u, frame) is that of a rotation or pose with a scalar symbol");
  using motion = detail::motion_of<typename U::node_type, Frame>;
  return detail::called_by_name<motion, F>(f);
}

/// Rejected, as the frame is missing.
template <Formula F, Symbol U>
DUET_REFUSED("the frame is missing: motion(f, u, frame::spatial) or frame::body")
detail::called_by_name<detail::motion_of<typename U::node_type, body_frame>, F> motion(const F&,
                                                                                       const U&);

} // namespace duet::expression
