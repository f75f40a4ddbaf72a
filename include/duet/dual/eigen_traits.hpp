// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/eigen/products.hpp>
#include <duet/dual/eigen/solvers.hpp>
#include <duet/dual/eigen/structure.hpp>
#include <duet/dual/math.hpp>

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <limits>
#include <type_traits>

/// \file
/// Dual and Taylor numbers as scalars of Eigen, in mixed expressions with double too.

namespace Eigen {

template <duet::Infinitesimal D>
struct NumTraits<D> : NumTraits<duet::real_type_t<D>> {
  using Real = D;
  using NonInteger = D;
  using Nested = D;
  using Literal = duet::real_type_t<D>;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 4,
    AddCost = 4,
    MulCost = 8,
  };
  static constexpr D epsilon() { return std::numeric_limits<D>::epsilon(); }
  static constexpr D dummy_precision() {
    return NumTraits<duet::real_type_t<D>>::dummy_precision();
  }
  static constexpr D highest() { return std::numeric_limits<D>::max(); }
  static constexpr D lowest() { return std::numeric_limits<D>::lowest(); }
  static constexpr D infinity() { return std::numeric_limits<D>::infinity(); }
  static constexpr D quiet_NaN() { return std::numeric_limits<D>::quiet_NaN(); }
};

/// A matrix of duals meets a matrix of doubles, or of duals below or beside it.
template <class A, class B, class Operation>
  requires(!std::same_as<A, B> && duet::detail::MixedScalars<A, B>)
struct ScalarBinaryOpTraits<A, B, Operation> {
  using ReturnType = duet::promote_t<A, B>;
};

} // namespace Eigen

namespace duet {

/// A column of scalars, each brought to the common type: `column(x, 2, sin(x))`.
template <class... S>
[[nodiscard]] auto column(const S&... s) {
  using common = std::common_type_t<S...>;
  return Eigen::Matrix<common, int(sizeof...(S)), 1>(
      std::array<common, sizeof...(S)>{static_cast<common>(s)...}.data());
}

} // namespace duet
