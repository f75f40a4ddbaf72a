// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/spline/cubic_ends.hpp>
#include <duet/spline/cubic_equations.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/spline_newton.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <sstream>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Curves through given rotations or poses: the control elements of P2 are solved for.

namespace duet {

/// How an interpolation went.
struct fit_report {
  int iterations = 0;      ///< of Newton's method
  double residual = 0;     ///< by how much the curve misses a turn from one row to the next, rad
  double largest_step = 0; ///< the largest turn from one row to the next, rad
};

namespace detail {

/// The solution over T by that of the real parts: one step with their Jacobian for every order of
/// infinitesimals.
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
  for (int order = 1; order <= scalar_traits<T>::order; ++order) {
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
[[nodiscard]] std::vector<quaternion<T>> closed(std::vector<quaternion<T>> q) {
  using std::sqrt;
  const bool is_opposite = innermost(dot(q.front(), q.back())) < 0;
  const quaternion<T> again = is_opposite ? -q.front() : q.front();
  const vector3<T> half = log_vector(quaternion<T>(conj(again) * q.back()), "interpolate");
  const auto tolerance = sqrt(std::numeric_limits<real_type_t<T>>::epsilon());
  const auto check = [&](const auto& x, const char* unit) {
    using R = real_type_t<T>;
    const R off = 2 * vector3<R>(innermost(x[0]), innermost(x[1]), innermost(x[2])).norm();
    if (!(off <= tolerance)) {
      std::ostringstream reason;
      reason << "periodic ends: differs from row 0 by " << off << unit << ", but must repeat it";
      throw invalid_row(q.size() - 1, reason.str());
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

template <class T>
[[nodiscard]] cumulative_bspline<T, 4>
interpolate_cubic(const std::vector<real_type_t<T>>& parameters, std::vector<quaternion<T>> q,
                  const cubic_ends<T>& ends, fit_report* report) {
  check_rows(parameters, q.size(), ends.least_rows());
  q = aligned_orientations(std::move(q));
  if (ends.kind == end_kind::periodic) {
    q = closed(std::move(q));
  }
  cubic_equations<T> equations(parameters, q, ends);
  const auto curve = [&](auto&& newton, const auto& solution) {
    if (report != nullptr) {
      *report = {newton.iterations(), 2 * double(newton.residual()),
                 double(equations.largest_turn().first)};
    }
    std::vector<vector3<T>> increments = equations.increments(solution);
    std::vector<quaternion<T>> controls = equations.controls(increments);
    return cumulative_bspline<T, 4>(std::move(equations).basis(), std::move(controls),
                                    std::move(increments));
  };
  if constexpr (Real<T>) {
    spline_newton newton(equations);
    return curve(newton, newton.solution());
  } else {
    using R = real_type_t<T>;
    std::vector<quaternion<R>> rotations;
    rotations.reserve(q.size());
    for (const quaternion<T>& each : q) {
      rotations.push_back(innermost_of(each));
    }
    const cubic_equations<R> real(parameters, std::move(rotations), ends.real_part());
    spline_newton newton(real);
    return curve(newton, lifted_solution(equations, newton));
  }
}

} // namespace detail

/// The cubic curve with S(u_i) = Q_i, C² at all u_i.
///
/// \param parameters    u_0 < u_1 < …, uniform or not
/// \param orientations  unit quaternions, or poses; signs are aligned first
/// \param ends          `natural{}`, `clamped{…}`, `end_acceleration{…}`, `not_a_knot{}` (four rows
///                      or more) or `periodic{}` (three or more, the last one the first again)
///
/// Spline is `cumulative_bspline<T, 4>`, T any scalar. The real increments of the rotations are
/// found by Newton's method with AD Jacobian, O(n) a step; where neighbouring rows are far apart,
/// by continuation from smaller turns. Infinitesimal parts, those of poses and those of derivatives
/// with respect to the data among them, follow from the equations by one linear solve each, to
/// rounding. Against smooth motion the cubic is third-order accurate in value, second in velocity,
/// first in acceleration.
/// \throws invalid_row for a row that no curve can go through; invalid_input where there are too
/// few rows, the counts differ or an end rate is not finite; no_convergence where no curve was
/// found: neighbours very far apart, or parameters too uneven for the ends
template <class Spline, class T, class Ends = natural>
  requires std::same_as<Spline, cumulative_bspline<T, 4>>
[[nodiscard]] Spline interpolate(const std::vector<real_type_t<T>>& parameters,
                                 const std::vector<quaternion<T>>& orientations,
                                 const Ends& ends = {}) {
  ends.check();
  return detail::interpolate_cubic(parameters, orientations, detail::cubic_ends<T>(ends), nullptr);
}
/// The cubic curve with S(u_i) = Q_i, and how it went.
template <class Spline, class T, class Ends>
  requires std::same_as<Spline, cumulative_bspline<T, 4>>
[[nodiscard]] Spline interpolate(const std::vector<real_type_t<T>>& parameters,
                                 const std::vector<quaternion<T>>& orientations, const Ends& ends,
                                 fit_report& report) {
  ends.check();
  return detail::interpolate_cubic(parameters, orientations, detail::cubic_ends<T>(ends), &report);
}

/// Rows over another scalar than the curve's.
template <class Spline, class T, class Ends = natural>
  requires(!std::same_as<typename Spline::scalar_type, T>)
Spline interpolate(const std::vector<real_type_t<T>>&, const std::vector<quaternion<T>>&,
                   const Ends& = {}) {
  static_assert(std::same_as<typename Spline::scalar_type, T>,
                "duet: interpolate: the curve is over another scalar than the rows: rotations make "
                "a cumulative_bspline<double>, poses a "
                "cumulative_bspline<dual<double, 1, screw_tag>>");
}

} // namespace duet
