// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/refused.hpp>
#include <duet/core/errors.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/fit_options.hpp>
#include <duet/spline/fitting/bspline_fit.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/knots.hpp>
#include <duet/spline/orientations.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Least-squares fit of curves to rotations or poses: fewer control points than samples, noise
/// smoothed out.

namespace duet {

/// Fitted curve and the distances of the samples from it.
template <CurveType Spline>
struct fit_result {
  using real_type = typename Spline::real_type;
  Spline curve; ///< fitted curve, with the given knots
  /// Residual |2 log(S(uᵢ)* Qᵢ)| of each sample: in radians; for poses the root of the sum of
  /// squares of the angle and (distance/characteristic length); with `fit_options::covariances` in
  /// standard deviations.
  std::vector<real_type> residuals;
  real_type rms;  ///< root of the weighted mean square of `residuals`, outliers included
  int iterations; ///< number of Levenberg–Marquardt iterations
  real_type
      outlier_threshold; ///< outlier threshold in effect: larger residuals counted as outliers

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("residuals", residuals);
    f("rms", rms);
    f("iterations", iterations);
    f("outlier_threshold", outlier_threshold);
  }
};

namespace detail {

/// \throws invalid_input unless there are no weights, or one for each sample, positive and finite
inline void require_fit_weights(const std::vector<double>& weights, std::size_t samples) {
  require(weights.empty() || weights.size() == samples, "duet: fit: ", weights.size(),
          " weights for ", samples, " samples");
  for (std::size_t i = 0; i < weights.size(); ++i) {
    require(weights[i] > 0 && weights[i] <= std::numeric_limits<double>::max(),
            "duet: fit: weight ", i, " is ", weights[i],
            " (expected a finite positive number; omit samples that should not count)");
  }
}

/// Checks the Schoenberg–Whitney condition: every control point needs a separate sample where its
/// basis function is not zero, or it would be arbitrary.
///
/// \param counts  counts(i) is true if sample i counts
/// \param advice  remedy, for the message
/// \throws invalid_input if the condition is violated
template <int Order, Real R, class Counts>
void require_samples_for_control_points(const bspline_basis<Order, R>& basis,
                                        const std::vector<R>& u, const Counts& counts,
                                        const char* advice) {
  const std::vector<R>& knots = basis.knots();
  std::size_t sample = 0;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const R low = knots[i];
    const R high = knots[i + std::size_t(Order)];
    const auto is_inside = [&](std::size_t k) {
      const R& x = u[k];
      return counts(k) && ((x > low && x < high) || (x == low && i == 0) ||
                           (x == high && i + 1 == basis.size()));
    };
    while (sample < u.size() && u[sample] < high && !is_inside(sample)) {
      ++sample;
    }
    if (sample == u.size() || !is_inside(sample)) {
      std::ostringstream message;
      message << "duet: fit: there are too few samples for control point " << i
              << ", which acts on parameters from " << low << " to " << high << " (" << advice
              << ")";
      raise(invalid_input(message.str()));
    }
    ++sample;
  }
}

} // namespace detail

/// Fits a curve of type `Spline` with given knots to rotations or poses.
///
/// Minimises Σ wᵢ ρ(|2 log(S(uᵢ)* Qᵢ)|) over the control points by damped least squares
/// (Levenberg–Marquardt). ρ is Huber's loss, ρ(r) = ½ r² up to the outlier threshold
/// `options.outlier_threshold`; samples far beyond it do not count. wᵢ are `options.weights`;
/// residuals are whitened by `options.covariances` if there are any.
///
/// Time and memory are linear in the number of samples. The signs of the samples do not matter.
///
/// \param knots  knots of the curve, for example `knots_every(parameters, 10, Order)`, or those of
///               chosen parameters, `clamped_knots(few_parameters, Order)`; fewer knots smooth more
/// \throws invalid_sample for a sample that is not finite, not a unit, outside the knots' domain or
/// does not follow the sample before
/// \throws invalid_input for counts that differ, too few samples on part of the domain, a
/// characteristic length or weight that is not positive, a negative outlier threshold, or a
/// covariance that is not positive definite
/// \throws no_convergence if the iteration does not converge
template <CurveType Spline, class R, detail::SampleOf<Spline> T>
[[nodiscard]] fit_result<Spline> fit(std::vector<R> parameters, std::vector<quaternion<T>> samples,
                                     std::vector<R> knots, const fit_options& options = {}) {
  static_assert(std::is_same_v<Spline, cumulative_bspline<T, Spline::order>> &&
                    std::is_same_v<R, real_type_t<T>>,
                "duet: fit makes cumulative_bspline<T, Order> from quaternion<T>");
  std::ostringstream message;
  detail::check_samples("fit", parameters, samples.size(), 0);
  if (!(options.characteristic_length > 0) || !(options.outlier_threshold >= 0)) {
    message << "duet: fit: characteristic_length is " << options.characteristic_length
            << " and outlier_threshold is " << options.outlier_threshold
            << " (expected a positive length and a non-negative threshold)";
    detail::raise(invalid_input(message.str()));
  }
  detail::require_fit_weights(options.weights, samples.size());
  const bspline_basis<Spline::order, R> basis(std::move(knots));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!basis.contains(parameters[i])) {
      parameters[i] = basis.rounded_into_domain(parameters[i]);
    }
    if (!basis.contains(parameters[i])) {
      message << "parameter " << detail::all_digits(parameters[i])
              << " is outside the knots' domain, " << detail::all_digits(basis.front()) << " to "
              << detail::all_digits(basis.back()) << " (clamped_knots of parameters from "
              << parameters.front() << " to " << parameters.back() << " have all samples in it)";
      detail::raise(invalid_sample(i, message.str()));
    }
  }
  detail::require_samples_for_control_points(
      basis, parameters, [](std::size_t) { return true; }, "use fewer knots there");
  detail::bspline_fit<T, Spline::order> problem(
      basis, parameters, normalized_quaternions(std::move(samples)), options);
  detail::require_samples_for_control_points(
      basis, parameters, [&](std::size_t i) { return problem.counts(i); },
      "the others are outliers; use fewer knots there");
  const int iterations = problem.solve();
  const std::vector<R> residuals = problem.residuals();
  using std::sqrt;
  const R largest = *std::max_element(residuals.begin(), residuals.end());
  R squares(0), weights(0); // of residuals relative to the largest, so that they do not overflow
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const R ratio = largest > 0 ? R(residuals[i] / largest) : R(0);
    const R weight = options.weights.empty() ? R(1) : R(options.weights[i]);
    squares += weight * (ratio * ratio);
    weights += weight;
  }
  const R rms = largest - largest == 0 ? R(largest * sqrt(squares / weights)) : largest;
  return {problem.curve(basis), residuals, rms, iterations, problem.outlier_threshold()};
}

/// Rejected: rotations for a curve of poses, or poses for a curve of rotations.
template <CurveType Spline, class R, class T, class... More>
  requires(!detail::SampleOf<T, Spline>)
DUET_REFUSED("fit: the scalar of the curve differs from that of the samples: rotations make a "
             "cumulative_bspline<double>, poses a cumulative_bspline<dual<double, 1, screw_tag>>")
fit_result<Spline> fit(const std::vector<R>&, const std::vector<quaternion<T>>&,
                       const std::vector<R>&, const More&...);
DUET_REFUSES_ROWS(fit, fit_result, "(parameters, samples, knots)")
template <CurveType Spline, class U, class T>
DUET_REFUSED("fit: the knots are missing: fit<Curve>(parameters, samples, clamped_knots(breaks, "
             "4))")
fit_result<Spline> fit(const U&, const std::vector<quaternion<T>>&);
template <CurveType Spline, class U, class T>
DUET_REFUSED("fit: the knots are missing: fit<Curve>(parameters, samples, clamped_knots(breaks, "
             "4), options)")
fit_result<Spline> fit(const U&, const std::vector<quaternion<T>>&, const fit_options&);

} // namespace duet
