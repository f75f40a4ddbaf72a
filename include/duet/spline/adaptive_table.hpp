// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/dual_quaternion/distance.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/orientations.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Lookup tables refined to an error bound, and error estimates of existing tables.

namespace duet {

/// Options of `adaptive_table`.
struct adaptive_table_options {
  /// Characteristic length: distance between poses that counts as much as a rotation by 1 rad.
  double characteristic_length = 1;
  std::size_t initial_samples = 9;   ///< initial number of samples, equally spaced; at least 4
  std::size_t max_samples = 100'000; ///< maximum number of samples; more: `no_convergence`
};

/// Lookup table, the curve through it, and the largest distance found between the curve and the
/// tabulated function: radians, for poses as `distance`.
template <CurveType Spline>
struct adaptive_table_result {
  lookup_table<typename Spline::scalar_type> table; ///< as few samples as were needed
  Spline curve;                                     ///< curve through `table`
  double error; ///< largest distance found: radians, for poses units of length

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("table", table);
    f("error", error);
  }
};

namespace detail {

/// Angle between rotations, or distance between poses.
template <class T>
[[nodiscard]] real_type_t<T> miss(const quaternion<T>& a, const quaternion<T>& b,
                                  double characteristic_length) {
  if constexpr (contains_tag<T, screw_tag>()) {
    return innermost(distance(a, b, characteristic_length));
  } else {
    return innermost(rotation_vector(quaternion<T>(conj(a) * b)).norm());
  }
}

/// Sample f(u), a unit quaternion or pose.
///
/// \throws invalid_input if it is not finite or not a unit
template <class T, class F, class R>
[[nodiscard]] quaternion<T> sample_of(const F& f, const R& u) {
  using std::abs;
  const quaternion<T> q = f(u);
  const bool is_finite = is_all_finite(q);
  require(is_finite, "duet: adaptive_table: the function is not finite at ", all_digits(u));
  const auto length = norm(innermost_of(q));
  require(abs(length - 1) <= unit_norm_tolerance, "duet: adaptive_table: the function at ",
          all_digits(u), " has norm ", length, ", not 1");
  return q;
}

/// Largest distance from f inside an interval, sampled at eight points. If it is not far below the
/// tolerance, 24 more points follow, and the worst one is refined. Points are spread unevenly,
/// because a ripple may vanish at even ones.
template <class Spline, class F, class R>
[[nodiscard]] double miss_between(const Spline& s, const F& f, const R& low, const R& high,
                                  double tolerance, double characteristic_length) {
  const auto miss_at = [&](const R& u) {
    return double(miss(s(u), sample_of<typename Spline::scalar_type>(f, u), characteristic_length));
  };
  double largest = 0;
  R worst = low;
  const auto evaluate_at = [&](int count, double seed) {
    for (int k = 0; k < count; ++k) {
      const double spread = seed + 0.6180339887498949 * k;
      const R u = low + (high - low) * R((k + spread - std::floor(spread)) / count);
      if (const double error = miss_at(u); error > largest) {
        largest = error;
        worst = u;
      }
    }
  };
  evaluate_at(8, .25);
  if (largest <= tolerance && largest > tolerance / 16) {
    evaluate_at(24, .75);
    R step = (high - low) / R(24);
    for (int k = 0; k < 6; ++k, step /= R(2)) {
      for (const R& u : {R(worst - step), R(worst + step)}) {
        const double error = u > low && u < high ? miss_at(u) : 0;
        if (error > largest) {
          largest = error;
          worst = u;
          break;
        }
      }
    }
  }
  return largest;
}

} // namespace detail

/// Tabulates f over [first, last] such that the curve of type `Spline` through the table is no
/// farther from f than the tolerance. Intervals with larger errors are halved.
///
/// The distance is sampled at eight points of each interval, and at more if it is near the
/// tolerance, so f must not have detail that these points miss.
///
/// \param f          function that returns the rotation or pose at a parameter
/// \param tolerance  radians, for poses as `distance` with `options.characteristic_length`
/// \param ends       end conditions of the curve
/// \throws invalid_input for a tolerance that is not positive, an empty range, more initial samples
/// than `options.max_samples`, and a function value that is not finite or not a unit, with the
/// parameter
/// \throws no_convergence if `options.max_samples` do not reach the tolerance
/// \throws invalid_sample and others as `interpolate`
template <CurveType Spline, class F>
[[nodiscard]] adaptive_table_result<Spline>
adaptive_table(const F& f, typename Spline::real_type first, typename Spline::real_type last,
               double tolerance,
               const curve_ends<typename Spline::scalar_type>& ends = not_a_knot{},
               const adaptive_table_options& options = {}) {
  using T = typename Spline::scalar_type;
  using R = typename Spline::real_type;
  static_assert(detail::Becomes<std::invoke_result_t<const F&, const R&>, quaternion<T>>,
                "duet: adaptive_table: the function must return a rotation, quaternion<T>, or a "
                "pose, dual_quaternion<T>");
  detail::require(first < last && tolerance > 0, "duet: adaptive_table: the range is from ", first,
                  " to ", last, " and the tolerance ", tolerance,
                  " (expected a range that is not empty and a positive tolerance)");
  const std::size_t count = std::max<std::size_t>(4, options.initial_samples);
  detail::require(count <= options.max_samples, "duet: adaptive_table: begins with ", count,
                  " samples, more than options.max_samples, which is ", options.max_samples);
  lookup_table<T> table;
  for (std::size_t i = 0; i < count; ++i) {
    const R u = i + 1 < count ? R(first + (last - first) * R(i) / R(count - 1)) : last;
    table.parameters.push_back(u);
    table.elements.push_back(detail::sample_of<T>(f, u));
  }
  for (;;) {
    Spline s = interpolate<Spline>(table.parameters, table.elements, ends);
    lookup_table<T> finer;
    double worst = 0;
    for (std::size_t i = 0; i + 1 < table.parameters.size(); ++i) {
      const R& low = table.parameters[i];
      const R& high = table.parameters[i + 1];
      finer.parameters.push_back(low);
      finer.elements.push_back(table.elements[i]);
      const double error =
          detail::miss_between(s, f, low, high, tolerance, options.characteristic_length);
      worst = std::max(worst, error);
      if (!(error <= 0.99 * tolerance)) { // samples miss the last part of a maximum
        const R middle = low + (high - low) / R(2);
        finer.parameters.push_back(middle);
        finer.elements.push_back(detail::sample_of<T>(f, middle));
      }
    }
    if (finer.parameters.size() + 1 == table.parameters.size()) {
      return {std::move(table), std::move(s), worst};
    }
    finer.parameters.push_back(table.parameters.back());
    finer.elements.push_back(table.elements.back());
    if (finer.parameters.size() > options.max_samples) {
      detail::raise(no_convergence(
          detail::message("duet: adaptive_table: the error with ", table.parameters.size(),
                          " samples is ", worst, ", above the tolerance ", tolerance,
                          ", and options.max_samples is ", options.max_samples)));
    }
    table = std::move(finer);
  }
}

/// Estimates the error of the curve through a lookup table without further knowledge of the motion:
/// element i − 1 is the error near sample i.
///
/// A curve through every other sample misses the omitted samples by about 2^p times the error of
/// the curve through all samples, p = `Spline::convergence`, near natural ends p = 2; uneven steps
/// are accounted for. Rates given in `ends` count as those of the motion. If the table resolves the
/// motion, the largest estimate is seldom below the largest error. For cubic curves it is mostly up
/// to five times as large; for quintic ones and for steps of very different lengths it may be far
/// larger.
///
/// \throws invalid_input for fewer than nine samples
/// \throws invalid_sample and others as `interpolate`
template <CurveType Spline>
[[nodiscard]] std::vector<double>
estimated_errors(const lookup_table<typename Spline::scalar_type>& table,
                 const curve_ends<typename Spline::scalar_type>& ends = not_a_knot{},
                 double characteristic_length = 1) {
  const std::size_t count = table.parameters.size();
  detail::require(count >= 9 && count == table.elements.size(),
                  "duet: estimated_errors: needs nine samples or more, got ", count,
                  " parameters and ", table.elements.size(), " elements");
  const auto elements = normalized_quaternions(table.elements);
  const auto& u = table.parameters;
  std::vector<double> misses(count, 0.);
  for (const std::size_t parity : {std::size_t(0), std::size_t(1)}) { // of the samples kept
    lookup_table<typename Spline::scalar_type> half;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % 2 == parity || i == 0 || i + 1 == count) {
        half.parameters.push_back(u[i]);
        half.elements.push_back(elements[i]);
      }
    }
    const auto s = interpolate<Spline>(half.parameters, half.elements, ends);
    for (std::size_t i = 1 + parity; i + 1 < count; i += 2) {
      // Between samples errors grow as t²(1 − t)², and with a power of the longer of the two steps.
      const double left = double(u[i] - u[i - 1]), right = double(u[i + 1] - u[i]);
      const double t = left / (left + right), longest = std::max(t, 1 - t);
      const double shape = std::max(.1, 4 * t * (1 - t));
      // Near the ends curves converge more slowly.
      const bool is_near_end = i < 6 || i + 6 >= count;
      const double safety = Spline::convergence > 4 ? 5 : !is_near_end && longest < .6 ? 1.2 : 2.2;
      const int power =
          is_near_end && ends.kind == detail::end_condition_kind::natural ? 2 : Spline::convergence;
      misses[i] = safety * std::pow(longest, power) / (shape * shape) *
                  double(detail::miss(s(u[i]), elements[i], characteristic_length));
    }
  }
  std::vector<double> errors(count - 2);
  for (std::size_t i = 1; i + 1 < count; ++i) {
    errors[i - 1] = std::max({misses[i - 1], misses[i], misses[i + 1]});
  }
  return errors;
}

} // namespace duet
