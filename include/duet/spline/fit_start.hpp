// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/tag.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/basis.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

/// \file
/// Where fits start, and what is an outlier to a robust one: medians, which up to half of the rows
/// may spoil without moving them far.

namespace duet::detail {

/// The mean of the Order − 1 inner knots of basis function i (Greville's abscissa).
template <int Order, Real R>
[[nodiscard]] R knot_average(const bspline_basis<Order, R>& basis, std::size_t i) {
  R sum(0);
  for (std::size_t j = 1; j < std::size_t(Order); ++j) {
    sum += basis.knots()[i + j];
  }
  return sum / R(Order - 1);
}

/// Where the rows are at the knots' averages (Greville's abscissae).
template <class T, int Order>
[[nodiscard]] std::vector<quaternion<T>>
elements_at_averages(const bspline_basis<Order, real_type_t<T>>& basis,
                     const std::vector<real_type_t<T>>& u, const std::vector<quaternion<T>>& rows) {
  using R = real_type_t<T>;
  std::vector<quaternion<T>> result;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const R at = knot_average(basis, i);
    const auto above = std::size_t(std::upper_bound(u.begin(), u.end(), at) - u.begin());
    const std::size_t right = std::clamp<std::size_t>(above, 1, u.size() - 1);
    const R fraction = std::clamp(R((at - u[right - 1]) / (u[right] - u[right - 1])), R(0), R(1));
    result.push_back(slerp(rows[right - 1], rows[right], fraction));
    if (i > 0 && innermost(dot(result[i - 1], result[i])) < 0) {
      result[i] = -result[i];
    }
  }
  return result;
}

/// The upper median; at least one x. NaN counts as infinite.
template <Real R>
[[nodiscard]] R median(std::vector<R> x) {
  for (R& each : x) {
    each = each == each ? each : std::numeric_limits<R>::infinity();
  }
  const auto middle = x.begin() + std::ptrdiff_t(x.size() / 2);
  std::nth_element(x.begin(), middle, x.end());
  return *middle;
}

/// Row by row the median of x over the rows around, 61 or more if there are as many: those that
/// belong to the same piece of the curve, which is told by a number that does not decrease.
template <Real R>
[[nodiscard]] std::vector<R> local_medians(const std::vector<R>& x,
                                           const std::vector<std::size_t>& piece) {
  constexpr std::size_t enough = 61;
  const std::size_t n = x.size();
  std::vector<R> result;
  result.reserve(n);
  while (result.size() < n) {
    const std::size_t first = result.size();
    const auto last =
        std::size_t(std::upper_bound(piece.begin(), piece.end(), piece[first]) - piece.begin());
    const std::size_t more = last - first < enough ? (enough - (last - first) + 1) / 2 : 0;
    const std::size_t count = std::min(n, last - first + 2 * more);
    const std::size_t from = std::min(first > more ? first - more : 0, n - count);
    const auto begin = x.begin() + std::ptrdiff_t(from);
    result.resize(last, median(std::vector<R>(begin, begin + std::ptrdiff_t(count))));
  }
  return result;
}

/// A length that grows no faster than the distance, so that squares do not overflow: the sum of the
/// angle and of distance/length.
template <class T>
[[nodiscard]] real_type_t<T> separation(const quaternion<T>& a, const quaternion<T>& b,
                                        const real_type_t<T>& length) {
  using std::abs;
  using std::acos;
  using R = real_type_t<T>;
  const R cosine = abs(innermost(dot(a, b)));
  R sum = cosine < 1 ? R(2 * acos(cosine)) : R(0);
  if constexpr (contains_tag<T, screw_tag>()) {
    const vector3<R> move = translation(b) - translation(a);
    sum += move.template lpNorm<1>() / length;
  }
  return sum;
}

/// Of rows [from, to) and among those no farther than `radius` from row `centre`, the one that is
/// nearest to the others, by the sum of the logarithms of separations: however far off some are, no
/// sum forgets the near ones. The radius becomes three times the median separation from it.
template <class T>
void move_to_medoid(const std::vector<quaternion<T>>& rows, std::size_t from, std::size_t to,
                    const real_type_t<T>& length, std::size_t& centre, real_type_t<T>& radius) {
  using std::log1p;
  using R = real_type_t<T>;
  std::vector<std::size_t> near_rows;
  for (std::size_t i = from; i < to; ++i) {
    if (separation(rows[centre], rows[i], length) <= radius) {
      near_rows.push_back(i);
    }
  }
  if (3 * near_rows.size() < to - from) {
    if (to - from < 21) {
      return; // by chance: few rows do not prove the others wrong
    }
    near_rows.resize(to - from); // the motion is another one here
    std::iota(near_rows.begin(), near_rows.end(), from);
  }
  std::vector<std::vector<R>> table;
  R typical = std::numeric_limits<R>::infinity();
  for (const std::size_t a : near_rows) {
    std::vector<R> line;
    for (const std::size_t b : near_rows) {
      line.push_back(separation(rows[a], rows[b], length));
    }
    typical = std::min(typical, median(line));
    table.push_back(std::move(line));
  }
  typical = std::max(typical, std::numeric_limits<R>::epsilon());
  R lowest = std::numeric_limits<R>::infinity();
  for (std::size_t k = 0; k < table.size(); ++k) {
    R sum(0);
    for (const R& each : table[k]) {
      sum += log1p(std::min(R(each / typical), std::numeric_limits<R>::max()));
    }
    if (sum < lowest) {
      lowest = sum;
      centre = near_rows[k];
      radius = 3 * median(table[k]);
    }
  }
}

/// Control elements for a robust fit: a medoid of the rows around each knot average (Greville's
/// abscissa), sought from many rows to few, so that outliers do not pass for a motion where by
/// chance they are many.
template <class T, int Order>
[[nodiscard]] std::vector<quaternion<T>>
medoids(const bspline_basis<Order, real_type_t<T>>& basis, const std::vector<real_type_t<T>>& u,
        const std::vector<quaternion<T>>& rows, const real_type_t<T>& length) {
  using R = real_type_t<T>;
  const auto place = [&](const R& x) {
    return std::size_t(std::lower_bound(u.begin(), u.end(), x) - u.begin());
  };
  std::vector<quaternion<T>> result;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const std::size_t middle = place(knot_average(basis, i));
    std::size_t centre = std::min(middle, rows.size() - 1);
    R radius = std::numeric_limits<R>::infinity();
    for (const std::size_t most : {81, 41, 21, 11, 5}) {
      const std::size_t count = std::min(rows.size(), most);
      const std::size_t from =
          std::min(middle > count / 2 ? middle - count / 2 : 0, rows.size() - count);
      move_to_medoid(rows, from, from + count, length, centre, radius);
    }
    result.push_back(rows[centre]);
    if (i > 0 && innermost(dot(result[i - 1], result[i])) < 0) {
      result[i] = -result[i];
    }
  }
  return result;
}

} // namespace duet::detail
