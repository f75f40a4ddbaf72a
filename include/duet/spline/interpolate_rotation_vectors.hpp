// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/rotation_vector_cubic_equations.hpp>
#include <duet/spline/rotation_vector_ends.hpp>
#include <duet/spline/rotation_vector_quintic_equations.hpp>
#include <duet/spline/rotation_vector_spline.hpp>
#include <duet/spline/spline_newton.hpp>

#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Rotation-vector splines through given rotations or poses.

namespace duet {
namespace detail {

template <class Spline>
inline constexpr bool is_rotation_vector_spline = false;
template <class T, int Order>
inline constexpr bool is_rotation_vector_spline<rotation_vector_spline<T, Order>> = true;

template <class T, int Order>
using rotation_vector_equations = std::conditional_t<Order == 4, rotation_vector_cubic_equations<T>,
                                                     rotation_vector_quintic_equations<T>>;

template <class Spline, class T, class Ends>
[[nodiscard]] Spline interpolate_rotation_vectors(const std::vector<real_type_t<T>>& parameters,
                                                  std::vector<quaternion<T>> q, const Ends& ends,
                                                  fit_report* report) {
  using R = real_type_t<T>;
  constexpr int order = Spline::order;
  check_rows(parameters, q.size(), rotation_vector_ends<T, order>::least_rows(ends));
  ends.check();
  q = aligned_orientations(std::move(q));
  if constexpr (std::is_same_v<Ends, periodic>) {
    q = closed(std::move(q));
  }
  const rotation_vector_ends<T, order> conditions(ends, q.front(), q.back());
  const rotation_vector_equations<T, order> equations(parameters, q, conditions);
  const auto curve = [&](auto& newton, const auto& solution) {
    if (report != nullptr) {
      *report = {newton.iterations(), 2 * double(newton.residual()),
                 double(equations.largest_turn().first)};
    }
    return Spline::from_pieces(parameters, std::move(q), equations.polynomials(solution));
  };
  if constexpr (Real<T>) {
    spline_newton newton(equations);
    return curve(newton, newton.solution());
  } else {
    std::vector<quaternion<R>> rotations;
    rotations.reserve(q.size());
    for (const quaternion<T>& each : q) {
      rotations.push_back(innermost_of(each));
    }
    const rotation_vector_equations<R, order> real(parameters, rotations, conditions.real_part());
    spline_newton newton(real);
    return curve(newton, lifted_solution(equations, newton));
  }
}

} // namespace detail

/// The curve of rotation vectors through S(u_i) = Q_i: of order 4 C², of order 6 C⁴ at all u_i.
///
/// \param parameters    u_0 < u_1 < …, uniform or not
/// \param orientations  unit quaternions, or poses; signs are aligned first
/// \param ends          as below
///
/// | ends | cubic | quintic |
/// |---|---|---|
/// | `natural` | no acceleration | no acceleration, no snap |
/// | `clamped` | given velocity | given velocity; fifth derivative continuous at the next knot |
/// | `end_acceleration` | given acceleration | given acceleration; fifth derivative likewise |
/// | `fully_clamped` | | given velocity and acceleration |
/// | `not_a_knot` | jerk continuous at the next knot | fifth derivative at the next two |
/// | `periodic` | as smooth as inside | as smooth as inside |
///
/// Unknown are the rates at the knots. Their real parts are found by Newton's method with AD
/// Jacobian, O(n) a step, where neighbouring rows are far apart by continuation from smaller turns.
/// Infinitesimal parts, those of poses and of derivatives with respect to the data among them,
/// follow from the equations by one linear solve each, to rounding. Against smooth motion and with
/// ends that fit it, the cubic is fourth-order accurate in value, third in velocity, second in
/// acceleration; the quintic sixth, fifth and fourth.
/// \throws invalid_row for a row that no curve can go through; invalid_input where there are too
/// few rows (not_a_knot takes as many as the order, clamped and accelerated quintics four), the
/// counts differ or an end rate is not finite; no_convergence where no curve was found:
/// neighbours very far apart, or parameters too uneven for the ends
template <class Spline, class T, class Ends = natural>
  requires detail::is_rotation_vector_spline<Spline>
[[nodiscard]] Spline interpolate(const std::vector<real_type_t<T>>& parameters,
                                 const std::vector<quaternion<T>>& orientations,
                                 const Ends& ends = {}) {
  return detail::interpolate_rotation_vectors<Spline>(parameters, orientations, ends, nullptr);
}
/// The curve of rotation vectors through S(u_i) = Q_i, and how it went; the residual is that of the
/// equations, in rad per step and its powers.
template <class Spline, class T, class Ends>
  requires detail::is_rotation_vector_spline<Spline>
[[nodiscard]] Spline interpolate(const std::vector<real_type_t<T>>& parameters,
                                 const std::vector<quaternion<T>>& orientations, const Ends& ends,
                                 fit_report& report) {
  return detail::interpolate_rotation_vectors<Spline>(parameters, orientations, ends, &report);
}

} // namespace duet
