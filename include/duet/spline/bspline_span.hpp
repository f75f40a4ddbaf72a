// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/scalar_traits.hpp>

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

/// \file
/// Cumulative B-spline basis functions of one span, as polynomials (P1, P2).

namespace duet {

/// Cumulative basis functions that are neither 0 nor 1 at some u, and their derivatives: element
/// [d][j] is the d-th derivative of B̃_{first+1+j}, j = 0 … Order−2.
template <class S, int Order, int Derivatives>
using cumulative_weights =
    std::array<std::array<S, std::size_t(Order) - 1>, std::size_t(Derivatives) + 1>;

/// Varying cumulative functions of one span of a B-spline basis, a value of fixed size. Element
/// [j][d] of the polynomials is the d-th derivative of the j-th at the midpoint of the span, about
/// which no term of the Taylor series exceeds the sum by much.
///
/// \tparam S  real number, or a batch with a span in each lane
template <int Order, class S = double>
struct bspline_span {
  static_assert(Order >= 2, "duet: a B-spline basis needs order 2 or more");
  using polynomial = std::array<S, std::size_t(Order)>;
  S middle = S(0);                                                 ///< midpoint of the span
  std::array<polynomial, std::size_t(Order) - 1> polynomials = {}; ///< derivatives at the midpoint

  /// Functions and derivatives at u, over the scalar of u; a built-in number is converted to S.
  /// Like any polynomial they may be evaluated outside the span.
  ///
  /// \return `cumulative_weights`
  template <int Derivatives, class U>
  [[nodiscard]] DUET_ALWAYS_INLINE auto at(const U& u) const {
    using P = std::conditional_t<Arithmetic<U>, S, U>;
    using number = real_type_t<P>;
    const P t = P(u) - middle;
    return [&]<std::size_t... K>(std::index_sequence<K...>) DUET_INLINE_LAMBDA {
      const std::array<P, sizeof...(K)> steps{P(t * (number(1) / number(K + 1)))...};
      cumulative_weights<P, Order, Derivatives> result;
      fill<0>(result, steps);
      return result;
    }
    (std::make_index_sequence<std::size_t(Order) - 1>{});
  }

  /// Functions of the span [u_i, u_{i+1}), from its 2k − 2 knots u_{i+2−k} … u_{i+k−1}: the Cox–de
  /// Boor recurrence (P1) and its derivative (P4),
  ///   (B_i^r)′ = (r−1) [B_i^{r−1}/(u_{i+r−1} − u_i) − B_{i+1}^{r−1}/(u_{i+r} − u_{i+1})],
  /// at the midpoint of the span, where all values are positive. Then P3,
  ///   B̃_i′ = (k−1)/(u_{i+k−1} − u_i) B_i^{k−1}.
  /// The factors (k−1)(k−2)… are applied at the end, as one exact number.
  [[nodiscard]] static bspline_span from_knots(const S* knots) {
    constexpr auto k = std::size_t(Order);
    constexpr std::size_t i = k - 2; // of the beginning of the span
    const S middle = knots[i] + (knots[i + 1] - knots[i]) / 2;
    // b[d][j] is the d-th derivative of B_{i−r+1+j}^r.
    std::array<std::array<S, k>, k> b{};
    b[0][0] = S(1);
    const auto raise = [&](std::size_t r) {
      auto next = decltype(b){};
      for (std::size_t j = 0; j + 1 < r; ++j) { // B_{f+1}^{r−1} contributes to its two neighbours
        const std::size_t f = i + 1 + j - r;
        const S left = knots[f + 1];
        const S right = knots[f + r];
        next[0][j] += b[0][j] * (right - middle) / (right - left);
        next[0][j + 1] += b[0][j] * (middle - left) / (right - left);
        for (std::size_t d = 1; d < r; ++d) {
          const S quotient = b[d - 1][j] / (right - left);
          next[d][j] -= quotient;
          next[d][j + 1] += quotient;
        }
      }
      b = next;
    };
    for (std::size_t r = 2; r < k; ++r) {
      raise(r);
    }
    bspline_span result{middle, {}};
    for (std::size_t j = 0; j + 1 < k; ++j) {
      const std::size_t f = i + 2 + j - k;
      S factor(1);
      for (std::size_t d = 1; d < k; ++d) {
        factor *= S(k - d);
        result.polynomials[j][d] = factor * b[d - 1][j] / (knots[f + k - 1] - knots[f]);
      }
    }
    raise(k);
    S sum(0);
    for (std::size_t j = k - 1; j >= 1; --j) {
      sum += b[0][j];
      result.polynomials[j - 1][0] = sum;
    }
    return result;
  }

private:
  /// Derivatives D, D + 1 … of the result.
  template <std::size_t D, class Weights, class Steps>
  DUET_ALWAYS_INLINE void fill(Weights& result, const Steps& steps) const {
    if constexpr (D < std::tuple_size_v<Weights>) {
      [&]<std::size_t... J>(std::index_sequence<J...>) DUET_INLINE_LAMBDA {
        ((result[D][J] = series<D>(polynomials[J], steps)), ...);
      }
      (std::make_index_sequence<std::size_t(Order) - 1>{});
      fill<D + 1>(result, steps);
    }
  }

  /// c_D + t (c_{D+1} + t/2 (c_{D+2} + t/3 (…))), from the K-th term on. steps: t, t/2, t/3 …
  template <std::size_t D, std::size_t K = D, class Steps>
  [[nodiscard]] DUET_ALWAYS_INLINE static typename Steps::value_type series(const polynomial& c,
                                                                            const Steps& steps) {
    using P = typename Steps::value_type;
    if constexpr (K >= std::size_t(Order)) {
      return P(S(0));
    } else if constexpr (K + 1 == std::size_t(Order)) {
      return P(c[K]);
    } else {
      return series<D, K + 1>(c, steps) * steps[K - D] + c[K];
    }
  }
};

} // namespace duet
