// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/errors.hpp>
#include <duet/derivative/matrix_parts.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

/// \file
/// Exponential of a matrix, with exact derivatives at every matrix.

namespace duet {
namespace detail {

/// ‖A‖₁, the largest sum of the moduli of a column.
template <class A>
[[nodiscard]] auto norm_1(const A& a) {
  return a.cwiseAbs().colwise().sum().maxCoeff();
}

/// Number of halvings of A until its powers decrease as those of 1/2 do.
///
/// α = max(‖A^p‖^{1/p}, ‖A^{p+1}‖^{1/(p+1)}) bounds ‖A^k‖^{1/k} for k ≥ p(p − 1); for a matrix far
/// from normal it is much less than ‖A‖, and more halvings would cause cancellation.
template <class A>
[[nodiscard]] int halvings(const A& a) {
  using std::frexp;
  using std::ldexp;
  using std::pow;
  auto norm = norm_1(a);
  using R = decltype(norm);
  int exponent = 0;
  static_cast<void>(frexp(norm, &exponent));
  exponent = std::max(exponent, 0); // so that no power overflows
  const A scaled = a * ldexp(R(1), -exponent);
  A power = scaled;
  norm = norm_1(scaled);
  R smallest = norm;
  for (int p = 2; p <= 5; ++p) {
    power = power.lazyProduct(scaled).eval();
    const R next = pow(norm_1(power), 1 / R(p));
    smallest = std::min(smallest, std::max(norm, next));
    norm = next;
  }
  int more = 0;
  static_cast<void>(frexp(smallest, &more));
  return smallest > 0 ? std::max(0, exponent + more + 1) : 0;
}

/// Number of terms that make the series of exp at 1/2, and its derivatives up to `order`, exact to
/// R.
template <class R>
[[nodiscard]] int terms_of_exponential(int order) {
  int count = 0;
  for (R term = 1; term > std::numeric_limits<R>::epsilon() / 8; term = term / (2 * ++count)) {
  }
  return count + order;
}

template <class S, class A>
[[nodiscard]] auto exponential(const A& a) {
  using std::ldexp;
  const auto values = real_values<real_type_t<S>>(a);
  require_finite("matrix_exponential", values);
  const int count = halvings(values);
  using R = decltype(norm_1(values));
  require(count < std::numeric_limits<R>::digits, "duet: matrix_exponential: entries of A up to ",
          values.cwiseAbs().maxCoeff(), " leave no digit of exp(A)");
  constexpr int size = A::RowsAtCompileTime;
  using matrix = Eigen::Matrix<S, size, size>;
  const matrix part = a.unaryExpr([&](const auto& x) { return S(x * ldexp(R(1), -count)); });
  matrix result = matrix::Identity(a.rows(), a.rows());
  for (int k = terms_of_exponential<R>(scalar_traits<S>::order); k > 0; --k) {
    result = part.lazyProduct(result).eval() / R(k);
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      result(i, i) += R(1);
    }
  }
  for (int k = 0; k < count; ++k) {
    result = result.lazyProduct(result).eval();
  }
  for (const S& entry : result.reshaped()) {
    require(is_all_finite(innermost(entry)), "duet: matrix_exponential: exp(A) overflows");
  }
  return result;
}

} // namespace detail

/// Exponential of a square matrix, exp A = 1 + A + A²/2! + ….
///
/// \param a  A, n × n, of any scalars, complex ones and batches among them
///
/// Scaling and squaring: exp A = (exp(A/2^s))^(2^s), s chosen for the values of A by the norms of
/// its powers (A. H. Al-Mohy, N. J. Higham, SIAM J. Matrix Anal. Appl. 31 (2009) 970–989), and the
/// series of A/2^s in the algebra of the infinitesimals, without divisions: so every derivative is
/// exact at every A, also at 0 and at equal eigenvalues,
///
///   d exp A = ∫₀¹ exp(τA) dA exp((1 − τ)A) dτ.
///
/// The relative error for a matrix no further from normal than its powers show is about
/// 2nε(1 + ‖A‖).
///
/// \return an n × n matrix
/// \throws invalid_input if A is not square, empty or not finite, if its norm leaves no digit (2^s
///   ≥ 1/ε), or if exp A overflows
template <class A>
[[nodiscard]] auto matrix_exponential(const Eigen::MatrixBase<A>& a) {
  using S = detail::common_scalar_t<A, A>;
  detail::require_square("matrix_exponential", a);
  constexpr int n =
      A::RowsAtCompileTime == Eigen::Dynamic ? A::ColsAtCompileTime : A::RowsAtCompileTime;
  return detail::by_lane(
      [](const auto& m) {
        return detail::exponential<typename std::decay_t<decltype(m)>::Scalar>(m);
      },
      Eigen::Matrix<S, n, n>(a.template cast<S>()));
}

} // namespace duet
