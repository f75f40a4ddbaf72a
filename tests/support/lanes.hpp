// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/batch/lanes.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/parts.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
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

/// Are two objects the same up to some ulps of the largest part of that order? What is infinite or
/// not a number must be that in both.
template <class X>
[[nodiscard]] double ulps_apart(const X& a, const X& b) {
  const auto p = real_parts(a), q = real_parts(b);
  const double infinite = std::numeric_limits<double>::infinity();
  double worst = 0;
  for (std::size_t k = 0; k < p[0].size(); ++k) {
    double scale = std::numeric_limits<double>::min();
    for (const auto& row : q) {
      scale = std::isfinite(row[k]) ? std::max(scale, std::abs(row[k])) : scale;
    }
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (!std::isfinite(q[i][k]) || !std::isfinite(p[i][k])) {
        const bool same = p[i][k] == q[i][k] || (std::isnan(p[i][k]) && std::isnan(q[i][k]));
        worst = same ? worst : infinite;
      } else {
        worst = std::max(worst, std::abs(p[i][k] - q[i][k]) / (scale * 0x1p-52));
      }
    }
  }
  return worst;
}

/// f over batches of W of the given arguments, each of them with others beside it, against f of
/// each alone.
template <int W, class F, class X, class... Rest>
void check_lanes(const F& f, double limit, const std::vector<X>& x,
                 const std::vector<Rest>&... rest) {
  using duet::lane;
  for (std::size_t shift = 0; shift < x.size(); shift += W / 2) {
    const auto joined = [&](const auto& from) {
      return duet::joined_lanes<W>(
          [&](std::size_t i) { return from[(shift + 3 * i) % from.size()]; });
    };
    const auto result = f(joined(x), joined(rest)...);
    for (int i = 0; i < W; ++i) {
      const auto at = [&](const auto& from) {
        return from[(shift + 3 * std::size_t(i)) % from.size()];
      };
      CAPTURE(shift);
      CAPTURE(i);
      CHECK(ulps_apart(lane(result, i), f(at(x), at(rest)...)) <= limit);
    }
  }
}

} // namespace duet_test
