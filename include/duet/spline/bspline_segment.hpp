// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/quaternion_order.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/bspline_span.hpp>
#include <duet/spline/knot_jacobian.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/motion_jacobian.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/product_jacobian.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

/// \file
/// One span of a cumulative B-spline curve, from control points and knots in the caller's memory.

namespace duet {

/// Basis of one span: its 2k − 2 knots and the cumulative basis functions on it. Constant while
/// control points are estimated, and costs more than an evaluation.
template <int Order, Real R = double>
class segment_basis {
public:
  static constexpr std::size_t knot_count = 2 * std::size_t(Order) - 2;

  /// \param knots  u_{i+2−k} … u_{i+k−1} of the span [u_i, u_{i+1})
  /// \throws invalid_input for knots that decrease or are not finite, and for an empty span
  segment_basis(std::span<const R, knot_count> knots)
      : weights_(bspline_span<Order, R>::from_knots(checked(knots).data())) {
    std::copy(knots.begin(), knots.end(), knots_.begin());
    detail::require(weights_.polynomials[0][std::size_t(Order) - 1] -
                            weights_.polynomials[0][std::size_t(Order) - 1] ==
                        0,
                    "duet: bspline_segment: knots are too close: a derivative overflows");
  }

  /// Knots.
  [[nodiscard]] const std::array<R, knot_count>& knots() const { return knots_; }
  /// Beginning of the span.
  [[nodiscard]] const R& front() const { return knots_[std::size_t(Order) - 2]; }
  /// End of the span.
  [[nodiscard]] const R& back() const { return knots_[std::size_t(Order) - 1]; }
  /// Cumulative basis functions on the span.
  [[nodiscard]] const bspline_span<Order, R>& weights() const { return weights_; }

private:
  static std::span<const R, knot_count> checked(std::span<const R, knot_count> knots) {
    for (std::size_t i = 0; i < knot_count; ++i) {
      detail::require(knots[i] - knots[i] == 0 && (i == 0 || knots[i - 1] <= knots[i]),
                      "duet: bspline_segment: knot ", i, " is ", knots[i],
                      " (expected finite knots that do not decrease)");
    }
    detail::require(knots[std::size_t(Order) - 2] < knots[std::size_t(Order) - 1],
                    "duet: bspline_segment: the span from ", knots[std::size_t(Order) - 2], " to ",
                    knots[std::size_t(Order) - 1], " is empty");
    return knots;
  }

  std::array<R, knot_count> knots_;
  bspline_span<Order, R> weights_;
};

/// One span of a `cumulative_bspline`: a value of fixed size without heap memory, for residuals
/// whose k control points and 2k − 2 knots are in the caller's memory.
///
/// \tparam T      scalar of the control points, as in `cumulative_bspline`
/// \tparam Order  k; 4 is the cubic
template <class T, int Order = 4>
class bspline_segment {
public:
  using scalar_type = T;
  using real_type = real_type_t<T>;
  using number = typename manifold<quaternion<T>>::scalar;
  using basis_type = segment_basis<Order, real_type>;
  static constexpr int order = Order;

  /// Constructs the segment from its control points, unit quaternions.
  ///
  /// \throws invalid_sample for a control point whose norm is not 1 to `unit_norm_tolerance`, and
  /// for one whose sign is not aligned with that of the control point before: it would be reached
  /// the long way round
  bspline_segment(std::span<const quaternion<T>, std::size_t(Order)> controls,
                  const basis_type& basis)
      : basis_(basis) {
    std::copy(controls.begin(), controls.end(), controls_.begin());
    set_increments();
  }

  /// Constructs the segment from k pointers to the numbers of control points: 4 for a rotation; for
  /// a pose 7, the translation and then the quaternion.
  template <class Number>
  bspline_segment(const Number* const* controls, quaternion_order storage_order,
                  const basis_type& basis)
      : basis_(basis) {
    for (std::size_t i = 0; i < controls_.size(); ++i) {
      const Number* x = controls[i];
      if constexpr (manifold<quaternion<T>>::dimension == 3) {
        controls_[i] = load_quaternion(x, storage_order);
      } else {
        controls_[i] =
            pose(load_quaternion(x + 3, storage_order), vector3<number>(x[0], x[1], x[2]));
      }
    }
    set_increments();
  }

  /// Value S(u).
  ///
  /// \throws invalid_input outside the span
  [[nodiscard]] quaternion<T> operator()(const real_type& u) const {
    return half_motion<0>(u).value;
  }

  /// Value and rates in the frame, as `cumulative_bspline::motion`.
  ///
  /// \throws invalid_input outside the span
  template <FrameConstant Frame>
  [[nodiscard]] auto motion(const real_type& u, Frame frame) const {
    return detail::motion_of(half_motion<3>(u), frame);
  }

  /// Motion with the Jacobians of the value and of `Rates` rates with respect to the control points
  /// and u, as `cumulative_bspline::motion_jacobian`; `first` is 0.
  ///
  /// \throws invalid_input outside the span
  template <int Rates, FrameConstant Frame>
  [[nodiscard]] curve_jacobian<T, Order, Rates, Frame>
  motion_jacobian(const real_type& u, Frame frame, perturbation side = perturbation::right) const {
    return detail::jacobian_of_product<Rates, T, factors>(
        controls_.data(), increments_.data(), basis_.weights().template at<4>(checked(u)), frame,
        side);
  }

  /// Derivatives with respect to the 2k − 2 knots, as `cumulative_bspline::knot_jacobian`.
  ///
  /// \throws invalid_input outside the span
  template <FrameConstant Frame>
  [[nodiscard]] knot_jacobian_result<T, Order>
  knot_jacobian(const real_type& u, Frame frame, perturbation side = perturbation::right) const {
    return detail::knot_jacobian_of_product<T, Order>(
        controls_.data(), increments_.data(), basis_.knots().data(), u,
        basis_.weights().template at<4>(checked(u)), frame, side);
  }

  /// Control points.
  [[nodiscard]] const std::array<quaternion<T>, std::size_t(Order)>& control_points() const {
    return controls_;
  }
  /// Increments ω_1 … ω_{k−1}, half-angle vectors.
  [[nodiscard]] const std::array<vector3<T>, std::size_t(Order) - 1>& increments() const {
    return increments_;
  }

private:
  static constexpr std::size_t factors = std::size_t(Order) - 1;

  void set_increments() {
    for (std::size_t i = 0; i < controls_.size(); ++i) {
      const auto value = detail::innermost_of(controls_[i]);
      using std::abs;
      if (!(abs(squared_norm(value) - 1) <= 2 * unit_norm_tolerance)) [[unlikely]] {
        detail::raise(
            invalid_sample(i, detail::message("quaternion ", controls_[i], " is not of norm 1")));
      }
      if (i > 0 && innermost(dot(controls_[i - 1], controls_[i])) < 0) [[unlikely]] {
        detail::raise(invalid_sample(
            i, "its sign is not aligned with that of the control point before (negate it)"));
      }
    }
    increments_ = detail::increments_between<T, factors>(controls_.data(), "bspline_segment");
  }

  [[nodiscard]] const real_type& checked(const real_type& u) const {
    if (!(u >= basis_.front() && u <= basis_.back())) [[unlikely]] {
      detail::raise(invalid_input(detail::message(
          "duet: bspline_segment evaluated at ", detail::all_digits(u), ", outside its span [",
          detail::all_digits(basis_.front()), ", ", detail::all_digits(basis_.back()), "]")));
    }
    return u;
  }

  template <int Rates>
  [[nodiscard]] auto half_motion(const real_type& u) const {
    return detail::product_of_exponentials<Rates>(controls_[0], increments_.data(),
                                                  basis_.weights().template at<Rates>(checked(u)));
  }

  basis_type basis_;
  std::array<quaternion<T>, std::size_t(Order)> controls_;
  std::array<vector3<T>, factors> increments_;
};

} // namespace duet
