// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

/// \file
/// Knot vectors of splines, and basis functions by definition.

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

} // namespace duet
