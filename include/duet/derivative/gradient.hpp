// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/jacobian.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual/level.hpp>
#include <duet/dual/second_dual.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

/// \file
/// Gradients and Hessians of scalar functions of a vector; gradients with respect to thousands of
/// components in passes of a chosen size, into memory of the caller. Parts of a Hessian that cost
/// less than all of it: its product with a vector, and the block of two groups of variables.

namespace duet {

/// Result of `gradient`: f(x), and ∇f as a column.
template <class Y, class G>
struct value_and_gradient {
  Y value = detail::zero_initialized<Y>();    ///< f(x)
  G gradient = detail::zero_initialized<G>(); ///< ∇f, a column

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("value", value);
    f("gradient", gradient);
  }
  /// For those who extend duet: rejects `VectorXd g = gradient(f, x)`.
  template <class M>
    requires std::derived_from<M, Eigen::MatrixBase<M>>
        DUET_REFUSED("gradient returns value and gradient: const auto [y, g] = gradient(f, x); or "
                     "gradient(f, x).gradient")
  operator M() const;
};

/// Result of `hessian`: f(x), ∇f as a column, and the symmetric matrix of second derivatives.
template <class Y, class G, class H>
struct value_gradient_and_hessian {
  Y value = detail::zero_initialized<Y>();    ///< f(x)
  G gradient = detail::zero_initialized<G>(); ///< ∇f, a column
  H hessian = detail::zero_initialized<H>();  ///< ∂²f/∂x_i∂x_j, a symmetric matrix

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("value", value);
    f("gradient", gradient);
    f("hessian", hessian);
  }
  /// For those who extend duet: rejects `MatrixXd H = hessian(f, x)`.
  template <class M>
    requires std::derived_from<M, Eigen::MatrixBase<M>> DUET_REFUSED(
        "hessian returns value, gradient and Hessian: const auto [y, g, H] = hessian(f, x); or "
        "hessian(f, x).hessian")
  operator M() const;
};

/// Returns f(x); writes ∇f into `gradient`, any writable Eigen vector of as many components as x.
///
/// One vector of seeds is allocated per call if the size of x is known only at run time, otherwise
/// nothing; f takes it by reference.
///
/// \tparam Chunk  components differentiated per evaluation of f; 0 (the default) selects the
///   measured optimum, see docs/reference/benchmarks.md. More partials per pass evaluate f less
///   often, but every number of f holds them all.
/// \return f(x)
/// \throws invalid_input if the sizes do not match or x is empty
///
/// Example: `Eigen::VectorXd g(n); const double y = gradient_into<16>(f, x, g);`
template <int Chunk = 0, class Tag = void, detail::FunctionOfAny F, Variables X, class G>
[[nodiscard]] auto gradient_into(F&& f, const X& x, G&& gradient) {
  static_assert(Chunk >= 0, "duet: gradient_into<Chunk>: Chunk must not be negative");
  using tag = detail::tag_for<Tag, F>;
  using output = std::decay_t<decltype(detail::result_of_call(
      detail::call(f, detail::constants_of_pass<tag, Chunk>(x))))>;
  static_assert(Scalar<output>, "duet: gradient_into needs a function that returns a scalar");
  const Eigen::Index size = detail::vector_argument<X>::size(x);
  detail::require(size > 0, "duet: gradient_into: the function has no variables");
  detail::require_size("gradient_into", gradient, size, 1);
  decltype(detail::part<tag>(std::declval<const output&>(), 0)) value(0);
  detail::for_each_pass<tag, Chunk>(f, x,
                                    [&](const auto& y, Eigen::Index first, Eigen::Index count) {
                                      value = detail::part<tag>(y, 0);
                                      for (Eigen::Index i = 0; i < count; ++i) {
                                        gradient[first + i] = detail::part<tag>(y, int(i) + 1);
                                      }
                                    });
  return value;
}

/// f(x) and the gradient ∇f(x). x is an Eigen vector, a `std::array` or `std::vector` of n
/// components, f(x) a scalar; the gradient is a column of n. For several arguments, scalars and
/// vectors, x is a tuple, `gradient(f, std::tuple(a, b))` of f(a, b), and the gradient lists the
/// derivatives with respect to their components one after the other.
///
/// Up to 32 components known at compile time take one evaluation of f.
///
/// \return `value_and_gradient`
template <class Tag = void, detail::FunctionOfAny F, Variables X>
[[nodiscard]] auto gradient(F&& f, const X& x) {
  using argument = detail::vector_argument<X>;
  using tag = detail::tag_for<Tag, F>;
  using output = std::decay_t<decltype(detail::result_of_call(
      detail::call(f, detail::constants_of_pass<tag, 0>(x))))>;
  static_assert(
      Scalar<output>,
      "duet: gradient needs a function that returns a scalar, f(x) of a vector; for several "
      "arguments use gradient(f, std::tuple(x, y))");
  using S = decltype(detail::part<tag>(std::declval<const output&>(), 0));
  using vector = Eigen::Matrix<S, argument::size_at_compile_time, 1>;
  value_and_gradient<S, vector> result{S(0), vector(argument::size(x))};
  detail::require(argument::size(x) > 0, "duet: gradient: the function has no variables");
  result.value = gradient_into<0, std::conditional_t<std::is_void_v<Tag>, std::decay_t<F>, Tag>>(
      f, x, result.gradient);
  return result;
}

namespace detail {

/// Components per block of a Hessian that takes more than one pass.
inline constexpr int hessian_block = 8;

/// Value, gradient and Hessian by blocks of components: diagonal blocks by numbers with second
/// derivatives, off-diagonal blocks by f(x + ε + η), ε of one block and η of another.
template <class Tag, class F, class X, class Result>
void hessian_in_blocks(F&& f, const X& x, Result& result) {
  using argument = vector_argument<X>;
  using T = typename argument::scalar;
  constexpr int n = hessian_block;
  const Eigen::Index size = argument::size(x);
  const auto for_block = [&](Eigen::Index first, auto&& visit) {
    for (int i = 0; i < std::min<Eigen::Index>(n, size - first); ++i) {
      visit(first + i, i);
    }
  };
  // Resets the variables of a block after its pass; all others are constants already.
  const auto set_constants = [&](auto& variables, Eigen::Index block) {
    for_block(block, [&](Eigen::Index at, int) {
      auto& variable = component(variables, at);
      variable = std::decay_t<decltype(variable)>(argument::get(x, at));
    });
  };
  {
    using D = second_order_dual<T, n, Tag>;
    auto variables = constants<D>(x);
    for (Eigen::Index block = 0; block < size; block += n) {
      for_block(block, [&](Eigen::Index at, int i) {
        component(variables, at) = D::variable(argument::get(x, at), i);
      });
      const auto y = result_of_call(call(f, variables));
      result.value = part<Tag>(y, 0);
      for_block(block, [&](Eigen::Index row, int i) {
        result.gradient[row] = part<Tag>(y, 1 + i);
        for_block(block, [&](Eigen::Index column, int j) {
          result.hessian(row, column) = part<Tag>(y, 1 + n + n * i + j);
        });
      });
      set_constants(variables, block);
    }
  }
  using column_tag = derivative_tag<Tag, struct columns_of_hessian>;
  using E = dual<T, n, column_tag>;
  using D = dual<E, n, Tag>;
  auto variables = constants<D>(x);
  for (Eigen::Index row_block = n; row_block < size; row_block += n) {
    for_block(row_block, [&](Eigen::Index at, int i) {
      component(variables, at) = D::variable(E(argument::get(x, at)), i);
    });
    for (Eigen::Index column_block = 0; column_block < row_block; column_block += n) {
      for_block(column_block, [&](Eigen::Index at, int j) {
        component(variables, at) = D(E::variable(argument::get(x, at), j));
      });
      const auto y = result_of_call(call(f, variables));
      for_block(row_block, [&](Eigen::Index row, int i) {
        const auto slope = part<Tag>(y, 1 + i);
        for_block(column_block, [&](Eigen::Index column, int j) {
          result.hessian(row, column) = result.hessian(column, row) =
              part<column_tag>(slope, 1 + j);
        });
      });
      set_constants(variables, column_block);
    }
    set_constants(variables, row_block);
  }
}

} // namespace detail

/// f(x), the gradient ∇f(x) and the symmetric Hessian. Arguments as `gradient`.
///
/// Up to 32 components known at compile time take one evaluation of f. Otherwise f is evaluated for
/// every pair of blocks of eight components, p (p + 1) / 2 times for p blocks, and beyond 32 the
/// matrix has a size known at run time. If most entries are known to be zero use `sparse_hessian`.
///
/// \return `value_gradient_and_hessian`
template <class Tag = void, detail::FunctionOfAny F, Variables X>
[[nodiscard]] auto hessian(F&& f, const X& x) {
  using argument = detail::vector_argument<X>;
  using T = typename argument::scalar;
  using tag = detail::tag_for<Tag, F>;
  constexpr int n = argument::size_at_compile_time;
  constexpr bool is_single_pass = 0 < n && n <= detail::single_pass_limit;
  using number = second_order_dual<T, is_single_pass ? n : detail::hessian_block, tag>;
  using output =
      std::decay_t<decltype(detail::result_of_call(detail::call(f, detail::constants<number>(x))))>;
  static_assert(Scalar<output>, "duet: hessian needs a function that returns a scalar");
  using S = decltype(detail::part<tag>(std::declval<const output&>(), 0));
  constexpr int rows = is_single_pass ? n : Eigen::Dynamic;
  const Eigen::Index size = argument::size(x);
  detail::require(size > 0, "duet: hessian: the function has no variables");
  value_gradient_and_hessian<S, Eigen::Matrix<S, n, 1>, Eigen::Matrix<S, rows, rows>> result{
      S(0), Eigen::Matrix<S, n, 1>(size), Eigen::Matrix<S, rows, rows>(size, size)};
  if constexpr (is_single_pass) {
    const auto y = detail::result_of_call(detail::call(f, detail::seeded<number>(x)));
    result.value = detail::part<tag>(y, 0);
    for (int i = 0; i < n; ++i) {
      result.gradient[i] = detail::part<tag>(y, 1 + i);
      for (int j = 0; j < n; ++j) {
        result.hessian(i, j) = detail::part<tag>(y, 1 + n + n * i + j);
      }
    }
  } else {
    detail::hessian_in_blocks<tag>(f, x, result);
  }
  return result;
}

/// The gradient at a point in braces, `gradient(f, {1, 2})`.
template <class Tag = void, detail::FunctionOfAny F, std::size_t N>
[[nodiscard]] auto gradient(F&& f, const double (&x)[N]) {
  return gradient<Tag>(std::forward<F>(f), std::to_array(x));
}

/// The Hessian at a point in braces, `hessian(f, {1, 2})`.
template <class Tag = void, detail::FunctionOfAny F, std::size_t N>
[[nodiscard]] auto hessian(F&& f, const double (&x)[N]) {
  return hessian<Tag>(std::forward<F>(f), std::to_array(x));
}

template <int Chunk = 0, class Tag = void, detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(gradient_into)
double gradient_into(F&&, X&&...);
template <class Tag = void, detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(gradient)
value_and_gradient<double, Eigen::VectorXd> gradient(F&&, X&&...);
template <class Tag = void, detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(hessian)
value_gradient_and_hessian<double, Eigen::VectorXd, Eigen::MatrixXd> hessian(F&&, X&&...);

DUET_REFUSES_MATRICES_IN_CHUNKS(gradient_into, "gradient", double)
DUET_REFUSES_ARGUMENTS(gradient, "derivative(f, x)", value_and_gradient<double, Eigen::VectorXd>)
DUET_REFUSES_ARGUMENTS(hessian, "derivatives<2>(f, x)",
                       value_gradient_and_hessian<double, Eigen::VectorXd, Eigen::MatrixXd>)

/// f(x), ∇f, and the product of the Hessian with a vector.
template <class Y, class G>
struct value_gradient_and_product {
  Y value = detail::zero_initialized<Y>();    ///< f(x)
  G gradient = detail::zero_initialized<G>(); ///< ∇f, a column
  G product = detail::zero_initialized<G>();  ///< H v, a column

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("value", value);
    f("gradient", gradient);
    f("product", product);
  }
};

/// f(x), ∇f and H v, the Hessian at x times a vector: the derivative of the gradient along v, at
/// about twice the cost of the gradient, for any number of components.
///
/// \param x, v  as for `gradient`, of one size; f returns a scalar
/// \return `value_gradient_and_product`
/// \throws invalid_input if the sizes differ or x is empty
template <class Tag = void, detail::FunctionOfAny F, Variables X, Variables V>
[[nodiscard]] auto hessian_vector_product(F&& f, const X& x, const V& v) {
  using T = promote_t<typename detail::vector_argument<X>::scalar,
                      typename detail::vector_argument<V>::scalar>;
  using tag = detail::tag_for<Tag, F>;
  using along = derivative_tag<tag, struct direction_of_gradient>;
  const auto moving = detail::moving<dual<T, 1, along>>("hessian_vector_product", x, "vector", v);
  const auto [y, g] =
      gradient<std::conditional_t<std::is_void_v<Tag>, std::decay_t<F>, Tag>>(f, moving);
  const auto value = detail::part<along>(y, 0);
  const auto slope = detail::parts<along>(g, 0);
  return value_gradient_and_product<std::remove_const_t<decltype(value)>,
                                    std::remove_const_t<decltype(slope)>>{
      value, slope, detail::parts<along>(g, 1)};
}

/// f(x, y), and the block ∂²f/∂xᵢ∂yⱼ of its Hessian.
template <class Y, class M>
struct value_and_mixed_hessian {
  Y value = detail::zero_initialized<Y>(); ///< f(x, y)
  M mixed = detail::zero_initialized<M>(); ///< ∂²f/∂xᵢ∂yⱼ, a row for each component of x

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("value", value);
    f("mixed", mixed);
  }
};

/// f(x, y) and the matrix ∂²f/∂xᵢ∂yⱼ, n × m, of two groups of up to 32 variables each: terms that
/// depend on one group only are computed with the derivatives of that group alone.
///
/// \param x, y  Eigen vectors or `std::array`s of sizes known at compile time; f(x, y), over
///   different scalars for x and y, returns a scalar
/// \return `value_and_mixed_hessian`
template <class Tag = void, detail::FunctionOfAny F, VectorLike X, VectorLike Y>
[[nodiscard]] auto mixed_hessian(F&& f, const X& x, const Y& y) {
  constexpr int n = detail::vector_argument<X>::size_at_compile_time;
  constexpr int m = detail::vector_argument<Y>::size_at_compile_time;
  static_assert(
      n > 0 && m > 0 && n <= detail::single_pass_limit && m <= detail::single_pass_limit,
      "duet: mixed_hessian needs vectors of at most 32 components, known at compile time");
  using tag = detail::tag_for<Tag, F>;
  using first = derivative_tag<tag, struct first_group>;
  using second = derivative_tag<tag, struct second_group>;
  using A = dual<typename detail::vector_argument<X>::scalar, n, first>;
  using B = dual<typename detail::vector_argument<Y>::scalar, m, second>;
  const auto z = detail::result_of_call(f(detail::seeded<A>(x), detail::seeded<B>(y)));
  static_assert(Scalar<std::remove_const_t<decltype(z)>>,
                "duet: mixed_hessian needs a function that returns a scalar");
  const auto by_first = detail::part<first>(z, 0);
  using S = decltype(detail::part<second>(by_first, 0));
  value_and_mixed_hessian<S, Eigen::Matrix<S, n, m>> result;
  result.value = detail::part<second>(by_first, 0);
  for (int i = 0; i < n; ++i) {
    const auto row = detail::part<first>(z, i + 1);
    for (int j = 0; j < m; ++j) {
      result.mixed(i, j) = detail::part<second>(row, j + 1);
    }
  }
  return result;
}

template <class Tag = void, detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(hessian_vector_product)
value_gradient_and_product<double, Eigen::VectorXd> hessian_vector_product(F&&, X&&...);
template <class Tag = void, detail::FunctionOfReals F, class... X>
DUET_REFUSED_FUNCTION(mixed_hessian)
value_and_mixed_hessian<double, Eigen::MatrixXd> mixed_hessian(F&&, X&&...);

DUET_REFUSES_MATRICES(hessian_vector_product, "v.reshaped()",
                      value_gradient_and_product<double, Eigen::VectorXd>)

} // namespace duet
