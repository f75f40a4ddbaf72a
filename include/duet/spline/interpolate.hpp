// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/blocks.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/equations/cubic.hpp>
#include <duet/spline/equations/newton.hpp>
#include <duet/spline/equations/rotation_vector.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// Interpolation of rotations and poses by cubic and quintic curves with every kind of end
/// conditions; Hermite curves included.

namespace duet {

/// Report of an interpolation.
struct interpolation_report {
  int iterations = 0; ///< number of Newton iterations
  /// Largest residual. Cumulative curves: error of the rotation between neighbouring samples, rad.
  /// Rotation-vector curves: error of the equations, rad per step and its powers.
  double residual = 0;
  double largest_step = 0; ///< largest rotation angle between neighbouring samples, rad

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("iterations", iterations);
    f("residual", residual);
    f("largest_step", largest_step);
  }
};

namespace detail {

/// Solution over T, lifted from the solution over the real numbers: one Newton step with the real
/// Jacobian for each order of infinitesimals, and one more that removes the round-off of the last
/// step.
template <class Equations, class Newton>
[[nodiscard]] typename Equations::unknowns lifted_solution(const Equations& equations,
                                                           Newton& newton) {
  using unknowns = typename Equations::unknowns;
  using T = typename unknowns::value_type::Scalar;
  unknowns x;
  x.reserve(newton.solution().size());
  for (const auto& each : newton.solution()) {
    x.push_back(each.template cast<T>());
  }
  const auto& jacobian = newton.jacobian();
  unknowns step;
  for (int order = 1; order <= scalar_traits<T>::order + 1; ++order) {
    equations.residuals(x, step);
    jacobian.solve(step);
    for (std::size_t k = 0; k < x.size(); ++k) {
      x[k] -= step[k];
    }
  }
  return x;
}

/// Replaces the last sample by the first, which it must repeat.
///
/// \throws invalid_sample if the two differ
template <class T>
[[nodiscard]] DUET_COLD DUET_OUT_OF_LINE std::vector<quaternion<T>>
closed(std::vector<quaternion<T>> q) {
  using std::sqrt;
  const bool is_opposite = innermost(dot(q.front(), q.back())) < 0;
  const quaternion<T> again = is_opposite ? -q.front() : q.front();
  const vector3<T> half = log_out_of_line(quaternion<T>(conj(again) * q.back()));
  const auto tolerance = sqrt(std::numeric_limits<real_type_t<T>>::epsilon());
  const auto check = [&](const auto& x, const char* unit) {
    using R = real_type_t<T>;
    const R off = 2 * length(vector3<R>(innermost(x[0]), innermost(x[1]), innermost(x[2])));
    if (!(off <= tolerance)) {
      raise(invalid_sample(q.size() - 1, message("periodic ends: differs from sample 0 by ", off,
                                                 unit, ", but must repeat it")));
    }
  };
  if constexpr (contains_tag<T, screw_tag>()) {
    check(real_part(half), " rad");
    check(dual_part(half), " in translation");
  } else {
    check(half, " rad");
  }
  q.back() = again;
  return q;
}

/// True if samples over T fit a curve of type `Spline`: T is its scalar, or its scalar has
/// derivatives and T holds constants.
template <class T, class Spline, class S = typename Spline::scalar_type>
concept SampleOf = std::same_as<promote_t<S, T>, S> &&
    std::same_as<real_type_t<S>, real_type_t<T>> &&
    (contains_tag<S, screw_tag>() == contains_tag<T, screw_tag>());

template <class Spline, class T>
[[nodiscard]] auto over_scalar_of_curve(const std::vector<quaternion<T>>& samples) {
  return std::vector<quaternion<typename Spline::scalar_type>>(samples.begin(), samples.end());
}

/// Interpolates the samples by a curve of type `Spline`; reports if `report` is not null.
template <CurveType Spline, class T>
[[nodiscard]] Spline curve_through(const std::vector<real_type_t<T>>& parameters,
                                   std::vector<quaternion<T>> q, const curve_ends<T>& ends,
                                   interpolation_report* report) {
  constexpr bool is_curve = requires { typename equations_of_t<Spline>; };
  static_assert(is_curve, "duet: interpolate makes cumulative_bspline<T>, a cubic, and "
                          "rotation_vector_spline<T>, or <T, 6>, a quintic");
  if constexpr (is_curve) {
    using R = real_type_t<T>;
    using equations = equations_of_t<Spline, T>;
    static_assert(CurveEquations<equations>);
    if (Spline::order < 6 && ends.kind == end_condition_kind::velocity_and_acceleration) {
      raise(invalid_input(
          "duet: interpolate: fully_clamped ends need a quintic (a cubic can meet velocities or "
          "accelerations, not both)"));
    }
    check_samples("interpolate", parameters, q.size(), equations::min_samples(ends.kind));
    q = align_quaternion_signs(std::move(q));
    if (ends.kind == end_condition_kind::periodic) {
      q = closed(std::move(q));
    }
    const equations all(parameters, q, ends);
    const auto curve = [&](auto& newton, const auto& solution) {
      if (report != nullptr) {
        *report = {newton.iterations(), 2 * double(newton.residual()),
                   double(all.max_rotation().first)};
      }
      return all.curve(parameters, std::move(q), solution);
    };
    if constexpr (Real<T>) {
      spline_newton newton(all);
      return curve(newton, newton.solution());
    } else {
      std::vector<quaternion<R>> rotations;
      rotations.reserve(q.size());
      for (const quaternion<T>& each : q) {
        rotations.push_back(innermost_of(each));
      }
      const equations_of_t<Spline, R> real(parameters, rotations, ends.real_part());
      spline_newton newton(real);
      return curve(newton, lifted_solution(all, newton));
    }
  }
}

template <class X>
using itself = X;

template <class X>
inline constexpr bool is_standard_vector = false;
template <class X, class Allocator>
inline constexpr bool is_standard_vector<std::vector<X, Allocator>> = true;

} // namespace detail

/// Interpolates rotations or poses: the curve of type `Spline` with S(u_i) = Q_i. `Spline` is
/// `cumulative_bspline<T>`, the cubic of P2, C²; `rotation_vector_spline<T>`, the cubic of rotation
/// vectors, C²; or `rotation_vector_spline<T, 6>`, the quintic, C⁴. T is any scalar.
///
/// \param parameters    u_0 < u_1 < …, uniform or not
/// \param orientations  data points Q_i, unit quaternions or poses; signs are aligned first. If T
///                      is a number with derivatives, data points over its real numbers are
///                      constants
/// \param ends          end conditions, see the table; default `natural{}`
///
/// | ends | cubics | quintic |
/// |---|---|---|
/// | `natural` | no acceleration | no acceleration, no snap |
/// | `clamped` | given velocity | given velocity; (a) |
/// | `end_acceleration` | given acceleration | given acceleration; (a) |
/// | `fully_clamped` | | given velocity and acceleration |
/// | `not_a_knot` | jerk continuous at the next knot | (a), at the next two knots |
/// | `periodic` | as smooth as inside | as smooth as inside |
///
/// (a): fifth derivative continuous at the next knot.
///
/// The unknowns are the increments of P2, or the rates at the knots. Their real parts are found by
/// Newton's method, O(n) per step, and if neighbouring data points are far apart, by continuation
/// from smaller rotations. Infinitesimal parts, including those of poses and of derivatives with
/// respect to the data, follow to round-off by linear solves, one for each order and one more. For
/// smooth motion and end conditions that fit it, the cumulative cubic is third-order accurate in
/// value, second in velocity, first in acceleration; the cubic of rotation vectors one order more;
/// the quintic sixth, fifth and fourth.
///
/// \throws invalid_sample for a data point that no curve can pass through
/// \throws invalid_input for too few data points (`not_a_knot` needs as many as the order, periodic
/// ends three, clamped and accelerated quintics four), counts that differ, or an end velocity or
/// acceleration that is not finite
/// \throws no_convergence if no curve was found: neighbours very far apart, or parameters too
/// uneven for the end conditions
template <CurveType Spline, detail::SampleOf<Spline> T>
[[nodiscard]] Spline interpolate(const std::vector<real_type_t<T>>& parameters,
                                 const std::vector<quaternion<T>>& orientations,
                                 const curve_ends<typename Spline::scalar_type>& ends = natural{}) {
  return detail::curve_through<Spline>(
      parameters, detail::over_scalar_of_curve<Spline>(orientations), ends, nullptr);
}
/// Interpolates as above, with a report of the iteration.
template <CurveType Spline, detail::SampleOf<Spline> T>
[[nodiscard]] Spline interpolate(const std::vector<real_type_t<T>>& parameters,
                                 const std::vector<quaternion<T>>& orientations,
                                 const curve_ends<typename Spline::scalar_type>& ends,
                                 interpolation_report& report) {
  return detail::curve_through<Spline>(
      parameters, detail::over_scalar_of_curve<Spline>(orientations), ends, &report);
}

/// Rejected: rotations for a curve of poses, or poses for a curve of rotations.
template <CurveType Spline, class T, class... More>
  requires(!detail::SampleOf<T, Spline>)
DUET_REFUSED(
    "interpolate: the scalar of the curve differs from that of the samples: rotations make a "
    "cumulative_bspline<double>, poses a cumulative_bspline<dual<double, 1, screw_tag>>")
Spline interpolate(const std::vector<real_type_t<T>>&, const std::vector<quaternion<T>>&,
                   const More&...);

/// Declares rejected overloads of `function<Spline>` for arguments other than those shown;
/// `result<Spline>` is the type of its result.
#define DUET_REFUSES_ROWS(function, result, arguments)                                             \
  template <CurveType Spline, class U, detail::ForeignRows Rows, class... More>                    \
  DUET_REFUSED_FOREIGN_ROWS(function)                                                              \
  result<Spline> function(const U&, const Rows&, const More&...);                                  \
  template <CurveType Spline, class U, class Rows, class... More>                                  \
    requires(!detail::ForeignRows<Rows> &&                                                         \
             (!detail::is_standard_vector<U> || !detail::is_standard_vector<Rows>))                \
  DUET_REFUSED(#function " takes standard vectors: std::vector<double> of parameters, "            \
                         "std::vector<quaternion<double>> of samples")                             \
  result<Spline> function(const U&, const Rows&, const More&...);                                  \
  template <CurveType Spline, class T>                                                             \
  DUET_REFUSED(#function ": the parameters are missing: " #function "<Curve>" arguments)           \
  result<Spline> function(const std::vector<quaternion<T>>&);                                      \
  template <CurveType Spline, class T, class Other, class... More>                                 \
  DUET_REFUSED(#function ": the parameters come first: " #function "<Curve>" arguments)            \
  result<Spline> function(const std::vector<quaternion<T>>&, const Other&, const More&...);        \
  template <class U, class T, class... More>                                                       \
    requires(!CurveType<U>)                                                                        \
  DUET_REFUSED(#function ": the type of the curve is missing: " #function                          \
                         "<cumulative_bspline<double>>" arguments)                                 \
  result<cumulative_bspline<T>> function(const U&, const std::vector<quaternion<T>>&,              \
                                         const More&...);                                          \
  template <template <class, int> class Spline, class... X>                                        \
  DUET_REFUSED(#function ": the scalar of the curve is missing: " #function                        \
                         "<cumulative_bspline<double>>" arguments)                                 \
  result<cumulative_bspline<double>>                                                               \
  function(const X&...);

DUET_REFUSES_ROWS(interpolate, detail::itself, "(parameters, samples)")

} // namespace duet
