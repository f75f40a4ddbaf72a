// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/refused.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/function.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/derivative/seed.hpp>
#include <duet/dual/parts.hpp>
#include <duet/dual/storage/partials.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <type_traits>
#include <utility>

/// \file
/// Jacobians, gradients and Hessians of functions of and into rotations and poses, in tangent
/// coordinates.

namespace duet {

/// What the drivers with a frame differentiate by: scalars, fixed-size vectors, arrays, rotations,
/// poses, and tuples of them.
template <class X>
concept ManifoldPoint = requires {
  manifold<X>::dimension;
};

namespace detail {

/// The tangent coordinates of x as variables, `N` of them from `first` on.
template <class D, int N, class X>
[[nodiscard]] DUET_ALWAYS_INLINE Eigen::Matrix<D, manifold<X>::dimension, 1>
tangent_seeds(int first) {
  Eigen::Matrix<D, manifold<X>::dimension, 1> delta;
  unrolled<manifold<X>::dimension>([&](int i) DUET_INLINE_LAMBDA {
    const bool is_variable = i >= first && i < first + N;
    delta[i] = is_variable ? D::variable(typename D::value_type(0), i - first) : D(0);
  });
  return delta;
}

template <class X>
inline constexpr int tangents_per_pass = std::min(manifold<X>::dimension, single_pass_limit);

/// Calls visit(f(x moved by variables from `first` on), first, count) for every pass over the
/// tangent coordinates of x.
template <class Tag, class F, class X, class Frame, class Visit>
void for_each_tangent_pass(F&& f, const X& x, Frame frame, Visit&& visit) {
  constexpr int size = manifold<X>::dimension;
  static_assert(size > 0, "duet: a Jacobian in tangent coordinates needs vectors of a size known "
                          "at compile time");
  constexpr int n = tangents_per_pass<X>;
  using D = dual<typename manifold<X>::scalar, n, Tag>;
  for (int first = 0; first < size; first += n) {
    visit(result_of_call(call(f, manifold<X>::plus(x, tangent_seeds<D, n, X>(first), frame))),
          first, std::min(n, size - first));
  }
}

template <class X>
concept NeedsFrame =
    ManifoldPoint<X> && !Variables<X> && !Scalar<X> && !Arithmetic<X> && !is_matrix_argument<X>;

} // namespace detail

/// f(x) and the Jacobian ∂y/∂x in tangent coordinates: column j is the velocity of y = f(x) while x
/// moves along its j-th tangent coordinate.
///
/// \param x      a scalar, fixed-size vector, rotation (three coordinates), pose (six), array or
///               `std::tuple` of them, which f takes as one argument or as several
/// \param frame  axes of the tangent coordinates of rotations and poses, on both sides:
///               `frame::spatial`, where x moves as exp(δ/2) x, `frame::body`, where it moves as
///               x exp(δ/2), or `frame::hybrid`, fixed axes too, but δ = [v; ω] moves a pose's
///               origin by v and turns it by ω, neither by the other's
///
/// f may return any of these too, and vectors of a size known at run time. Vectors do not care for
/// the frame.
/// \return `value_and_jacobian`
///
/// Example: `jacobian([](const auto& q) { return conj(q); }, q, frame::body)` is −R(q).
template <class Tag = void, detail::FunctionOfAny F, ManifoldPoint X, FrameConstant Frame>
  requires(!HasOwnJacobian<F>)
[[nodiscard]] auto jacobian(F&& f, const X& x, Frame frame) {
  using tag = detail::tag_for<Tag, F>;
  constexpr int n = detail::tangents_per_pass<X>;
  using D = dual<typename manifold<X>::scalar, n, tag>;
  using output = std::decay_t<decltype(detail::result_of_call(
      detail::call(f, manifold<X>::plus(x, detail::tangent_seeds<D, n, X>(0), frame))))>;
  using value = std::decay_t<decltype(detail::parts<tag>(std::declval<const output&>(), 0))>;
  using target = manifold<value>;
  value_and_jacobian<
      value, Eigen::Matrix<typename target::scalar, target::dimension, manifold<X>::dimension>>
      result{};
  detail::for_each_tangent_pass<tag>(f, x, frame, [&](const output& y, int first, int count) {
    if (first == 0) {
      result.value = detail::parts<tag>(y, 0);
    }
    if constexpr (requires { target::takes_rates_of_any_scalar; }) {
      // Velocities are linear in the rates: those of all columns at once, packed as they are.
      const auto columns = target::velocity(result.value, y, frame);
      for (int i = 0; i < target::dimension; ++i) {
        for (int j = 0; j < count; ++j) {
          result.jacobian(i, first + j) = detail::part<tag>(columns[i], j + 1);
        }
      }
    } else {
      for (int j = 0; j < count; ++j) {
        const auto column = target::velocity(result.value, detail::parts<tag>(y, j + 1), frame);
        if (first + j == 0) {
          result.jacobian.resize(column.size(), manifold<X>::dimension);
        }
        result.jacobian.col(first + j) = column;
      }
    }
  });
  return result;
}

/// f(x) and the gradient in the tangent coordinates of x: gᵀδ is the change of f while x moves by
/// δ. Arguments as `jacobian`; f returns a scalar. \return `value_and_gradient`
template <class Tag = void, detail::FunctionOfAny F, ManifoldPoint X, FrameConstant Frame>
[[nodiscard]] auto gradient(F&& f, const X& x, Frame frame) {
  auto [value, row] = jacobian<Tag>(std::forward<F>(f), x, frame);
  static_assert(Scalar<decltype(value)>, "duet: gradient needs a function that returns a scalar");
  return value_and_gradient<decltype(value),
                            Eigen::Matrix<decltype(value), manifold<X>::dimension, 1>>{
      value, row.transpose()};
}

/// f(x), the gradient and the symmetric Hessian in the tangent coordinates of x. f(x moved by δ) =
/// f + gᵀδ + ½ δᵀHδ + O(δ³), where a rotation moves by exp(δ/2), along geodesics.
///
/// Where f is not stationary, H depends on how rotations move. In both frames it is the same form
/// in other axes: H of `frame::body` is Rᵀ H R of `frame::spatial`, of poses Adᵀ H Ad. Of poses
/// that of `frame::hybrid` is another, as their origins move along straight lines, not along
/// screws. \return `value_gradient_and_hessian`
template <class Tag = void, detail::FunctionOfAny F, ManifoldPoint X, FrameConstant Frame>
[[nodiscard]] auto hessian(F&& f, const X& x, Frame frame) {
  constexpr int n = manifold<X>::dimension;
  static_assert(n > 0, "duet: a Hessian in tangent coordinates needs vectors of a size known at "
                       "compile time");
  // The tangent vector is a vector like any other, at which f is a function of it.
  const auto moved = [&](const auto& delta) {
    return detail::call(f, manifold<X>::plus(x, delta, frame));
  };
  using vector = Eigen::Matrix<typename manifold<X>::scalar, n, 1>;
  return hessian<std::conditional_t<std::is_void_v<Tag>, std::decay_t<F>, Tag>>(
      moved, vector(vector::Zero()));
}

template <class Tag = void, class F, class X, FrameConstant Frame>
  requires(!HasOwnJacobian<F> && !ManifoldPoint<X> && requires { sizeof(structure<X>); })
DUET_REFUSED("no tangent coordinates are known of this type; those of rotations are in "
             "<duet/quaternion/exponential.hpp>, of poses in <duet/dual_quaternion/twist.hpp>")
value_and_jacobian<Eigen::VectorXd, Eigen::MatrixXd> jacobian(F&&, const X&, Frame);

/// To be said where a rotation, pose or tuple is given without a frame.
#define DUET_ASKS_FOR_FRAME(driver, ...)                                                           \
  template <class Tag = void, class F, detail::NeedsFrame X>                                       \
  DUET_REFUSED("to differentiate by rotations, poses or tuples say the frame: " #driver            \
               "(f, x, frame::body)")                                                              \
  __VA_ARGS__                                                                                      \
  driver(F&&, const X&);

DUET_ASKS_FOR_FRAME(jacobian, value_and_jacobian<Eigen::VectorXd, Eigen::MatrixXd>)
DUET_ASKS_FOR_FRAME(gradient, value_and_gradient<double, Eigen::VectorXd>)
DUET_ASKS_FOR_FRAME(hessian, value_gradient_and_hessian<double, Eigen::VectorXd, Eigen::MatrixXd>)

} // namespace duet
