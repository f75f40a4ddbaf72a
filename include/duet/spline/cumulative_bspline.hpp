// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/errors.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/knot_jacobian.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/motion_jacobian.hpp>
#include <duet/spline/orientations.hpp>
#include <duet/spline/piecewise_curve.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Cumulative B-spline curve over rotations and poses (P2), with exact rates (P3, P4).

namespace duet {

/// Cumulative B-spline curve Q(u) = q_0 ∏_{i≥1} exp(ω_i B̃_i(u)), ω_i = log(q_{i−1}⁻¹ q_i), of
/// order k (degree k − 1), C^{k−2} at simple knots.
///
/// \tparam T      scalar of the control points: `double` for rotations, `dual<double, 1,
///                screw_tag>` for poses, either with any infinitesimals
/// \tparam Order  k; 4 is the cubic
///
/// Control points are numbered from 0 (the paper's q_{−1}). The ω_i are half-angle vectors,
/// computed once; evaluation uses no heap. Rates are with respect to u: rad per unit of u, for
/// poses twists [v; ω] per unit of u.
template <class T, int Order = 4>
class cumulative_bspline : public piecewise_curve<cumulative_bspline<T, Order>, real_type_t<T>> {
public:
  using scalar_type = T;
  using real_type = real_type_t<T>;
  using basis_type = bspline_basis<Order, real_type>;
  static constexpr int order = Order;
  /// Order of convergence: for smooth motion the interpolation error decreases as this power of the
  /// step.
  static constexpr int convergence = 3;

  /// Constructs the curve from one control point for each basis function. Control points are
  /// normalised and their signs aligned from the first to the last, so that the curve follows the
  /// shorter arc.
  ///
  /// \throws invalid_input for a count that does not match
  /// \throws invalid_sample as `align_quaternion_signs`
  cumulative_bspline(basis_type basis, std::vector<quaternion<T>> controls)
      : basis_(std::move(basis)), controls_(align_quaternion_signs(std::move(controls))) {
    check_count("control points", controls_.size());
    increments_.reserve(controls_.size());
    increments_.push_back(vector3<T>::Zero());
    for (std::size_t i = 1; i < controls_.size(); ++i) {
      increments_.push_back(detail::log_vector(
          detail::relative_rotation(controls_[i - 1], controls_[i]), "cumulative_bspline"));
    }
  }

  cumulative_bspline(std::vector<real_type> knots, std::vector<quaternion<T>> controls)
      : cumulative_bspline(basis_type(std::move(knots)), std::move(controls)) {}

  /// Constructs the curve from control points, whose signs are not changed, and increments of any
  /// length: for longer arcs and several full turns, and for copies from another curve's
  /// `control_points()` and `increments()`. ω_0 has no effect.
  ///
  /// \throws invalid_input for counts that do not match
  /// \throws invalid_sample as `normalized_quaternions`, and if exp(ω_i) is not q_{i−1}⁻¹ q_i
  cumulative_bspline(basis_type basis, std::vector<quaternion<T>> controls,
                     std::vector<vector3<T>> increments)
      : basis_(std::move(basis)), controls_(normalized_quaternions(std::move(controls))),
        increments_(std::move(increments)) {
    check_count("control points", controls_.size());
    check_count("increments", increments_.size());
    for (std::size_t i = 1; i < controls_.size(); ++i) {
      const auto step = conj(controls_[i - 1]) * controls_[i];
      const auto miss = detail::innermost_of(step - duet::exp(increments_[i]));
      if (!(norm(miss) <= real_type(unit_norm_tolerance))) {
        detail::raise(
            invalid_sample(i, "the increment does not lead to it from the control point before"));
      }
    }
    increments_.front() = vector3<T>::Zero();
  }

  /// Basis, which holds the knots.
  [[nodiscard]] const basis_type& basis() const { return basis_; }
  /// Control points q_0, q_1 …: unit quaternions with aligned signs.
  [[nodiscard]] const std::vector<quaternion<T>>& control_points() const { return controls_; }
  /// Increments ω_i with exp(ω_i) = q_{i−1}⁻¹ q_i, half-angle vectors; ω_0 is zero.
  [[nodiscard]] const std::vector<vector3<T>>& increments() const { return increments_; }

  /// Derivatives of the value and the rates at u with respect to the 2k − 2 knots of its span, in
  /// the frame; the value is perturbed on the side.
  ///
  /// \throws invalid_input outside the domain
  template <FrameConstant Frame>
  [[nodiscard]] knot_jacobian_result<T, Order>
  knot_jacobian(const real_type& u, Frame frame, perturbation side = perturbation::right) const {
    const std::size_t span = basis_.find_span(u), first = basis_.first_function(span);
    auto result = detail::knot_jacobian_of_product<T, Order>(
        &controls_[first], &increments_[first + 1], &basis_.knots()[first + 1], u,
        basis_.template weights<4>(span, u), frame, side);
    result.first = first + 1;
    return result;
  }

private:
  friend class piecewise_curve<cumulative_bspline, real_type_t<T>>;

  void check_count(const char* what, std::size_t count) const {
    detail::require(count == basis_.size(), "duet: cumulative_bspline: ", basis_.knots().size(),
                    " knots of order ", Order, " need ", basis_.size(), " ", what, ", got ", count);
  }

  [[nodiscard]] const basis_type& spans() const { return basis_; }

  template <int Rates, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE auto on_span(std::size_t span, const P& u) const {
    const std::size_t first = basis_.first_function(span);
    return detail::product_of_exponentials<Rates>(controls_[first], &increments_[first + 1],
                                                  basis_.template weights<Rates>(span, u));
  }
  template <int Rates, std::size_t W, class P>
  [[nodiscard]] DUET_ALWAYS_INLINE auto on_span(std::array<std::size_t, W> spans,
                                                const P& u) const {
    const auto weights = basis_.template weights<Rates>(spans, u);
    for (std::size_t& i : spans) {
      i = basis_.first_function(i);
    }
    const auto start = detail::gathered(spans, controls_);
    std::array<decltype(detail::gathered(spans, increments_)), std::size_t(Order) - 1> increments;
    for (auto& omega : increments) {
      for (std::size_t& i : spans) {
        ++i;
      }
      omega = detail::gathered(spans, increments_);
    }
    return detail::product_of_exponentials<Rates>(start, increments.data(), weights);
  }

  template <int Rates, class P, class Frame>
  [[nodiscard]] auto jacobian_on_span(std::size_t span, const P& u, Frame frame,
                                      perturbation side) const {
    using D = promote_t<T, P>;
    const std::size_t first = basis_.first_function(span);
    const auto weights = basis_.template weights<4>(span, u);
    const auto jacobian = [&](const quaternion<D>* controls, const vector3<D>* increments) {
      return detail::jacobian_of_product<Rates, D, std::size_t(Order) - 1>(controls, increments,
                                                                           weights, frame, side);
    };
    auto result = [&] {
      if constexpr (std::is_same_v<D, T>) {
        return jacobian(&controls_[first], &increments_[first + 1]);
      } else {
        std::array<quaternion<D>, std::size_t(Order)> controls;
        std::array<vector3<D>, std::size_t(Order) - 1> increments;
        std::copy_n(&controls_[first], Order, controls.begin());
        for (std::size_t j = 0; j < increments.size(); ++j) {
          increments[j] = increments_[first + 1 + j].template cast<D>();
        }
        return jacobian(controls.data(), increments.data());
      }
    }();
    result.first = first;
    return result;
  }

  basis_type basis_;
  std::vector<quaternion<T>> controls_;
  std::vector<vector3<T>> increments_;
};

} // namespace duet
