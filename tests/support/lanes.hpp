// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "support/random.hpp"

#include <duet/core/batch/batch.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/level.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

/// \file
/// Functions over batches against the same functions lane by lane.

namespace duet_test {

/// The real numbers of every scalar in an object: one row per scalar, its value first, then all its
/// infinitesimal parts.
template <class X>
[[nodiscard]] std::vector<std::vector<double>> real_parts(const X& x) {
  std::vector<std::vector<double>> result;
  static_cast<void>(duet::structure<X>::map(
      [&](const auto& s) {
        std::vector<double> row;
        static_cast<void>(duet::detail::map_reals(s, [&](const auto& part) {
          row.push_back(double(part));
          return part;
        }));
        result.push_back(row);
        return s;
      },
      x));
  return result;
}

/// The last place of a number 1 of what an object consists of.
template <class X>
constexpr double last_place =
    std::numeric_limits<duet::real_type_t<typename duet::structure<X>::scalar>>::epsilon();

/// How far apart are two objects, in units of the last place of the largest part of that order, and
/// of what that order is `uncertain` by? What is infinite or not a number must be that in both.
template <class X>
[[nodiscard]] double ulps_apart(const X& a, const X& b, const std::vector<double>& uncertain = {}) {
  const auto p = real_parts(a), q = real_parts(b);
  const double infinite = std::numeric_limits<double>::infinity();
  double worst = 0;
  for (std::size_t k = 0; k < p[0].size(); ++k) {
    double scale = std::numeric_limits<double>::min();
    for (const auto& row : q) {
      scale = std::isfinite(row[k]) ? std::max(scale, std::abs(row[k])) : scale;
    }
    const double unit = scale * last_place<X> + (uncertain.empty() ? 0 : uncertain[k]);
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (!std::isfinite(q[i][k]) || !std::isfinite(p[i][k])) {
        const bool same = p[i][k] == q[i][k] || (std::isnan(p[i][k]) && std::isnan(q[i][k]));
        worst = same ? worst : infinite;
      } else {
        worst = std::max(worst, std::abs(p[i][k] - q[i][k]) / unit);
      }
    }
  }
  return worst;
}

/// An object whose every real number is off by one unit of the last place, up or down.
template <class X>
[[nodiscard]] X nudged(const X& x, random_source& random) {
  return duet::structure<X>::map(
      [&](const auto& s) {
        return duet::detail::map_reals(s, [&](const auto& part) {
          using T = std::decay_t<decltype(part)>;
          return T(part * T(1 + (random.unit() < 0.5 ? -1 : 1) * last_place<X>));
        });
      },
      x);
}

/// By how much f changes, order by order, if its arguments are off in the last place: the rounding
/// that no way to compute f can be without. Where the target multiplies and adds in one step, this
/// is what is left of sums that would cancel to zero. A jump of f is no rounding and not counted.
template <class F, class... X>
[[nodiscard]] std::vector<double> uncertainty(const F& f, const X&... x) {
  const auto exact = real_parts(f(x...));
  double largest = 0;
  for (const auto& parts : {exact, real_parts(x)...}) {
    for (const auto& row : parts) {
      for (const double part : row) {
        largest = std::isfinite(part) ? std::max(largest, std::abs(part)) : largest;
      }
    }
  }
  std::vector<double> result(exact[0].size());
  random_source random(1);
  for (int n = 0; n < 8; ++n) {
    const auto other = real_parts(f(nudged(x, random)...));
    for (std::size_t i = 0; i < exact.size(); ++i) {
      for (std::size_t k = 0; k < result.size(); ++k) {
        const double change = std::abs(other[i][k] - exact[i][k]);
        if (change <= 1e-6 * largest) {
          result[k] = std::max(result[k], change);
        }
      }
    }
  }
  return result;
}

/// f over batches of W of the given arguments, each of them with others beside it, against f of
/// each alone: they may be `limit` last places apart, or `limit` times what arguments that are off
/// in the last place make of f.
template <int W, class F, class X, class... Rest>
void check_lanes(const F& f, double limit, const std::vector<X>& x,
                 const std::vector<Rest>&... rest) {
  using duet::lane;
  for (std::size_t shift = 0; shift < x.size(); shift += std::max(W / 2, 1)) {
    const auto joined = [&](const auto& from) {
      return duet::from_lanes<W>(
          [&](std::size_t i) { return from[(shift + 3 * i) % from.size()]; });
    };
    const auto result = f(joined(x), joined(rest)...);
    for (int i = 0; i < W; ++i) {
      const auto at = [&](const auto& from) {
        return from[(shift + 3 * std::size_t(i)) % from.size()];
      };
      CAPTURE(shift);
      CAPTURE(i);
      const auto found = lane(result, i);
      const auto expected = f(at(x), at(rest)...);
      double apart = ulps_apart(found, expected);
      if (apart > limit) {
        apart = ulps_apart(found, expected, uncertainty(f, at(x), at(rest)...));
      }
      CHECK(apart <= limit);
    }
  }
}

} // namespace duet_test

/// The function of that name over four lanes, see `check_lanes`.
#define DUET_CHECK_LANES(function, limit, ...)                                                     \
  duet_test::check_lanes<4>([](const auto&... x) { return function(x...); }, limit, __VA_ARGS__)
