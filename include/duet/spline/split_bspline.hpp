// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/derivative/frame.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/motion_jacobian.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Split curves of poses, R³ × SO(3): positions and orientations as separate B-splines over the
/// same knots.

namespace duet {

namespace detail {

/// Derivatives of p = Σ B_i p_i, and those of the weights B_i = B̃_i − B̃_{i+1} in them.
template <class R, std::size_t Count, std::size_t Order>
struct weighted_positions {
  std::array<vector3<R>, Count> derivatives;
  std::array<std::array<R, Order>, Count> weights;

  /// \param cumulative  element [d][i] is the d-th derivative of B̃_{i+1}
  template <class Cumulative>
  weighted_positions(const Cumulative& cumulative, const vector3<R>* positions) {
    for (std::size_t d = 0; d < Count; ++d) {
      derivatives[d] = d == 0 ? positions[0] : vector3<R>(vector3<R>::Zero());
      for (std::size_t i = 0; i < Order; ++i) {
        const R from = i > 0 ? cumulative[d][i - 1] : R(d == 0 ? 1 : 0);
        weights[d][i] = from - (i + 1 < Order ? cumulative[d][i] : R(0));
        if (i > 0) { // by steps, which loses no digits far from the origin
          derivatives[d] += from * (positions[i] - positions[i - 1]);
        }
      }
    }
  }
};

} // namespace detail

/// Motion of a split curve at a parameter, with its Jacobians.
template <Real R, int Order, int Rates, class Frame>
struct split_jacobian {
  /// Orientation, with its Jacobians with respect to the control rotations.
  curve_jacobian<R, Order, Rates, Frame> rotation;
  vector3<R> position = detail::zero_initialized<vector3<R>>(); ///< position p in fixed axes
  vector3<R> velocity = position;                               ///< ṗ
  vector3<R> acceleration = position;                           ///< p̈
  vector3<R> jerk = position;                                   ///< third derivative of p
  /// Element [d][i] is the d-th derivative of the weight of control position first + i: the d-th
  /// derivative of p has the Jacobian weights[d][i] I with respect to it.
  std::array<std::array<R, std::size_t(Order)>, 4> weights = {};
};

/// Split curve of poses over one basis: positions p(u) = Σ B_i(u) p_i and rotations, a cumulative
/// B-spline. Its translation does not depend on the orientation of the frames, unlike that of a
/// `cumulative_bspline` of poses, whose segments are screw motions.
template <Real R, int Order = 4>
class split_bspline {
public:
  using rotation_curve = cumulative_bspline<R, Order>;
  using basis_type = typename rotation_curve::basis_type;

  /// \throws invalid_input for counts that do not match
  /// \throws invalid_sample as `cumulative_bspline`
  split_bspline(basis_type basis, std::vector<quaternion<R>> rotations,
                std::vector<vector3<R>> positions)
      : rotation_(std::move(basis), std::move(rotations)), positions_(std::move(positions)) {
    detail::require(positions_.size() == rotation_.basis().size(),
                    "duet: split_bspline: ", rotation_.basis().size(),
                    " control points needed, got ", positions_.size(), " positions");
  }

  /// Orientation as a curve.
  [[nodiscard]] const rotation_curve& rotation() const { return rotation_; }
  /// Control positions.
  [[nodiscard]] const std::vector<vector3<R>>& positions() const { return positions_; }

  /// Motion at u with the Jacobians of value and rates. The frame and the side are those of the
  /// orientation; positions and their derivatives are in fixed axes.
  ///
  /// \throws invalid_input outside the domain
  template <int Rates, FrameConstant Frame>
  [[nodiscard]] split_jacobian<R, Order, Rates, Frame>
  motion_jacobian(const R& u, Frame frame, perturbation side = perturbation::right) const {
    span_hint hint;
    return motion_jacobian<Rates>(u, frame, side, hint);
  }
  template <int Rates, FrameConstant Frame>
  [[nodiscard]] split_jacobian<R, Order, Rates, Frame>
  motion_jacobian(const R& u, Frame frame, perturbation side, span_hint& hint) const {
    split_jacobian<R, Order, Rates, Frame> result;
    const std::size_t span = rotation_.basis().find_span(u, hint);
    result.rotation = rotation_.template motion_jacobian<Rates>(u, frame, side, hint);
    const detail::weighted_positions<R, 4, std::size_t(Order)> p(
        rotation_.basis().template weights<3>(span, u), &positions_[result.rotation.first]);
    result.weights = p.weights;
    result.position = p.derivatives[0];
    result.velocity = p.derivatives[1];
    result.acceleration = p.derivatives[2];
    result.jerk = p.derivatives[3];
    return result;
  }

private:
  rotation_curve rotation_;
  std::vector<vector3<R>> positions_;
};

/// Point R(u) x + p(u) of a body on a split curve, with its Jacobian with respect to the control
/// rotations; that with respect to control position i is weights[0][i] I.
///
/// \param x  point in body axes
template <Real R, int Order, int Rates, class Frame>
[[nodiscard]] point_jacobian_result<R, Order>
point_jacobian(const split_jacobian<R, Order, Rates, Frame>& m, const vector3<R>& x) {
  auto result = point_jacobian(m.rotation, x);
  result.value += m.position;
  result.parameter_derivative += m.velocity;
  return result;
}

} // namespace duet
