// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/spline/knots.hpp>
#include <duet/spline/location.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// B-spline bases of any order over any knots (P1), in the cumulative form for curves over
/// rotations (P2).

namespace duet {

/// Cumulative basis functions that are neither 0 nor 1 at some u, and their derivatives: element
/// [d][j] is the d-th derivative of B̃_{first+1+j}, j = 0 … Order−2.
template <class S, int Order, int Derivatives>
using cumulative_weights =
    std::array<std::array<S, std::size_t(Order) - 1>, std::size_t(Derivatives) + 1>;

/// B-spline basis of order k (degree k − 1) over non-decreasing knots u_0 … u_{m+k−1}: m functions,
/// C^{k−2} at simple knots, on the domain [u_{k−1}, u_m].
///
/// B̃_i = Σ_{j≥i} B_j (P2). On every span the k − 1 varying ones are stored as polynomials, so that
/// non-uniform knots cost no more than uniform ones.
template <int Order, Real R = double>
class bspline_basis : public knot_spans<R> {
  static_assert(Order >= 2, "duet: a B-spline basis needs order 2 or more");

public:
  static constexpr int order = Order;

  /// \throws invalid_input for knots that decrease, are not finite, leave no domain, or are
  /// repeated more than k times
  bspline_basis(std::vector<R> knots)
      : knot_spans<R>(distinct_in_domain(knots)), knots_(std::move(knots)) {
    spans_.reserve(this->breaks().size() - 1);
    for (std::size_t i = std::size_t(Order) - 1; i + std::size_t(Order) < knots_.size(); ++i) {
      if (knots_[i] < knots_[i + 1]) {
        spans_.push_back(make_span(i));
      }
    }
  }

  /// Knots, repeated knots included.
  [[nodiscard]] const std::vector<R>& knots() const { return knots_; }
  /// Number of basis functions, equal to the number of control points.
  [[nodiscard]] std::size_t size() const { return knots_.size() - std::size_t(Order); }
  /// Index of the first of the k functions that do not vanish on a span.
  [[nodiscard]] std::size_t first_function(std::size_t span) const { return spans_[span].first; }

  /// Varying cumulative functions of a span at u, with derivatives, over the scalar of u; a
  /// built-in number is converted to R. Like any polynomial they may be evaluated outside the span.
  template <int Derivatives, class S>
  [[nodiscard]] DUET_ALWAYS_INLINE auto weights(std::size_t span, const S& u) const {
    using P = std::conditional_t<Arithmetic<S>, R, S>;
    return weights_of<Derivatives>(spans_[span], P(u));
  }
  /// Weights and their derivatives at a batch of parameters, each lane on a separate span.
  template <int Derivatives, std::size_t W, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE auto weights(const std::array<std::size_t, W>& spans,
                                                const P& u) const {
    const auto join = [&](const auto& get) DUET_INLINE_LAMBDA {
      return from_lanes<W>([&](std::size_t k) DUET_INLINE_LAMBDA { return get(spans_[spans[k]]); });
    };
    span_data<real_type_t<P>> data{
        0, join([](const auto& s) DUET_INLINE_LAMBDA { return s.middle; }), {}};
    for (std::size_t j = 0; j + 1 < std::size_t(Order); ++j) {
      for (std::size_t d = 0; d < std::size_t(Order); ++d) {
        data.polynomials[j][d] =
            join([=](const auto& s) DUET_INLINE_LAMBDA { return s.polynomials[j][d]; });
      }
    }
    return weights_of<Derivatives>(data, u);
  }

  /// Increments B̃_j(to) − B̃_j(from) of the varying functions of a span. Relative to the largest
  /// increment they are as accurate as `to − from`, even for adjacent parameters.
  [[nodiscard]] std::array<R, std::size_t(Order) - 1> changes(std::size_t span, const R& from,
                                                              const R& to) const {
    const R a = from - spans_[span].middle;
    const R b = to - spans_[span].middle;
    std::array<R, std::size_t(Order) - 1> result{};
    R power(1), quotient(1); // a^{d−1}, (b^d − a^d)/(b − a)
    R factor = b - a;
    for (std::size_t d = 1; d < std::size_t(Order); ++d) {
      factor /= R(d);
      for (std::size_t j = 0; j + 1 < std::size_t(Order); ++j) {
        result[j] += spans_[span].polynomials[j][d] * (quotient * factor);
      }
      power *= a;
      quotient = quotient * b + power;
    }
    return result;
  }

private:
  [[nodiscard]] static std::vector<R> distinct_in_domain(const std::vector<R>& knots) {
    detail::check_knots(knots, Order);
    std::vector<R> result;
    for (std::size_t i = std::size_t(Order) - 1; i + std::size_t(Order) <= knots.size(); ++i) {
      if (result.empty() || result.back() < knots[i]) {
        result.push_back(knots[i]);
      }
    }
    return result;
  }

  /// Derivatives 0 … k−1 at the midpoint of the span, about which no term of the Taylor series
  /// exceeds the sum by much.
  template <class S>
  using polynomial = std::array<S, std::size_t(Order)>;
  template <class S>
  struct span_data {
    std::size_t first;
    S middle;
    std::array<polynomial<S>, std::size_t(Order) - 1> polynomials;
  };

  template <int Derivatives, class S, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE static auto weights_of(const span_data<S>& data, const P& u) {
    using number = real_type_t<P>;
    const P t = u - data.middle;
    return [&]<std::size_t... K>(std::index_sequence<K...>) DUET_INLINE_LAMBDA {
      const std::array<P, sizeof...(K)> steps{P(t * (number(1) / number(K + 1)))...};
      cumulative_weights<P, Order, Derivatives> result;
      fill<0>(result, data, steps);
      return result;
    }
    (std::make_index_sequence<std::size_t(Order) - 1>{});
  }

  /// Derivatives D, D + 1 … of the result.
  template <std::size_t D, class Weights, class S, class Steps>
  DUET_ALWAYS_INLINE static void fill(Weights& result, const span_data<S>& data,
                                      const Steps& steps) {
    if constexpr (D < std::tuple_size_v<Weights>) {
      [&]<std::size_t... J>(std::index_sequence<J...>) DUET_INLINE_LAMBDA {
        ((result[D][J] = series<D>(data.polynomials[J], steps)), ...);
      }
      (std::make_index_sequence<std::size_t(Order) - 1>{});
      fill<D + 1>(result, data, steps);
    }
  }

  /// c_D + t (c_{D+1} + t/2 (c_{D+2} + t/3 (…))), from the K-th term on. steps: t, t/2, t/3 …
  template <std::size_t D, std::size_t K = D, class C, class Steps>
  [[nodiscard]] DUET_ALWAYS_INLINE static typename Steps::value_type series(const polynomial<C>& c,
                                                                            const Steps& steps) {
    using S = typename Steps::value_type;
    if constexpr (K >= std::size_t(Order)) {
      return S(C(0));
    } else if constexpr (K + 1 == std::size_t(Order)) {
      return S(c[K]);
    } else {
      return series<D, K + 1>(c, steps) * steps[K - D] + c[K];
    }
  }

  /// Cumulative functions on the span [u_i, u_{i+1}): the Cox–de Boor recurrence (P1) and its
  /// derivative (P4),
  ///   (B_i^r)′ = (r−1) [B_i^{r−1}/(u_{i+r−1} − u_i) − B_{i+1}^{r−1}/(u_{i+r} − u_{i+1})],
  /// at the midpoint of the span, where all values are positive. Then P3,
  ///   B̃_i′ = (k−1)/(u_{i+k−1} − u_i) B_i^{k−1}.
  /// The factors (k−1)(k−2)… are applied at the end, as one exact number.
  [[nodiscard]] span_data<R> make_span(std::size_t i) const {
    constexpr auto k = std::size_t(Order);
    const R middle = knots_[i] + (knots_[i + 1] - knots_[i]) / 2;
    // b[d][j] is the d-th derivative of B_{i−r+1+j}^r.
    std::array<std::array<R, k>, k> b{};
    b[0][0] = R(1);
    const auto raise = [&](std::size_t r) {
      auto next = decltype(b){};
      for (std::size_t j = 0; j + 1 < r; ++j) { // B_{f+1}^{r−1} contributes to its two neighbours
        const std::size_t f = i + 1 + j - r;
        const R left = knots_[f + 1];
        const R right = knots_[f + r];
        next[0][j] += b[0][j] * (right - middle) / (right - left);
        next[0][j + 1] += b[0][j] * (middle - left) / (right - left);
        for (std::size_t d = 1; d < r; ++d) {
          const R quotient = b[d - 1][j] / (right - left);
          next[d][j] -= quotient;
          next[d][j + 1] += quotient;
        }
      }
      b = next;
    };
    for (std::size_t r = 2; r < k; ++r) {
      raise(r);
    }
    span_data<R> result{i + 1 - k, middle, {}};
    R highest(0);
    for (std::size_t j = 0; j + 1 < k; ++j) {
      const std::size_t f = i + 2 + j - k;
      R factor(1);
      for (std::size_t d = 1; d < k; ++d) {
        factor *= R(k - d);
        result.polynomials[j][d] = factor * b[d - 1][j] / (knots_[f + k - 1] - knots_[f]);
      }
      highest += result.polynomials[j][k - 1];
    }
    detail::require(highest - highest == 0, "duet: knots: knot ", i, " = ", knots_[i], " and knot ",
                    i + 1, " = ", knots_[i + 1], " are too close: a derivative overflows");
    raise(k);
    R sum(0);
    for (std::size_t j = k - 1; j >= 1; --j) {
      sum += b[0][j];
      result.polynomials[j - 1][0] = sum;
    }
    return result;
  }

  std::vector<R> knots_;
  std::vector<span_data<R>> spans_;
};

} // namespace duet
