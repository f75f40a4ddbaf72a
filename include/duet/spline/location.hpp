// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/rounding.hpp>
#include <duet/core/scalar_traits.hpp>
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
/// Where on a curve a parameter is.

namespace duet {

/// What a curve does outside its domain. Up to 8 ulp beyond an end, of the end of larger magnitude,
/// is that end: so far sums of steps may be off.
enum class outside {
  error,      ///< throws invalid_input
  clamp,      ///< stays where it is at the end, without rates
  extrapolate ///< goes on with its first or last piece
};

/// The caller's memory of the span that a parameter was in, for parameters that move little from
/// one evaluation to the next. Any value will do to begin with, and for any curve.
struct span_hint {
  std::size_t span = 0; ///< its number
};

} // namespace duet

namespace duet::detail {

/// A number for messages, told apart from its neighbours.
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

/// The non-empty spans of a curve's domain, and which of them holds a parameter.
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

  /// The beginning of the domain.
  [[nodiscard]] const R& front() const { return breaks_.front(); }
  /// The end of the domain.
  [[nodiscard]] const R& back() const { return breaks_.back(); }
  /// The distinct knots of the domain.
  [[nodiscard]] const std::vector<R>& breaks() const { return breaks_; }
  /// Number of spans.
  [[nodiscard]] std::size_t span_count() const { return breaks_.size() - 1; }
  /// The parameter in the middle of a span.
  [[nodiscard]] R middle(std::size_t span) const {
    return breaks_[span] + (breaks_[span + 1] - breaks_[span]) / 2;
  }

  /// Is u in the domain? NaN is not.
  [[nodiscard]] DUET_ALWAYS_INLINE bool contains(const R& u) const {
    return u >= breaks_.front() && u <= breaks_.back();
  }

  /// u; the end of the domain that it is beyond by rounding only, see `outside`.
  [[nodiscard]] R rounded_into_domain(const R& u) const {
    return detail::rounded_into(u, breaks_.front(), breaks_.back());
  }

  /// Number of the span that holds u: half-open, the last one closed. Beyond an end by rounding
  /// only, that at the end.
  /// \throws invalid_input outside the domain
  [[nodiscard]] DUET_ALWAYS_INLINE std::size_t span_of(const R& u) const {
    if (!contains(u)) [[unlikely]] {
      return span_beside(u);
    }
    // Where knots are about uniform the guess is right; otherwise a binary search finds the span.
    const std::size_t guess = guessed_span(u);
    if (breaks_[guess] <= u && u < breaks_[guess + 1]) [[likely]] {
      return guess;
    }
    const auto above = std::upper_bound(breaks_.begin(), breaks_.end(), u) - breaks_.begin();
    return std::min(static_cast<std::size_t>(above), span_count()) - 1;
  }
  /// The span that holds u, looked for in that of the hint and the next one first where knots are
  /// not about uniform; the hint is updated.
  [[nodiscard]] DUET_ALWAYS_INLINE std::size_t span_of(const R& u, span_hint& hint) const {
    return hint.span = is_about_uniform_ ? span_of(u) : span_near(u, hint.span);
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
    return span_of(u);
  }
  [[nodiscard]] DUET_COLD std::size_t span_beside(const R& u) const {
    if (contains(rounded_into_domain(u))) {
      return u < front() ? 0 : span_count() - 1;
    }
    detail::raise(invalid_input(detail::message(
        "duet: spline evaluated at ", detail::all_digits(u), ", outside its domain [",
        detail::all_digits(front()), ", ", detail::all_digits(back()), "]",
        u == u ? "; set_outside_domain(outside::clamp) makes a curve stay at its end" : "")));
  }

  std::vector<R> breaks_;
  R spans_per_unit_;
  bool is_about_uniform_ = true;
};

} // namespace duet
