// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/zero_initialized.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/derivative/function.hpp>
#include <duet/derivative/gradient.hpp>
#include <duet/derivative/seed.hpp>
#include <duet/dual/parts.hpp>

#include <Eigen/Core>

#include <type_traits>

/// \file
/// Parts of a Hessian that cost less than all of it: its product with a vector, and the block of
/// two groups of variables.

namespace duet {

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
