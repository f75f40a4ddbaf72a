// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/batch.hpp>
#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/core/text/number_text.hpp>
#include <duet/spline/bspline_span.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// \file
/// B-spline bases of any order over any knots (P1), in the cumulative form for curves over
/// rotations (P2); knot vectors, spans of a curve's domain, and its behaviour outside the domain.

namespace duet {

namespace detail {

/// \throws invalid_input unless the knots are finite, do not decrease, leave a domain for splines
/// of this order and repeat no knot more often than `order` times
template <Real R>
void check_knots(const std::vector<R>& knots, int order) {
  const auto fail = [](const auto&... what) {
    raise(invalid_input(message("duet: knots: ", what...)));
  };
  const auto k = std::size_t(order);
  if (knots.size() < 2 * k) {
    fail("order ", order, " needs at least ", 2 * k, " knots, got ", knots.size(),
         " (clamped_knots(parameters, ", order, ") makes enough)");
  }
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!(knots[i] - knots[i] == 0)) {
      fail("knot ", i, " is ", knots[i], " (expected a finite number)");
    }
    if (i > 0 && knots[i] < knots[i - 1]) {
      fail("knot ", i, " = ", knots[i], " is less than knot ", i - 1, " = ", knots[i - 1]);
    }
    if (i >= k && knots[i] == knots[i - k]) {
      fail("knot ", i, " = ", knots[i], " is repeated more than ", order, " times");
    }
  }
  if (!(knots[k - 1] < knots[knots.size() - k])) {
    fail("the domain from ", knots[k - 1], " to ", knots[knots.size() - k], " is empty");
  }
  if (const R width = knots.back() - knots.front(); !(width - width == 0)) {
    fail("the distance from ", knots.front(), " to ", knots.back(), " overflows");
  }
}

} // namespace detail

/// Clamped knot vector of a spline of this order through data points at the given parameters: each
/// parameter once, the first and the last `order` times, so that the curve ends at its first and
/// last control points.
template <Real R>
[[nodiscard]] std::vector<R> clamped_knots(const std::vector<R>& parameters, int order) {
  const std::size_t more = std::size_t(order) - 1, last = parameters.size() - 1;
  std::vector<R> knots(last + 1 + 2 * more);
  for (std::size_t i = 0; i < knots.size(); ++i) {
    knots[i] = parameters[std::min(i - std::min(i, more), last)];
  }
  return knots;
}

/// Knot vector for `fit` of a spline of this order to samples at the given parameters: a knot at
/// every n-th sample, so that knots are dense where samples are, and at the first and the last,
/// repeated as by `clamped_knots`. The last inner knot is n to 2 n − 1 samples before the end.
///
/// \param n  number of samples per knot: larger numbers smooth more, smaller ones follow faster
///           motion
/// \throws invalid_input for n = 0 and fewer than two samples
template <Real R>
[[nodiscard]] std::vector<R> knots_every(const std::vector<R>& parameters, std::size_t n,
                                         int order = 4) {
  detail::require(n > 0 && parameters.size() > 1, "duet: knots_every: n is ", n, " with ",
                  parameters.size(), " parameters (expected n > 0 and two parameters or more)");
  std::vector<R> breaks{parameters.front()};
  for (std::size_t i = n; i < parameters.size() - 1 && n <= parameters.size() - 1 - i; i += n) {
    breaks.push_back(parameters[i]);
  }
  breaks.push_back(parameters.back());
  return clamped_knots(breaks, order);
}

/// Not-a-knot knot vector of a spline of this even order through data points at the given
/// parameters: no knots at the first order/2 − 1 inner parameters, nor at the last ones.
template <Real R>
[[nodiscard]] std::vector<R> not_a_knot_knots(std::vector<R> parameters, int order) {
  const std::ptrdiff_t skipped = order / 2 - 1;
  parameters.erase(parameters.end() - 1 - skipped, parameters.end() - 1);
  parameters.erase(parameters.begin() + 1, parameters.begin() + 1 + skipped);
  return clamped_knots(parameters, order);
}

/// Knot vector of a periodic spline of this order through data points at the given parameters, the
/// last of which is one period after the first: each parameter once, continued periodically on both
/// sides.
template <Real R>
[[nodiscard]] std::vector<R> periodic_knots(const std::vector<R>& parameters, int order) {
  const std::size_t n = parameters.size() - 1;
  const R period = parameters.back() - parameters.front();
  const std::size_t more = std::size_t(order) - 1;
  std::vector<R> knots(n + 1 + 2 * more);
  for (std::size_t i = 0; i <= n; ++i) {
    knots[more + i] = parameters[i];
  }
  for (std::size_t i = 1; i <= more; ++i) {
    const std::size_t rounds = (i + n - 1) / n;
    knots[more - i] = parameters[rounds * n - i] - R(rounds) * period;
    knots[more + n + i] = parameters[i % n] + R(i / n + 1) * period;
  }
  return knots;
}

namespace detail {

/// Implements `basis_function` for a domain known to end at `end`: functions of lower order, as in
/// derivatives, have the domain of the spline that they belong to.
template <Real R>
[[nodiscard]] R basis_function(const std::vector<R>& knots, std::size_t i, int order, const R& u,
                               const R& end) {
  if (order == 1) {
    const bool inside =
        u == end ? knots[i] < u && u == knots[i + 1] : knots[i] <= u && u < knots[i + 1];
    return R(inside ? 1 : 0);
  }
  const auto k = std::size_t(order);
  const R left = knots[i + k - 1] - knots[i];
  const R right = knots[i + k] - knots[i + 1];
  R sum(0);
  if (left > 0) {
    sum += (u - knots[i]) / left * basis_function(knots, i, order - 1, u, end);
  }
  if (right > 0) {
    sum += (knots[i + k] - u) / right * basis_function(knots, i + 1, order - 1, u, end);
  }
  return sum;
}

} // namespace detail

/// B-spline basis function B_i^k(u) by the Cox–de Boor recurrence (P1): order k, degree k − 1.
///
/// The intervals are half-open, [u_i, u_{i+1}); only the last non-empty one of the domain [u_{k−1},
/// u_m] is closed. (With intervals closed at both ends, as in our copy of the paper, two would
/// count at every knot and the functions would not sum to 1.) A term whose denominator is zero is
/// zero. This is the definition; `bspline_basis` is faster.
template <Real R>
[[nodiscard]] R basis_function(const std::vector<R>& knots, std::size_t i, int order, const R& u) {
  return detail::basis_function(knots, i, order, u, knots[knots.size() - std::size_t(order)]);
}

/// Behaviour of a curve outside its domain. Parameters up to 8 ulp beyond an end count as that end,
/// with the ulp of the end of larger magnitude: sums of steps may be off by as much.
enum class out_of_domain {
  error,      ///< throws invalid_input
  clamp,      ///< keeps the value at the end, with zero rates
  extrapolate ///< continues the first or last segment
};

/// Span of the caller's last parameter, for parameters that change little from one evaluation to
/// the next. Any initial value is valid, for any curve.
struct span_hint {
  std::size_t span = 0; ///< index of the span
};

namespace detail {

/// Text of a number for messages, with enough digits to distinguish it from its neighbours.
template <Real R>
[[nodiscard]] std::string all_digits(const R& x) {
  if constexpr (std::floating_point<R>) {
    return to_text(x);
  } else {
    std::ostringstream text;
    text.precision(std::numeric_limits<R>::max_digits10);
    text << x;
    return text.str();
  }
}

} // namespace detail

/// Non-empty spans of a curve's domain, with a search for the span that contains a parameter.
template <Real R>
class knot_spans {
public:
  /// \param breaks  two or more, finite and increasing: the distinct knots of the domain
  explicit knot_spans(std::vector<R> breaks) : breaks_(std::move(breaks)) {
    const std::size_t count = span_count();
    spans_per_unit_ = R(count) / (back() - front());
    for (std::size_t i = 0; i < count; ++i) {
      is_about_uniform_ = is_about_uniform_ && guessed_span(middle(i)) == i;
    }
  }

  /// Beginning of the domain.
  [[nodiscard]] const R& front() const { return breaks_.front(); }
  /// End of the domain.
  [[nodiscard]] const R& back() const { return breaks_.back(); }
  /// Distinct knots of the domain.
  [[nodiscard]] const std::vector<R>& breaks() const { return breaks_; }
  /// Number of spans.
  [[nodiscard]] std::size_t span_count() const { return breaks_.size() - 1; }
  /// Parameter in the middle of a span.
  [[nodiscard]] R middle(std::size_t span) const {
    return breaks_[span] + (breaks_[span + 1] - breaks_[span]) / 2;
  }

  /// True if u is in the domain; false for NaN.
  [[nodiscard]] DUET_ALWAYS_INLINE bool contains(const R& u) const {
    return u >= breaks_.front() && u <= breaks_.back();
  }

  /// Returns u, or the end of the domain if u is beyond it by round-off only, see `out_of_domain`.
  [[nodiscard]] R rounded_into_domain(const R& u) const {
    return detail::clamp_rounding(u, breaks_.front(), breaks_.back());
  }

  /// Index of the span that contains u. Spans are half-open, the last one closed. A parameter that
  /// is beyond an end by round-off only belongs to the span at that end.
  ///
  /// \throws invalid_input outside the domain
  [[nodiscard]] DUET_ALWAYS_INLINE std::size_t find_span(const R& u) const {
    if (!contains(u)) [[unlikely]] {
      return adjacent_span(u);
    }
    // The guess is right if knots are about uniform; otherwise a binary search finds the span.
    const std::size_t guess = guessed_span(u);
    if (breaks_[guess] <= u && u < breaks_[guess + 1]) [[likely]] {
      return guess;
    }
    const auto above = std::upper_bound(breaks_.begin(), breaks_.end(), u) - breaks_.begin();
    return std::min(static_cast<std::size_t>(above), span_count()) - 1;
  }
  /// Index of the span that contains u. Unless knots are about uniform, the span of the hint and
  /// the next one are tried first. Updates the hint.
  [[nodiscard]] DUET_ALWAYS_INLINE std::size_t find_span(const R& u, span_hint& hint) const {
    return hint.span = is_about_uniform_ ? find_span(u) : span_near(u, hint.span);
  }

private:
  [[nodiscard]] DUET_ALWAYS_INLINE std::size_t guessed_span(const R& u) const {
    return std::min(static_cast<std::size_t>((u - breaks_.front()) * spans_per_unit_),
                    span_count() - 1);
  }
  [[nodiscard]] std::size_t span_near(const R& u, std::size_t hint) const {
    for (std::size_t i = hint; i < span_count() && i - hint < 2; ++i) {
      if (breaks_[i] <= u && u < breaks_[i + 1]) {
        return i;
      }
    }
    return find_span(u);
  }
  [[nodiscard]] DUET_COLD std::size_t adjacent_span(const R& u) const {
    if (contains(rounded_into_domain(u))) {
      return u < front() ? 0 : span_count() - 1;
    }
    detail::raise(invalid_input(detail::message(
        "duet: spline evaluated at ", detail::all_digits(u), ", outside its domain [",
        detail::all_digits(front()), ", ", detail::all_digits(back()), "]",
        u == u ? "; set_out_of_domain(out_of_domain::clamp) makes a curve stay at its end" : "")));
  }

  std::vector<R> breaks_;
  R spans_per_unit_;
  bool is_about_uniform_ = true;
};

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
    return spans_[span].weights.template at<Derivatives>(u);
  }
  /// Weights and their derivatives at a batch of parameters, each lane on a separate span.
  template <int Derivatives, std::size_t W, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE auto weights(const std::array<std::size_t, W>& spans,
                                                const P& u) const {
    const auto join = [&](const auto& get) DUET_INLINE_LAMBDA {
      return from_lanes<W>([&](std::size_t k)
                               DUET_INLINE_LAMBDA { return get(spans_[spans[k]].weights); });
    };
    bspline_span<Order, real_type_t<P>> joined{
        join([](const auto& s) DUET_INLINE_LAMBDA { return s.middle; }), {}};
    for (std::size_t j = 0; j + 1 < std::size_t(Order); ++j) {
      for (std::size_t d = 0; d < std::size_t(Order); ++d) {
        joined.polynomials[j][d] =
            join([=](const auto& s) DUET_INLINE_LAMBDA { return s.polynomials[j][d]; });
      }
    }
    return joined.template at<Derivatives>(u);
  }
  /// Varying cumulative functions of a span, as polynomials.
  [[nodiscard]] const bspline_span<Order, R>& span_weights(std::size_t span) const {
    return spans_[span].weights;
  }

  /// Increments B̃_j(to) − B̃_j(from) of the varying functions of a span. Relative to the largest
  /// increment they are as accurate as `to − from`, even for adjacent parameters.
  [[nodiscard]] std::array<R, std::size_t(Order) - 1> changes(std::size_t span, const R& from,
                                                              const R& to) const {
    const auto& [middle, polynomials] = spans_[span].weights;
    const R a = from - middle;
    const R b = to - middle;
    std::array<R, std::size_t(Order) - 1> result{};
    R power(1), quotient(1); // a^{d−1}, (b^d − a^d)/(b − a)
    R factor = b - a;
    for (std::size_t d = 1; d < std::size_t(Order); ++d) {
      factor /= R(d);
      for (std::size_t j = 0; j + 1 < std::size_t(Order); ++j) {
        result[j] += polynomials[j][d] * (quotient * factor);
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

  struct span_data {
    std::size_t first;
    bspline_span<Order, R> weights;
  };

  /// The span [u_i, u_{i+1}).
  [[nodiscard]] span_data make_span(std::size_t i) const {
    constexpr auto k = std::size_t(Order);
    const auto weights = bspline_span<Order, R>::from_knots(&knots_[i + 2 - k]);
    R highest(0);
    for (const auto& polynomial : weights.polynomials) {
      highest += polynomial[k - 1];
    }
    detail::require(highest - highest == 0, "duet: knots: knot ", i, " = ", knots_[i], " and knot ",
                    i + 1, " = ", knots_[i + 1], " are too close: a derivative overflows");
    return {i + 1 - k, weights};
  }

  std::vector<R> knots_;
  std::vector<span_data> spans_;
};

} // namespace duet
