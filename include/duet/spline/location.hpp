// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/core/text/number_text.hpp>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Spans of a curve's domain, the search for the span of a parameter, and the behaviour outside the
/// domain.

namespace duet {

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

} // namespace duet

namespace duet::detail {

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

} // namespace duet::detail

namespace duet {

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

} // namespace duet
