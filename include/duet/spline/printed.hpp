// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/cumulative_bspline.hpp>

#include <cstddef>

/// \file
/// Derivatives of the cumulative curve as our copy of the paper prints them (P3, P4), for
/// comparison. They are not the derivatives of the curve.
///
/// The paper writes q_{−1}, but never B_{−1}. If the functions over the knots are its B_{−1}, B_0
/// …, as many as control points, the curve's first control point is q_{−1}, as in duet. If they are
/// its B_0, B_1 …, then B̃_0 = 1, the curve's first control point is q_0, and q_{−1} has no effect.

namespace duet {

/// First and second derivative of Q in three versions: literal under both readings, and as the
/// print intends.
template <class T>
struct printed_derivatives {
  /// P3 and P4 to the letter, the first function being B_{−1}: sums from 1 on, a lone scalar B̃′_0
  /// instead of ω_0 B̃′_0 (B̃″_0 in both brackets of P4), the ω_i summed as if they commuted, B̃″_i
  /// one term short.
  quaternion<T> literal_first, literal_second;
  /// P3 and P4 to the letter, the first function being B_0: the lone scalars vanish, and the sums
  /// contain all varying terms. The ω_i are summed as if they commuted, B̃″_i is one term short.
  quaternion<T> from_zero_first, from_zero_second;
  /// Commuting sums over all i with the true B̃′_i and B̃″_i; the first is `from_zero_first`.
  quaternion<T> commuting_first, commuting_second;

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("literal_first", literal_first);
    f("literal_second", literal_second);
    f("from_zero_first", from_zero_first);
    f("from_zero_second", from_zero_second);
    f("commuting_first", commuting_first);
    f("commuting_second", commuting_second);
  }
};

/// Derivatives P3 and P4 as printed, at a parameter u; for the true derivatives use
/// `cumulative_bspline::derivatives`.
///
/// \throws invalid_input outside the domain
template <class T, int Order>
[[nodiscard]] printed_derivatives<T> printed_derivative(const cumulative_bspline<T, Order>& s,
                                                        const T& parameter) {
  static_assert(Order >= 3, "duet: the printed second derivative needs order 3 or more");
  using Q = quaternion<T>;
  const auto& knots = s.basis().knots();
  const T u = s.basis().rounded_into_domain(parameter);
  const std::size_t span = s.basis().find_span(u);
  const std::size_t first = s.basis().first_function(span);
  const auto weights = s.basis().template weights<2>(span, u);
  constexpr auto k = std::size_t(Order);

  vector3<T> commuting_sum = vector3<T>::Zero();
  vector3<T> commuting_sum_of_second = vector3<T>::Zero();
  vector3<T> sum = vector3<T>::Zero();
  vector3<T> sum_of_second = vector3<T>::Zero();
  vector3<T> literal_sum = vector3<T>::Zero();
  vector3<T> literal_sum_of_second = vector3<T>::Zero();
  T lone_first(0);
  T lone_second(0);
  for (std::size_t j = 0; j + 1 < k; ++j) {
    const std::size_t i = first + 1 + j; // the paper's i + 1, or its i if functions start at B_0
    const vector3<T>& omega = s.increments()[i];
    commuting_sum += omega * weights[1][j];
    commuting_sum_of_second += omega * weights[2][j];
    const T width = knots[i + k - 1] - knots[i];
    const T shorter_width = knots[i + k - 2] - knots[i];
    const T printed_first =
        (k - 1) / width * detail::basis_function(knots, i, Order - 1, u, s.basis().back());
    const T printed_second =
        shorter_width > 0 ? T((k - 1) * (k - 2) / (width * shorter_width) *
                              detail::basis_function(knots, i, Order - 2, u, s.basis().back()))
                          : T(0);
    sum += omega * printed_first;
    sum_of_second += omega * printed_second;
    if (i == 1) { // B̃_0 if the first function is B_{−1}
      lone_first = printed_first;
      lone_second = printed_second;
    } else {
      literal_sum += omega * printed_first;
      literal_sum_of_second += omega * printed_second;
    }
  }
  const Q q = s(u);
  printed_derivatives<T> result;
  result.literal_first = q * Q(lone_first, literal_sum);
  result.literal_second = result.literal_first * Q(lone_second, literal_sum) +
                          q * Q(lone_second, literal_sum_of_second);
  result.from_zero_first = q * Q(T(0), sum);
  result.from_zero_second = result.from_zero_first * Q(T(0), sum) + q * Q(T(0), sum_of_second);
  result.commuting_first = q * Q(T(0), commuting_sum);
  result.commuting_second =
      result.commuting_first * Q(T(0), commuting_sum) + q * Q(T(0), commuting_sum_of_second);
  return result;
}

} // namespace duet
