// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/dual/level.hpp>

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

/// \file
/// Jacobians and directional derivatives of functions of a vector; Jacobians with respect to
/// thousands of components in passes of a chosen size, into memory of the caller.

namespace duet {

/// Result of `jacobian`: y = f(x), and ∂y/∂x, a row for each component of y.
template <class Y, class J>
struct value_and_jacobian {
  Y value = detail::zero_initialized<Y>();    ///< f(x)
  J jacobian = detail::zero_initialized<J>(); ///< ∂y_i/∂x_j, a row for each component of y

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("value", value);
    f("jacobian", jacobian);
  }
  /// For those who extend duet: rejects `MatrixXd J = jacobian(f, x)`.
  template <class M>
    requires std::derived_from<M, Eigen::MatrixBase<M>>
        DUET_REFUSED("jacobian returns value and Jacobian: const auto [y, J] = jacobian(f, x); or "
                     "jacobian(f, x).jacobian")
  operator M() const;
};

namespace detail {

template <class X>
concept AnyNumber = Scalar<X> || Arithmetic<X>;
/// Two vectors or tuples of them, or two scalars.
template <class X, class V>
concept PointAndDirection = (Variables<X> && Variables<V>) || (AnyNumber<X> && AnyNumber<V>);

/// Returns f(x); writes ∂f_i/∂x_j into `jacobian` after `prepare(rows)` has resized it.
template <class Tag, int Chunk, class Output, class F, class X, class J, class Prepare>
[[nodiscard]] auto write_jacobian(F&& f, const X& x, J& jacobian, const Prepare& prepare) {
  std::decay_t<decltype(parts<Tag>(std::declval<const Output&>(), 0))> value{};
  for_each_pass<Tag, Chunk>(f, x, [&](const Output& y, Eigen::Index first, Eigen::Index count) {
    const Eigen::Index rows = vector_argument<Output>::size(y);
    if (first == 0) {
      prepare(rows);
      value = parts<Tag>(y, 0);
    }
    for (Eigen::Index j = 0; j < count; ++j) {
      for (Eigen::Index i = 0; i < rows; ++i) {
        jacobian(i, first + j) = part<Tag>(component(y, i), int(j) + 1);
      }
    }
  });
  return value;
}

/// Checks the rows and columns of the caller's memory for a result.
template <class Out>
void require_size(const char* driver, const Out& out, Eigen::Index rows, Eigen::Index columns) {
  const auto text = [](Eigen::Index r, Eigen::Index c) {
    return c == 1 ? message(r) : message(r, " x ", c);
  };
  if (out.rows() != rows || out.cols() != columns) {
    raise(invalid_input(message("duet: ", driver, ": the result needs size ", text(rows, columns),
                                ", but has ", text(out.rows(), out.cols()))));
  }
}

} // namespace detail

/// f(x) and the Jacobian, the matrix ∂f_i/∂x_j, m × n. x and f(x) are Eigen vectors, `std::array`s
/// or `std::vector`s; for several arguments x is a tuple, `jacobian(f, std::tuple(a, b))` of f(a,
/// b), with columns for their components one after the other.
///
/// \return `value_and_jacobian`
template <class Tag = void, detail::FunctionOfAny F, Variables X>
  requires(!HasOwnJacobian<F>)
[[nodiscard]] auto jacobian(F&& f, const X& x) {
  using argument = detail::vector_argument<X>;
  using tag = detail::tag_for<Tag, F>;
  using output = std::decay_t<decltype(detail::result_of_call(
      detail::call(f, detail::constants_of_pass<tag, 0>(x))))>;
  static_assert(VectorLike<output>,
                "duet: jacobian needs a function that returns a vector; if it returns a "
                "rotation, pass the frame: jacobian(f, x, frame::body)");
  using value = std::decay_t<decltype(detail::parts<tag>(std::declval<const output&>(), 0))>;
  using S = typename detail::vector_argument<value>::scalar;
  value_and_jacobian<value, Eigen::Matrix<S, detail::vector_argument<output>::size_at_compile_time,
                                          argument::size_at_compile_time>>
      result{};
  detail::require(argument::size(x) > 0, "duet: jacobian: the function has no variables");
  result.value =
      detail::write_jacobian<tag, 0, output>(f, x, result.jacobian, [&](Eigen::Index rows) {
        result.jacobian.resize(rows, argument::size(x));
      });
  return result;
}

/// Returns f(x); writes ∂f_i/∂x_j into `jacobian`, any writable Eigen matrix of as many rows as
/// f(x) has components and as many columns as x. Everything else as `gradient_into`.
///
/// \return f(x)
template <int Chunk = 0, class Tag = void, detail::FunctionOfAny F, Variables X, class J>
[[nodiscard]] auto jacobian_into(F&& f, const X& x, J&& jacobian) {
  static_assert(Chunk >= 0, "duet: jacobian_into<Chunk>: Chunk must not be negative");
  using tag = detail::tag_for<Tag, F>;
  using output = std::decay_t<decltype(detail::result_of_call(
      detail::call(f, detail::constants_of_pass<tag, Chunk>(x))))>;
  static_assert(VectorLike<output>, "duet: jacobian_into needs a function that returns a vector");
  const Eigen::Index size = detail::vector_argument<X>::size(x);
  detail::require(size > 0, "duet: jacobian_into: the function has no variables");
  return detail::write_jacobian<tag, Chunk, output>(f, x, jacobian, [&](Eigen::Index rows) {
    detail::require_size("jacobian_into", jacobian, rows, size);
  });
}

/// f(x) and the directional derivative d/dt f(x + t v) at t = 0: x and v scalars, or vectors of one
/// size, or tuples of them; f(x) of any shape.
///
/// \return `value_and_derivative`
template <class Tag = void, detail::FunctionOfAny F, class X, class V>
  requires detail::PointAndDirection<X, V>
[[nodiscard]] auto directional_derivative(F&& f, const X& x, const V& v) {
  using tag = detail::tag_for<Tag, F>;
  const auto y = [&] {
    if constexpr (Variables<X>) {
      using T = promote_t<typename detail::vector_argument<X>::scalar,
                          typename detail::vector_argument<V>::scalar>;
      return detail::result_of_call(detail::call(
          f, detail::moving<dual<T, 1, tag>>("directional_derivative", x, "direction", v)));
    } else {
      using T = promote_t<detail::differentiable_t<X>, detail::differentiable_t<V>>;
      return detail::result_of_call(f(dual<T, 1, tag>(T(x), T(v))));
    }
  }();
  return value_and_derivative{detail::parts<tag>(y, 0), detail::parts<tag>(y, 1)};
}

/// The Jacobian at a point in braces, `jacobian(f, {1, 2})`.
template <class Tag = void, detail::FunctionOfAny F, std::size_t N>
[[nodiscard]] auto jacobian(F&& f, const double (&x)[N]) {
  return jacobian<Tag>(std::forward<F>(f), std::to_array(x));
}

template <class Tag = void, detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(jacobian)
value_and_jacobian<Eigen::VectorXd, Eigen::MatrixXd> jacobian(F&&, X&&...);
template <int Chunk = 0, class Tag = void, detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(jacobian_into)
Eigen::VectorXd jacobian_into(F&&, X&&...);
template <class Tag = void, detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(directional_derivative)
value_and_derivative<double, double> directional_derivative(F&&, X&&...);

DUET_REFUSES_MATRICES_IN_CHUNKS(jacobian_into, "jacobian", Eigen::VectorXd)
DUET_REFUSES_MATRICES(directional_derivative, "v.reshaped()", value_and_derivative<double, double>)
DUET_REFUSES_ARGUMENTS(jacobian, "derivative(f, x)",
                       value_and_jacobian<Eigen::VectorXd, Eigen::MatrixXd>)

} // namespace duet
