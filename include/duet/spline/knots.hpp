// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

/// \file
/// Knot vectors.

namespace duet {
namespace detail {

/// \throws invalid_input unless the knots are finite, do not decrease, leave a domain for splines
/// of this order and repeat none more often than `order` times
template <Real R>
void check_knots(const std::vector<R>& knots, int order) {
  const auto fail = [](const auto&... what) {
    raise(invalid_input(message("duet: knots: ", what...)));
  };
  const auto k = std::size_t(order);
  if (knots.size() < 2 * k) {
    fail("order ", order, " needs at least ", 2 * k, " of them, got ", knots.size(),
         ": clamped_knots(parameters, ", order, ") makes enough");
  }
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!(knots[i] - knots[i] == 0)) {
      fail("knot ", i, " is ", knots[i]);
    }
    if (i > 0 && knots[i] < knots[i - 1]) {
      fail("knot ", i, " = ", knots[i], " is less than knot ", i - 1, " = ", knots[i - 1]);
    }
    if (i >= k && knots[i] == knots[i - k]) {
      fail("knot ", i, " = ", knots[i], " is repeated more than ", order, " times");
    }
  }
  if (!(knots[k - 1] < knots[knots.size() - k])) {
    fail("the domain is empty");
  }
  if (const R width = knots.back() - knots.front(); !(width - width == 0)) {
    fail("the distance from ", knots.front(), " to ", knots.back(), " overflows");
  }
}

} // namespace detail

/// The knots of a spline of this order through data at the given parameters: each once, the first
/// and the last `order` times, so that the curve ends in its first and last control elements.
template <Real R>
[[nodiscard]] std::vector<R> clamped_knots(const std::vector<R>& parameters, int order) {
  const std::size_t more = std::size_t(order) - 1, last = parameters.size() - 1;
  std::vector<R> knots(last + 1 + 2 * more);
  for (std::size_t i = 0; i < knots.size(); ++i) {
    knots[i] = parameters[std::min(i - std::min(i, more), last)];
  }
  return knots;
}

/// The knots of a spline of this order for `fit` to rows at the given parameters: one at every n-th
/// row, so that they are dense where the rows are, and at the first and the last, those repeated as
/// by `clamped_knots`. The last of them but the end is n to 2 n − 1 rows before it.
/// \param n  rows to a knot: more smooth more, fewer follow faster motion
/// \throws invalid_input for n = 0 and fewer than two rows
template <Real R>
[[nodiscard]] std::vector<R> knots_at_rows(const std::vector<R>& parameters, std::size_t n,
                                           int order = 4) {
  detail::require(n > 0 && parameters.size() > 1, "duet: knots_at_rows: n = ", n, " and ",
                  parameters.size(), " rows: n must be positive, and at least two rows there");
  std::vector<R> breaks{parameters.front()};
  for (std::size_t i = n; i < parameters.size() - 1 && n <= parameters.size() - 1 - i; i += n) {
    breaks.push_back(parameters[i]);
  }
  breaks.push_back(parameters.back());
  return clamped_knots(breaks, order);
}

/// The knots of a spline of this order, even, through data at the given parameters that has no knot
/// where the first order/2 − 1 parameters inside are, nor where the last ones are.
template <Real R>
[[nodiscard]] std::vector<R> not_a_knot_knots(std::vector<R> parameters, int order) {
  const std::ptrdiff_t left_out = order / 2 - 1;
  parameters.erase(parameters.end() - 1 - left_out, parameters.end() - 1);
  parameters.erase(parameters.begin() + 1, parameters.begin() + 1 + left_out);
  return clamped_knots(parameters, order);
}

/// The knots of a periodic spline of this order through data at the given parameters, the last of
/// which is one period after the first: each once, and continued round on both sides.
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

/// `bspline_value` where the domain is known to end at `end`: functions of lower order, as in
/// derivatives, have the domain of the spline that they belong to.
template <Real R>
[[nodiscard]] R bspline_value(const std::vector<R>& knots, std::size_t i, int order, const R& u,
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
    sum += (u - knots[i]) / left * bspline_value(knots, i, order - 1, u, end);
  }
  if (right > 0) {
    sum += (knots[i + k] - u) / right * bspline_value(knots, i + 1, order - 1, u, end);
  }
  return sum;
}

} // namespace detail

/// B_i^k(u) by the recurrence of de Boor and Cox (P1): order k, degree k − 1.
///
/// The intervals are half-open, [u_i, u_{i+1}); only the last non-empty one of the domain [u_{k−1},
/// u_m] is closed. (Closed at both ends, as our copy of the paper has them, two would count at
/// every knot and the functions would not sum to 1.) A term whose denominator is zero is zero. This
/// is the definition; `bspline_basis` is the fast way.
template <Real R>
[[nodiscard]] R bspline_value(const std::vector<R>& knots, std::size_t i, int order, const R& u) {
  return detail::bspline_value(knots, i, order, u, knots[knots.size() - std::size_t(order)]);
}

} // namespace duet
