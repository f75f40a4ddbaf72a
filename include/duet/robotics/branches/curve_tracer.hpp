// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/robotics/branches/self_motion_set.hpp>
#include <duet/robotics/branches/seven_joint_arm.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <optional>

/// \file
/// Numerical continuation of self-motion curves, through points where they cross.

namespace duet::detail {

/// Predictor–corrector continuation of the self-motion curves of one arm and goal: steps along the
/// Jacobian's null space, or along the projection of the previous step onto it where it has more
/// dimensions, and projections back onto the set.
class curve_tracer {
public:
  /// Continuation on a self-motion set.
  ///
  /// \param step  maximum distance between consecutive points
  curve_tracer(const self_motion_set& set, double step) : set_(set), step_(step) {}

  /// Curve through one of its points: closed, or followed to both ends.
  ///
  /// \param leaving  direction of the curve at that point
  /// \param kernel   dimension of the Jacobian's null space on the curve
  [[nodiscard]] traced_curve trace(const seven_coordinates& start, const seven_coordinates& leaving,
                                   int kernel) const {
    traced_curve result{{start}, false, 1, kernel};
    const auto first = direction(set_.kernel(start), leaving);
    if (!first || follow(result, *first)) {
      return result;
    }
    std::reverse(result.points.begin(), result.points.end());
    follow(result, -*first);
    return result;
  }

  /// True if a point of the set is on a curve.
  ///
  /// \param kernel  dimension of the Jacobian's null space at x
  [[nodiscard]] bool is_on(const traced_curve& curve, const seven_coordinates& x,
                           int kernel) const {
    const double same = curve.kernel == 1 && kernel == 1 ? self_motion_tolerance::same
                                                         : self_motion_tolerance::same_rough;
    const std::size_t n = curve.points.size(), segments = curve.is_closed ? n : n - 1;
    for (std::size_t k = 0; k < segments; ++k) {
      const seven_coordinates& a = curve.points[k];
      const seven_coordinates to_x = set_.difference(x, a),
                              chord = set_.difference(curve.points[(k + 1) % n], a);
      if (to_x.squaredNorm() > 4 * chord.squaredNorm()) {
        continue;
      }
      // If x is on the curve, it is the point of the curve that is nearest to x,
      // found along the chord.
      double fraction = std::clamp(to_x.dot(chord) / chord.squaredNorm(), 0., 1.);
      for (int round = 0; round < 8 && fraction > -.5 && fraction < 1.5; ++round) {
        const auto between = set_.projected(set_.moved(a, fraction * chord), step_);
        if (!between) {
          break;
        }
        const seven_coordinates residual = set_.difference(x, *between);
        if (residual.norm() < same) {
          return true;
        }
        fraction += residual.dot(chord) / chord.squaredNorm();
      }
    }
    return set_.difference(x, curve.points.front()).norm() < same;
  }

private:
  struct continuation_step {
    seven_coordinates x, ahead; ///< new point, direction of the curve there
    double bend, length;        ///< deflection and length of the step
    bool is_crossing;           ///< true if the null space has more dimensions than on the curve
  };

  /// Unit vector of a null space that is nearest to the direction of the previous step; empty if
  /// that is nearly orthogonal to it.
  [[nodiscard]] static std::optional<seven_coordinates>
  direction(const self_motion_set::null_space& basis, const seven_coordinates& before) {
    const seven_coordinates along = basis * (basis.transpose() * before);
    const double size = along.norm();
    return size > .1 ? std::optional<seven_coordinates>(along / size) : std::nullopt;
  }

  /// Step along the curve; empty if the curve does not continue in about the same direction.
  [[nodiscard]] std::optional<continuation_step> take_step(const seven_coordinates& x,
                                                           const seven_coordinates& along,
                                                           double step, int kernel) const {
    const auto next = set_.projected(set_.moved(x, step * along), step_);
    if (!next) {
      return {};
    }
    const seven_coordinates displacement = set_.difference(*next, x);
    const auto basis = set_.kernel(*next);
    const auto ahead = direction(basis, basis.cols() == 1 ? along : displacement.normalized());
    if (basis.cols() < kernel || !ahead || displacement.norm() > step_) {
      return {};
    }
    const double bend = (*ahead - along).norm();
    return bend < .3 ? std::optional<continuation_step>(
                           {*next, *ahead, bend, displacement.norm(), basis.cols() > kernel})
                     : std::nullopt;
  }

  /// Step past points where curves cross, if they are not too close to each other.
  [[nodiscard]] std::optional<continuation_step> step_past_crossing(const seven_coordinates& x,
                                                                    const seven_coordinates& along,
                                                                    double step, int kernel) const {
    auto result = take_step(x, along, step, kernel);
    for (const double fraction : {.62, .81, .38}) {
      if (!result || !result->is_crossing) {
        break;
      }
      const auto other = take_step(x, along, fraction * step, kernel);
      result = other && !other->is_crossing ? other : result;
    }
    return result;
  }

  /// Adds points until the curve returns to its first one.
  ///
  /// \return true if it does
  bool follow(traced_curve& curve, seven_coordinates along) const {
    constexpr double min_step = 1e-5, max_crossing = .6;
    const int max_points = int(400 / step_);
    const seven_coordinates start = curve.points.front(), leaving = along;
    double step = step_ / 2, crossing = 0;
    for (int k = 0; k < max_points && step > min_step; ++k) {
      const seven_coordinates last = curve.points.back();
      const auto next = step_past_crossing(last, along, step, curve.kernel);
      if (!next) {
        step *= .6; // not a half: structured curves cross at such fractions
        continue;
      }
      crossing = next->is_crossing ? crossing + next->length : 0;
      if (crossing > max_crossing) {
        return false; // it has reached a component of more dimensions
      }
      const seven_coordinates back = set_.difference(start, last);
      const double remaining = back.dot(along);
      const bool is_back = curve.points.size() > 3 && remaining > 0 && remaining <= 1.5 * step &&
                           back.norm() < std::min(2 * remaining, step_) && along.dot(leaving) > .5;
      if (is_back) {
        curve.is_closed = true;
        return true;
      }
      curve.points.push_back(next->x);
      along = next->ahead;
      step = std::min(step_ / 2, next->bend < .1 ? 2 * step : step);
    }
    return false;
  }

  const self_motion_set& set_;
  double step_;
};

} // namespace duet::detail
