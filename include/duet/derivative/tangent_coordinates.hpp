// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/derivative/manifold.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/partials.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <type_traits>
#include <utility>

/// \file
/// Jacobians, gradients and Hessians of functions of and into rotations and poses, in tangent-space
/// coordinates.

namespace duet {

/// Variables of the drivers with a frame: scalars, vectors, rotations, poses, and arrays,
/// `std::vector`s and tuples of them.
template <class X>
concept ManifoldPoint = requires {
  manifold<X>::dimension;
};

namespace detail {

/// The tangent coordinates of x as variables, `N` of them from `first` on.
template <class D, int N, class X>
[[nodiscard]] DUET_ALWAYS_INLINE Eigen::Matrix<D, manifold<X>::dimension, 1>
tangent_seeds(const X& x, Eigen::Index first) {
  Eigen::Matrix<D, manifold<X>::dimension, 1> delta;
  const auto set = [&](Eigen::Index i) DUET_INLINE_LAMBDA {
    const bool is_variable = i >= first && i < first + N;
    delta[i] = is_variable ? D::variable(typename D::value_type(0), int(i - first)) : D(0);
  };
  if constexpr (manifold<X>::dimension == Eigen::Dynamic) {
    delta.resize(tangent_dimension(x));
    for (Eigen::Index i = 0; i < delta.size(); ++i) {
      set(i);
    }
  } else {
    unrolled<manifold<X>::dimension>(set);
  }
  return delta;
}

template <class X>
inline constexpr int tangents_per_pass = manifold<X>::dimension == Eigen::Dynamic
                                             ? chunk
                                             : std::min(manifold<X>::dimension, single_pass_limit);

/// A single vector whose number of coordinates is known only at run time.
template <class X>
concept RunTimeVector = VectorLike<X> && vector_argument<X>::size_at_compile_time == Eigen::Dynamic;

/// Calls visit(f(x moved by variables from `first` on), first, count) for every pass over the
/// tangent coordinates of x.
template <class Tag, class F, class X, class Frame, class Visit>
void for_each_tangent_pass(F&& f, const X& x, Frame frame, Visit&& visit) {
  constexpr int n = tangents_per_pass<X>;
  using D = dual<typename manifold<X>::scalar, n, Tag>;
  const Eigen::Index size = tangent_dimension(x);
  for (Eigen::Index first = 0; first < size; first += n) {
    visit(result_of_call(call(f, manifold<X>::plus(x, tangent_seeds<D, n>(x, first), frame))),
          first, std::min<Eigen::Index>(n, size - first));
  }
}
template <class Tag, class F, RunTimeVector X, class Frame, class Visit>
void for_each_tangent_pass(F&& f, const X& x, Frame, Visit&& visit) {
  for_each_pass<Tag>(f, x, visit); // vectors ignore the frame
}

/// Argument of f in any of the passes: only its type is used.
template <class Tag, class X, class Frame>
[[nodiscard]] auto moved_in_pass(const X& x, Frame frame) {
  if constexpr (RunTimeVector<X>) {
    return constants_of_pass<Tag, 0>(x);
  } else {
    constexpr int n = tangents_per_pass<X>;
    using D = dual<typename manifold<X>::scalar, n, Tag>;
    return manifold<X>::plus(x, tangent_seeds<D, n>(x, 0), frame);
  }
}

template <class X>
concept NeedsFrame =
    ManifoldPoint<X> && !Variables<X> && !Scalar<X> && !Arithmetic<X> && !is_matrix_argument<X>;

} // namespace detail

/// f(x) and the Jacobian ∂y/∂x in tangent-space coordinates: column j is the velocity of y = f(x)
/// while x moves along its j-th tangent coordinate.
///
/// f may return any of the types of x too. Sizes may be known at run time only, such as those of
/// the configuration of a chain from a file or of a trajectory, a `std::vector` of poses; 16
/// coordinates then take one evaluation of f. Vectors ignore the frame.
///
/// \param x      a scalar, vector, rotation (three coordinates), pose (six), array, `std::vector`
/// or
///   `std::tuple` of them, which f takes as one argument or as several; columns in that order
/// \param frame  axes of the tangent coordinates of rotations and poses, on both sides:
///   `frame::spatial`, left perturbations exp(δ/2) x, `frame::body`, right perturbations x
///   exp(δ/2), or `frame::hybrid`, fixed axes too, but δ = [v; ω] translates a pose's origin by v
///   and rotates it by ω, independently
/// \return `value_and_jacobian`
/// \throws invalid_input if x has no coordinates
///
/// Example: `jacobian([](const auto& q) { return conj(q); }, q, frame::body)` is −R(q).
template <class Tag = void, detail::FunctionOfAny F, ManifoldPoint X, FrameConstant Frame>
  requires(!HasOwnJacobian<F>)
[[nodiscard]] auto jacobian(F&& f, const X& x, Frame frame) {
  using tag = detail::tag_for<Tag, F>;
  using output = std::decay_t<decltype(detail::result_of_call(
      detail::call(f, detail::moved_in_pass<tag>(x, frame))))>;
  using value = std::decay_t<decltype(detail::parts<tag>(std::declval<const output&>(), 0))>;
  using target = manifold<value>;
  value_and_jacobian<
      value, Eigen::Matrix<typename target::scalar, target::dimension, manifold<X>::dimension>>
      result{};
  const Eigen::Index dimension = detail::tangent_dimension(x);
  detail::require(dimension > 0, "duet: jacobian: the function has no variables");
  detail::for_each_tangent_pass<tag>(
      f, x, frame, [&](const output& y, Eigen::Index first, Eigen::Index count) {
        if (first == 0) {
          result.value = detail::parts<tag>(y, 0);
        }
        if constexpr (requires { target::takes_rates_of_any_scalar; }) {
          // Velocities are linear in the rates: computes those of all columns at once, in packed
          // form.
          const auto columns = target::velocity(result.value, y, frame);
          if (first == 0) {
            result.jacobian.resize(target::dimension, dimension);
          }
          for (int i = 0; i < target::dimension; ++i) {
            for (Eigen::Index j = 0; j < count; ++j) {
              result.jacobian(i, first + j) = detail::part<tag>(columns[i], int(j) + 1);
            }
          }
        } else {
          for (Eigen::Index j = 0; j < count; ++j) {
            const auto column =
                target::velocity(result.value, detail::parts<tag>(y, int(j) + 1), frame);
            if (first + j == 0) {
              result.jacobian.resize(column.size(), dimension);
            }
            result.jacobian.col(first + j) = column;
          }
        }
      });
  return result;
}

/// f(x) and the gradient in the tangent-space coordinates of x: gᵀδ is the change of f while x
/// moves by δ. Arguments as `jacobian`; f returns a scalar.
///
/// \return `value_and_gradient`
template <class Tag = void, detail::FunctionOfAny F, ManifoldPoint X, FrameConstant Frame>
[[nodiscard]] auto gradient(F&& f, const X& x, Frame frame) {
  auto [value, row] = jacobian<Tag>(std::forward<F>(f), x, frame);
  static_assert(Scalar<decltype(value)>, "duet: gradient needs a function that returns a scalar");
  return value_and_gradient<decltype(value),
                            Eigen::Matrix<decltype(value), manifold<X>::dimension, 1>>{
      value, row.transpose()};
}

/// f(x), the gradient and the symmetric Hessian in the tangent-space coordinates of x:
/// f(x moved by δ) = f + gᵀδ + ½ δᵀHδ + O(δ³), where a rotation moves by exp(δ/2), along geodesics.
///
/// If f is not stationary, H depends on the perturbation. In `frame::spatial` and `frame::body` it
/// is the same form in other axes: H of `frame::body` is Rᵀ H R of `frame::spatial`, for poses
/// Adᵀ H Ad. For poses that of `frame::hybrid` differs, as their origins move along straight lines,
/// not along screws.
///
/// \return `value_gradient_and_hessian`
template <class Tag = void, detail::FunctionOfAny F, ManifoldPoint X, FrameConstant Frame>
[[nodiscard]] auto hessian(F&& f, const X& x, Frame frame) {
  if constexpr (detail::RunTimeVector<X>) {
    return hessian<Tag>(std::forward<F>(f), x);
  } else {
    // The tangent vector is an ordinary vector, of which f is a function.
    const auto moved = [&](const auto& delta) {
      return detail::call(f, manifold<X>::plus(x, delta, frame));
    };
    using vector = Eigen::Matrix<typename manifold<X>::scalar, manifold<X>::dimension, 1>;
    return hessian<std::conditional_t<std::is_void_v<Tag>, std::decay_t<F>, Tag>>(
        moved, vector(vector::Zero(detail::tangent_dimension(x))));
  }
}

template <class Tag = void, class F, class X, FrameConstant Frame>
  requires(!HasOwnJacobian<F> && !ManifoldPoint<X> && requires { sizeof(structure<X>); })
DUET_REFUSED("this type has no tangent coordinates; those of rotations are in "
             "<duet/quaternion/exponential.hpp>, of poses in <duet/dual_quaternion/twist.hpp>")
value_and_jacobian<Eigen::VectorXd, Eigen::MatrixXd> jacobian(F&&, const X&, Frame);

/// Message for a rotation, pose or tuple without a frame.
#define DUET_ASKS_FOR_FRAME(driver, ...)                                                           \
  template <class Tag = void, class F, detail::NeedsFrame X>                                       \
  DUET_REFUSED(                                                                                    \
      "to differentiate with respect to rotations, poses or tuples pass the frame: " #driver       \
      "(f, x, frame::body)")                                                                       \
  __VA_ARGS__                                                                                      \
  driver(F&&, const X&);

DUET_ASKS_FOR_FRAME(jacobian, value_and_jacobian<Eigen::VectorXd, Eigen::MatrixXd>)
DUET_ASKS_FOR_FRAME(gradient, value_and_gradient<double, Eigen::VectorXd>)
DUET_ASKS_FOR_FRAME(hessian, value_gradient_and_hessian<double, Eigen::VectorXd, Eigen::MatrixXd>)

} // namespace duet
