// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/spline/knots.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <sstream>
#include <utility>
#include <vector>

/// \file
/// B-spline bases of any order over any knots (P1), in the cumulative form that curves over
/// rotations need (P2).

namespace duet {

/// The cumulative basis functions that are neither 0 nor 1 at some u, and their derivatives.
///
/// `derivative[d][j]` is the d-th derivative of B̃_{first+1+j}, j = 0 … Order−2.
template <class S, int Order, int Derivatives>
struct cumulative_weights {
  std::array<std::array<S, std::size_t(Order) - 1>, std::size_t(Derivatives) + 1> derivative;
};

/// The B-spline basis of order k (degree k − 1) over non-decreasing knots u_0 … u_{m+k−1}: m
/// functions, C^{k−2} at simple knots, on the domain [u_{k−1}, u_m].
///
/// B̃_i = Σ_{j≥i} B_j (P2). On every span the k − 1 of them that vary are stored as polynomials of
/// the local parameter, so that non-uniform knots cost no more than uniform ones.
template <int Order, real R = double>
class bspline_basis {
  static_assert(Order >= 2, "duet: a B-spline basis needs order 2 or more");

public:
  static constexpr int order = Order;

  /// \throws invalid_input for knots that decrease, are not finite, leave no domain, or are
  /// repeated more than k times
  explicit bspline_basis(std::vector<R> knots) : knots_(std::move(knots)) {
    detail::check_knots(knots_, Order);
    for (std::size_t i = std::size_t(Order) - 1; i + std::size_t(Order) < knots_.size(); ++i) {
      if (knots_[i] < knots_[i + 1]) {
        breaks_.push_back(knots_[i]);
        spans_.push_back(make_span(i));
      }
    }
    breaks_.push_back(knots_[knots_.size() - std::size_t(Order)]);
    spans_per_unit_ = R(spans_.size()) / (breaks_.back() - breaks_.front());
  }

  [[nodiscard]] const std::vector<R>& knots() const { return knots_; }
  /// Number of basis functions, which is that of the control elements.
  [[nodiscard]] std::size_t size() const { return knots_.size() - std::size_t(Order); }
  [[nodiscard]] const R& front() const { return breaks_.front(); }
  [[nodiscard]] const R& back() const { return breaks_.back(); }
  /// The distinct knots of the domain.
  [[nodiscard]] const std::vector<R>& breaks() const { return breaks_; }

  /// Number of the non-empty span that holds u: half-open, the last one closed.
  /// \throws invalid_input outside the domain
  [[nodiscard]] DUET_ALWAYS_INLINE std::size_t span_of(const R& u) const {
    if (!(u >= breaks_.front() && u <= breaks_.back())) {
      throw_outside(u);
    }
    // Where knots are about uniform the guess is right; otherwise a binary search finds the span.
    const auto guess = std::min(static_cast<std::size_t>((u - breaks_.front()) * spans_per_unit_),
                                spans_.size() - 1);
    if (breaks_[guess] <= u && u < breaks_[guess + 1]) [[likely]] {
      return guess;
    }
    const auto above = std::upper_bound(breaks_.begin(), breaks_.end(), u) - breaks_.begin();
    return std::min(static_cast<std::size_t>(above), spans_.size()) - 1;
  }

  /// Index of the first of the k functions that do not vanish on a span.
  [[nodiscard]] std::size_t first_function(std::size_t span) const { return spans_[span].first; }

  /// The varying cumulative functions of a span at u, with derivatives, over the scalar of u. Like
  /// any polynomial they may be evaluated outside the span.
  template <int Derivatives, class S>
  [[nodiscard]] DUET_ALWAYS_INLINE cumulative_weights<S, Order, Derivatives>
  weights(std::size_t span, const S& u) const {
    const span_data& data = spans_[span];
    const S x = (u - breaks_[span]) * data.inverse_width;
    cumulative_weights<S, Order, Derivatives> result;
    R scale(1);
    for (int d = 0; d <= Derivatives; ++d) {
      for (std::size_t j = 0; j + 1 < std::size_t(Order); ++j) {
        result.derivative[std::size_t(d)][j] = derivative_at(data.polynomials[j], d, x) * scale;
      }
      scale *= data.inverse_width;
    }
    return result;
  }

private:
  using polynomial = std::array<R, std::size_t(Order)>;
  struct span_data {
    std::size_t first;
    R inverse_width;
    std::array<polynomial, std::size_t(Order) - 1> polynomials;
  };

  /// d-th derivative of Σ c_k x^k by Horner's rule.
  template <class S>
  [[nodiscard]] DUET_ALWAYS_INLINE static S derivative_at(const polynomial& c, int d, const S& x) {
    if (d >= Order) {
      return S(R(0));
    }
    const auto coefficient = [&](int k) {
      int falling = 1;
      for (int i = 0; i < d; ++i) {
        falling *= k - i;
      }
      return R(falling * c[std::size_t(k)]);
    };
    S sum(coefficient(Order - 1));
    for (int k = Order - 2; k >= d; --k) {
      sum = sum * x + coefficient(k);
    }
    return sum;
  }

  /// The recurrence P1 carried out on polynomials of x = (u − u_i)/(u_{i+1} − u_i), for the span
  /// [u_i, u_{i+1}).
  [[nodiscard]] span_data make_span(std::size_t i) const {
    const R width = knots_[i + 1] - knots_[i];
    std::array<polynomial, std::size_t(Order)> basis{}; // basis[j] is B_{i-k+1+j}
    basis[std::size_t(Order) - 1][0] = R(1);
    for (int r = 2; r <= Order; ++r) {
      for (int j = Order - r; j < Order; ++j) {
        const std::size_t knot = i + 1 + std::size_t(j) - std::size_t(Order);
        polynomial sum{};
        const auto add = [&](const polynomial& p, const R& constant, const R& slope) {
          for (std::size_t c = 0; c < std::size_t(Order); ++c) {
            sum[c] += p[c] * constant;
            if (c > 0) {
              sum[c] += p[c - 1] * slope;
            }
          }
        };
        const auto ur = std::size_t(r);
        if (const R left = knots_[knot + ur - 1] - knots_[knot]; left > 0) {
          add(basis[std::size_t(j)], (knots_[i] - knots_[knot]) / left, width / left);
        }
        if (j + 1 < Order) {
          const R right = knots_[knot + ur] - knots_[knot + 1];
          if (right > 0) {
            add(basis[std::size_t(j) + 1], (knots_[knot + ur] - knots_[i]) / right, -width / right);
          }
        }
        basis[std::size_t(j)] = sum;
      }
    }
    span_data result{i + 1 - std::size_t(Order), R(1) / width, {}};
    polynomial sum{};
    for (std::size_t j = std::size_t(Order) - 1; j >= 1; --j) {
      for (std::size_t c = 0; c < std::size_t(Order); ++c) {
        sum[c] += basis[j][c];
      }
      result.polynomials[j - 1] = sum;
    }
    return result;
  }

  [[noreturn]] void throw_outside(const R& u) const {
    std::ostringstream message;
    message << "duet: spline evaluated at " << u << ", outside its domain [" << breaks_.front()
            << ", " << breaks_.back() << "]";
    throw invalid_input(message.str());
  }

  std::vector<R> knots_;
  std::vector<R> breaks_;
  std::vector<span_data> spans_;
  R spans_per_unit_;
};

} // namespace duet
