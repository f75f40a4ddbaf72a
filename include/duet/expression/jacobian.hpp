// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/expression/arm/pose_chain.hpp>
#include <duet/expression/tape/derivation.hpp>
#include <duet/expression/tape/program.hpp>
#include <duet/expression/tree/bindings.hpp>
#include <duet/expression/tree/formula.hpp>
#include <duet/expression/tree/node.hpp>
#include <duet/expression/variables.hpp>
#include <duet/quaternion/rotation.hpp>

#include <Eigen/Core>

#include <type_traits>

/// \file
/// Jacobians of formulas of vectors, matrices, rotations and poses.

namespace duet::expression {

namespace detail {

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

/// Evaluates a formula and its Jacobian.
template <class Motions, class Frame>
struct jacobian_of;
template <class... Motions, class Frame>
struct jacobian_of<motion_list<Motions...>, Frame> {
  using result = value_and_jacobian<Eigen::VectorXd, Eigen::MatrixXd>;

  template <class Node, class Bindings>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto of(const Bindings& b) {
    if constexpr (is_pose_chain<Node> && std::is_same_v<typename Bindings::scalar, double>) {
      return by_factors<Node>(b);
    } else {
      return by_columns<Node>(b);
    }
  }

private:
  template <class S, class Value, int Rows>
  using returned = value_and_jacobian<Value, Eigen::Matrix<S, Rows, int(sizeof...(Motions))>>;

  // Two functions, since g++ constructs a result in the memory of the caller only if its scope is
  // the whole function; it would copy one from a block of `if constexpr`.

  template <class Node>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto by_factors(const auto& b) {
    returned<double, dual_quaternion<double>, 6> result;
    constexpr bool is_hybrid = std::is_same_v<Frame, hybrid_frame>;
    using chain = pose_chain<std::conditional_t<is_hybrid, body_frame, Frame>,
                             typename factors<Node>::type, Motions...>;
    result.value = chain::evaluate(result.jacobian.data(), b);
    if constexpr (is_hybrid) { // from body to fixed axes
      const auto r = rotation_matrix(duet::rotation(result.value));
      for (int j = 0; j < result.jacobian.cols(); ++j) {
        auto column = result.jacobian.col(j);
        const vector3<double> v = r * column.template head<3>();
        const vector3<double> omega = r * column.template tail<3>();
        column << v, omega;
      }
    }
    return result;
  }

  template <class Node, class Bindings>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto by_columns(const Bindings& b) {
    using S = typename Bindings::scalar;
    constexpr kind k = Node::kind_of;
    constexpr int rows = k == kind::pose ? 6 : is_matrix(k) ? rows_of(k) * columns_of(k) : 3;
    return evaluated_program<build_derivatives<Node, 1, Frame, Motions...>>(
        b, [](auto& values) DUET_INLINE_LAMBDA {
          returned<S, std::decay_t<decltype(values.template get<0>())>, rows> result;
          result.value = values.template get<0>();
          S* column = result.jacobian.data();
          values.template each<1, int(sizeof...(Motions))>([&](const auto& x) DUET_INLINE_LAMBDA {
            write_column(column, x);
            column += rows;
          });
          return result;
        });
  }
};

template <class F, class Variables, class Frame>
[[nodiscard]] constexpr auto make_jacobian(const F& f) {
  constexpr kind k = F::node_type::kind_of;
  static_assert(
      is_matrix(k) || k == kind::quaternion || k == kind::pose,
      "duet: a Jacobian is that of a vector, a matrix, a rotation or a pose; a scalar formula has "
      "a gradient");
  using jacobian = jacobian_of<typename Variables::template motions_in<Frame>, Frame>;
  return called_by_name<jacobian, F>(f);
}

} // namespace detail

/// Value of f and Jacobian ∂f/∂(u, w …), a function to be called by name:
/// `auto [x, J] = jacobian(f, wrt(u, w), frame::spatial)(u = 0.3, w = w0)`.
///
/// Columns: one for a scalar, three for a vector, one for each entry of a matrix, column by column,
/// six for a dual vector n + εm in the order [m; n], three for a rotation and six for a pose, in
/// tangent coordinates. Rows: the components of a vector; the entries of a matrix, column by column
/// as Eigen stores them; the angular velocity of a rotation (N7); the twist [v; ω] of a pose (N18).
/// Rotations and poses, as f and as variables, are assumed to have unit norm. Their velocities are
/// in `frame::spatial`, `frame::body` or `frame::hybrid`, that of [ṗ; ω] in fixed axes.
template <Formula F, class... Symbols, FrameConstant Frame>
[[nodiscard]] constexpr auto jacobian(const F& f, variables<Symbols...>, Frame) {
  return detail::make_jacobian<F, variables<Symbols...>, Frame>(f);
}

/// Jacobian of a vector or matrix with respect to scalars, vectors and matrices, which needs no
/// frame.
template <Formula F, class... Symbols>
[[nodiscard]] constexpr auto jacobian(const F& f, variables<Symbols...>) {
  static_assert(F::node_type::kind_of != kind::quaternion && F::node_type::kind_of != kind::pose &&
                    ((Symbols::kind_of == kind::scalar || is_matrix(Symbols::kind_of)) && ...),
                "duet: with rotations and poses say the frame: jacobian(f, wrt(u), frame::body)");
  return detail::make_jacobian<F, variables<Symbols...>, void>(f);
}

template <Formula F, class... X>
  requires detail::NoVariables<X...> DUET_REFUSED(
      "by which symbols? jacobian(f, wrt(u, w)), where rotations or poses are among them or "
      "f is one jacobian(f, wrt(u, w), frame::body)")
detail::called_by_name<detail::jacobian_of<detail::motion_list<>, void>, F> jacobian(const F&,
                                                                                     const X&...);

} // namespace duet::expression
