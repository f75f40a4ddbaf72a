// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/measure.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/core/structure.hpp>
#include <duet/derivative/argument.hpp>
#include <duet/dual/complex.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <concepts>
#include <cstddef>
#include <limits>
#include <vector>

/// \file
/// Numerical derivatives without dual numbers, as independent references.

namespace duet {
namespace detail {

template <class T>
[[nodiscard]] bool is_finite(const std::vector<T>& components) {
  using std::isfinite;
  return std::all_of(components.begin(), components.end(), [](const T& x) { return isfinite(x); });
}

} // namespace detail

/// f′(x) by the complex-step method: Im f(x + ih)/h, exact to round-off for an analytic f that is a
/// template over `std::complex` (no branch on values, no `abs`, no conjugates).
///
/// f returns a complex number, an Eigen matrix or an array of them.
template <class F, std::floating_point T>
[[nodiscard]] auto complex_step_derivative(const F& f, const T& x) {
  // h² is negligible beside 1 for every function, and h itself is far from the smallest number.
  const T h = std::ldexp(T(1), std::numeric_limits<T>::min_exponent / 2);
  return map_scalars([h](const std::complex<T>& y) { return y.imag() / h; },
                     detail::result_of_call(f(std::complex<T>(x, h))));
}

/// Result of `central_difference_derivative`.
template <class Y>
struct derivative_and_error {
  Y derivative = detail::zero_initialized<Y>(); ///< f′(x)
  double error = 0;                             ///< estimate of the largest error of a component

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("derivative", derivative);
    f("error", error);
  }
};

/// f′(x) by central differences, extrapolated to step zero (Richardson, Ridders' tableau).
///
/// For any f of a real number, even if its source is hidden or full of tables: steps step/1.4ᵏ are
/// combined until round-off dominates, and the entry with the smallest estimated error is returned.
/// The estimate includes round-off of f, to one unit in the last place of its result and of x.
/// Usually eleven digits in double precision.
///
/// \return `derivative_and_error`
template <class F, Real T>
[[nodiscard]] auto central_difference_derivative(const F& f, const T& x, const T& step = T(0.1)) {
  using std::abs;
  constexpr std::size_t rows = 12;
  const T ratio = T(1.4);
  const auto shape = detail::result_of_call(f(x));
  std::array<std::vector<T>, rows> previous;
  std::array<std::vector<T>, rows> current;
  std::array<T, rows> widths{};   // of the differences, exact
  std::array<T, rows> rounding{}; // of the entries of this row
  std::array<T, rows> rounding_before{};
  std::vector<T> best;
  T best_error(-1);
  T h = step;
  for (std::size_t row = 0; row < rows; ++row, h = T(h / ratio)) {
    // The step in the numbers near x, the same on both sides.
    const T half = x < 0 ? T(x - T(x - h)) : T(T(x + h) - x);
    const T forward = x + half;
    const T backward = x - half;
    widths[row] = forward - backward;
    if (row > 0 && !(abs(widths[row]) < abs(widths[row - 1]))) {
      break; // numbers near x are no closer
    }
    const auto right = detail::components_of<T>(detail::result_of_call(f(forward)));
    const auto left = detail::components_of<T>(detail::result_of_call(f(backward)));
    current[0].resize(right.size());
    for (std::size_t i = 0; i < right.size(); ++i) {
      current[0][i] = (right[i] - left[i]) / widths[row];
    }
    const T size = std::max(detail::largest(right), detail::largest(left));
    rounding[0] = std::numeric_limits<T>::epsilon() *
                  (size / abs(widths[row]) + abs(x / widths[row]) * detail::largest(current[0]));
    for (std::size_t column = 1; column <= row; ++column) {
      const T wider = widths[row - column] / widths[row];
      const T factor = wider * wider; // errors are even powers of the step
      const auto& a = current[column - 1];
      const auto& b = previous[column - 1];
      current[column].resize(a.size());
      for (std::size_t i = 0; i < a.size(); ++i) {
        current[column][i] = (factor * a[i] - b[i]) / (factor - 1);
      }
      rounding[column] =
          (factor * rounding[column - 1] + rounding_before[column - 1]) / (factor - 1);
      const T towards_a = detail::largest(detail::errors_of(current[column], a));
      const T towards_b = detail::largest(detail::errors_of(current[column], b));
      const T error = std::max(towards_a, towards_b) + rounding[column];
      if (detail::is_finite(current[column]) && detail::is_finite(a) && detail::is_finite(b) &&
          (best_error < 0 || error < best_error)) {
        best_error = error;
        best = current[column];
      }
    }
    previous = current;
    rounding_before = rounding;
  }
  if (best.empty()) { // no two estimates are finite
    best = current[0];
    best_error = std::numeric_limits<T>::infinity();
  }
  std::size_t next = 0;
  auto derivative = map_scalars([&](const auto&) { return best[next++]; }, shape);
  return derivative_and_error<decltype(derivative)>{derivative, static_cast<double>(best_error)};
}

} // namespace duet
