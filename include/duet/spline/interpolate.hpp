// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/core/compiler/refused.hpp>
#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/spline/blocks/products.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/curve_ends.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/equations/cubic.hpp>
#include <duet/spline/equations/curve_equations.hpp>
#include <duet/spline/equations/newton.hpp>
#include <duet/spline/equations/rotation_vector_cubic.hpp>
#include <duet/spline/equations/rotation_vector_quintic.hpp>
#include <duet/spline/hermite.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/refused_rows.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Curves through given rotations or poses, of every kind and with every end, Hermite ones
/// included.

namespace duet {

/// How an interpolation went.
struct fit_report {
  int iterations = 0; ///< of Newton's method
  /// Of a cumulative curve by how much it misses a turn from one row to the next, rad; of rotation
  /// vectors by how much its equations are missed, rad per step and its powers.
  double residual = 0;
  double largest_step = 0; ///< the largest turn from one row to the next, rad

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("iterations", iterations);
    f("residual", residual);
    f("largest_step", largest_step);
  }
};

namespace detail {

/// The solution over T by that of the real parts: one step with their Jacobian for every order of
/// infinitesimals, and one more that takes back what rounding did to the last.
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

/// The last row as the first one again.
/// \throws invalid_row where it is another
template <class T>
[[nodiscard]] DUET_COLD DUET_OUT_OF_LINE std::vector<quaternion<T>>
closed(std::vector<quaternion<T>> q) {
  using std::sqrt;
  const bool is_opposite = innermost(dot(q.front(), q.back())) < 0;
  const quaternion<T> again = is_opposite ? -q.front() : q.front();
  const vector3<T> half = turn_vector(quaternion<T>(conj(again) * q.back()));
  const auto tolerance = sqrt(std::numeric_limits<real_type_t<T>>::epsilon());
  const auto check = [&](const auto& x, const char* unit) {
    using R = real_type_t<T>;
    const R off = 2 * length(vector3<R>(innermost(x[0]), innermost(x[1]), innermost(x[2])));
    if (!(off <= tolerance)) {
      raise(invalid_row(q.size() - 1, message("periodic ends: differs from row 0 by ", off, unit,
                                              ", but must repeat it")));
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

/// The scalar of a curve of type `Spline` through rows over T.
template <class Spline, class T>
struct scalar_of_curve {
  using type = T;
};
template <class Spline, class T>
  requires requires { typename Spline::scalar_type; }
struct scalar_of_curve<Spline, T> {
  using type = typename Spline::scalar_type;
};
template <class Spline, class T>
using scalar_of_curve_t = typename scalar_of_curve<Spline, T>::type;

/// Rows over T are those of a curve of type `Spline`, or constants for its numbers with
/// derivatives.
template <class T, class Spline>
concept RowOf =
    std::same_as<promote_t<scalar_of_curve_t<Spline, T>, T>, scalar_of_curve_t<Spline, T>> &&
    contains_tag<scalar_of_curve_t<Spline, T>, screw_tag>()
== contains_tag<T, screw_tag>() &&
    std::same_as<real_type_t<scalar_of_curve_t<Spline, T>>, real_type_t<T>>;

template <class Spline, class T>
[[nodiscard]] auto over_scalar_of_curve(const std::vector<quaternion<T>>& rows) {
  return std::vector<quaternion<scalar_of_curve_t<Spline, T>>>(rows.begin(), rows.end());
}

/// The curve of type `Spline` through the rows.
template <CurveType Spline, class T>
[[nodiscard]] Spline curve_through(const std::vector<real_type_t<T>>& parameters,
                                   std::vector<quaternion<T>> q, const curve_ends<T>& ends,
                                   fit_report* report) {
  constexpr bool is_curve = requires { typename equations_of_t<Spline>; };
  static_assert(is_curve, "duet: interpolate makes cumulative_bspline<T>, a cubic, and "
                          "rotation_vector_spline<T>, or <T, 6>, a quintic");
  if constexpr (is_curve) {
    using R = real_type_t<T>;
    using equations = equations_of_t<Spline, T>;
    static_assert(CurveEquations<equations>);
    if (Spline::order < 6 && ends.kind == end_kind::velocity_and_acceleration) {
      raise(invalid_input(
          "duet: interpolate: a cubic's ends take velocities or accelerations, not both"));
    }
    check_rows("interpolate", parameters, q.size(), equations::least_rows(ends.kind));
    q = aligned_orientations(std::move(q));
    if (ends.kind == end_kind::periodic) {
      q = closed(std::move(q));
    }
    const equations all(parameters, q, ends);
    const auto curve = [&](auto& newton, const auto& solution) {
      if (report != nullptr) {
        *report = {newton.iterations(), 2 * double(newton.residual()),
                   double(all.largest_turn().first)};
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

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE class cubic_equations<double>;
DUET_COMPILED_TEMPLATE class rotation_vector_cubic_equations<double>;
DUET_COMPILED_TEMPLATE class rotation_vector_quintic_equations<double>;
DUET_COMPILED_TEMPLATE class spline_newton<cubic_equations<double>>;
DUET_COMPILED_TEMPLATE class spline_newton<rotation_vector_cubic_equations<double>>;
DUET_COMPILED_TEMPLATE class spline_newton<rotation_vector_quintic_equations<double>>;
DUET_COMPILED_TEMPLATE cumulative_bspline<double> curve_through(const std::vector<double>&,
                                                                std::vector<quaternion<double>>,
                                                                const curve_ends<double>&,
                                                                fit_report*);
DUET_COMPILED_TEMPLATE rotation_vector_spline<double> curve_through(const std::vector<double>&,
                                                                    std::vector<quaternion<double>>,
                                                                    const curve_ends<double>&,
                                                                    fit_report*);
DUET_COMPILED_TEMPLATE rotation_vector_spline<double, 6>
curve_through(const std::vector<double>&, std::vector<quaternion<double>>,
              const curve_ends<double>&, fit_report*);
DUET_COMPILED_TEMPLATE cumulative_bspline<screw_dual<double>>
curve_through(const std::vector<double>&, std::vector<quaternion<screw_dual<double>>>,
              const curve_ends<screw_dual<double>>&, fit_report*);
DUET_COMPILED_TEMPLATE rotation_vector_spline<screw_dual<double>>
curve_through(const std::vector<double>&, std::vector<quaternion<screw_dual<double>>>,
              const curve_ends<screw_dual<double>>&, fit_report*);
DUET_COMPILED_TEMPLATE rotation_vector_spline<screw_dual<double>, 6>
curve_through(const std::vector<double>&, std::vector<quaternion<screw_dual<double>>>,
              const curve_ends<screw_dual<double>>&, fit_report*);
#endif

} // namespace detail

/// The curve of type `Spline` with S(u_i) = Q_i: `cumulative_bspline<T>`, the cubic of P2, C²;
/// `rotation_vector_spline<T>`, the cubic of rotation vectors, C²; `rotation_vector_spline<T, 6>`,
/// the quintic, C⁴. T is any scalar.
///
/// \param parameters    u_0 < u_1 < …, uniform or not
/// \param orientations  unit quaternions, or poses; signs are aligned first. Where T is a number
/// with
///                      derivatives, rows over its real numbers are constants
/// \param ends          as below
///
/// | ends | cubics | quintic |
/// |---|---|---|
/// | `natural` | no acceleration | no acceleration, no snap |
/// | `clamped` | given velocity | given velocity; fifth derivative continuous at the next knot |
/// | `end_acceleration` | given acceleration | given acceleration; fifth derivative likewise |
/// | `fully_clamped` | | given velocity and acceleration |
/// | `not_a_knot` | jerk continuous at the next knot | fifth derivative at the next two |
/// | `periodic` | as smooth as inside | as smooth as inside |
///
/// Unknown are the increments of P2, or the rates at the knots. Their real parts are found by
/// Newton's method, O(n) a step; where neighbouring rows are far apart, by
/// continuation from smaller turns. Infinitesimal parts, those of poses and of derivatives with
/// respect to the data among them, follow from the equations by linear solves, one each and one
/// more, to rounding. Against smooth motion and with ends that fit it, the cumulative cubic is
/// third-order accurate in value, second in velocity, first in acceleration; the cubic of rotation
/// vectors an order more; the quintic sixth, fifth and fourth.
/// \throws invalid_row for a row that no curve can go through; invalid_input where there are too
/// few rows (not_a_knot takes as many as the order, periodic ends three, clamped and accelerated
/// quintics four), the counts differ or an end rate is not finite; no_convergence where no curve
/// was found: neighbours very far apart, or parameters too uneven for the ends
template <CurveType Spline, detail::RowOf<Spline> T>
[[nodiscard]] Spline
interpolate(const std::vector<real_type_t<T>>& parameters,
            const std::vector<quaternion<T>>& orientations,
            const std::type_identity_t<curve_ends<detail::scalar_of_curve_t<Spline, T>>>& ends =
                natural{}) {
  return detail::curve_through<Spline>(
      parameters, detail::over_scalar_of_curve<Spline>(orientations), ends, nullptr);
}
/// The curve with S(u_i) = Q_i, and how it went.
template <CurveType Spline, detail::RowOf<Spline> T>
[[nodiscard]] Spline
interpolate(const std::vector<real_type_t<T>>& parameters,
            const std::vector<quaternion<T>>& orientations,
            const std::type_identity_t<curve_ends<detail::scalar_of_curve_t<Spline, T>>>& ends,
            fit_report& report) {
  return detail::curve_through<Spline>(
      parameters, detail::over_scalar_of_curve<Spline>(orientations), ends, &report);
}

/// Rotations for a curve of poses, or the other way round.
template <CurveType Spline, class T, class... More>
  requires(!detail::RowOf<T, Spline>)
DUET_REFUSED("interpolate: the curve is over another scalar than the rows: rotations make a "
             "cumulative_bspline<double>, poses a cumulative_bspline<dual<double, 1, screw_tag>>")
Spline interpolate(const std::vector<real_type_t<T>>&, const std::vector<quaternion<T>>&,
                   const More&...);

DUET_REFUSES_ROWS(interpolate, detail::itself, "(parameters, rows)")

} // namespace duet
