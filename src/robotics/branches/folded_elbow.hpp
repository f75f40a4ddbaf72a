// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "subproblems.hpp"

#include <duet/quaternion/three_vector.hpp>

#include <cmath>
#include <numbers>
#include <vector>

/// \file
/// Three rotations that move a point close to the intersection of two of their axes.
///
/// The distance of the point from the intersection is known to round-off as the length of a vector;
/// its square would lose half of the digits. The third rotation alone determines that length
/// (Paden–Kahan subproblem 3), and the other two then map one direction to another (Paden–Kahan
/// subproblem 2). (Page: all_inverse_kinematics.)

namespace duet::detail {
DUET_ABI_BEGIN

/// Angle that satisfies an equation, with its multiplicity.
struct angle_solution {
  double theta = 0;
  int multiplicity = 1;
};

/// Angles θ with |v(θ)| = length (Paden–Kahan subproblem 3), for a length less than half of the
/// maximum. At x from the known angle of the minimum, |v|² = minimum² + 4 r sin²(x/2).
[[nodiscard]] inline std::vector<angle_solution> subproblem3(const rotating_vector& v,
                                                             double length) {
  constexpr double rounding = 1e-14;
  const double b = dot(v.along, v.across), c = dot(v.along, v.normal), r = std::hypot(b, c);
  const double at_minimum = std::atan2(-c, -b), minimum = length_of(v.at(at_minimum));
  const double square = (length - minimum) * (length + minimum) / (4 * r);
  if (std::abs(length - minimum) <= rounding) {
    return {{at_minimum, 2}};
  }
  if (square > 0 && square <= 1) {
    const double x = 2 * std::asin(std::sqrt(square));
    return {{at_minimum - x, 1}, {at_minimum + x, 1}};
  }
  return {};
}

/// Three rotations that move a point to its goal, if the goal is close to the point in which the
/// second axis meets the first, or the point to that in which it meets the third.
struct folded_elbow {
  struct angles {
    double first = 0, second = 0, third = 0;
    int multiplicity = 1;
  };

  bool is_folded = false; ///< true if the goal or the point is that close
  bool is_certain = true; ///< true if all solutions are included and determined
  bool is_any = false;    ///< true if two angles are arbitrary: multiples of 90° are given
  std::vector<angles> all = {};

  folded_elbow(const loop_equation& loop, const vector3d& point, const vector3d& goal) {
    for (const bool is_goal : {true, false}) {
      if (!is_folded) {
        find(loop, point, goal, is_goal);
      }
    }
  }

private:
  /// Finds the solutions in one of both cases.
  ///
  /// \param is_goal  true: goal close to axes 1 and 2; false: point close to axes 2 and 3
  void find(const loop_equation& loop, const vector3d& point, const vector3d& goal, bool is_goal) {
    constexpr double close_by = 1e-3, rounding = 4e-15, coincident = 3e-14, certain = 3e-13;
    const loop_joint &first = loop.joints[0], &second = loop.joints[1], &third = loop.joints[2];
    const loop_joint &other = is_goal ? first : third, &elbow = is_goal ? third : first;
    const vector3d meeting = nearest_point(second, other);
    const vector3d fixed = (is_goal ? goal : point) - meeting;
    const double distance = length_of(fixed),
                 separation = length_of(cross(other.axis, meeting - other.point));
    if (!(distance < close_by && separation < close_by)) {
      return;
    }
    if (separation >
        rounding + 1e-3 * distance) { // too close for `angle_pairs`, too distant for subproblem 3
      is_certain = false;
      return;
    }
    is_folded = true;
    is_certain = distance > certain;
    is_any = !(distance > coincident);
    const rotating_vector moving(is_goal ? elbow.axis : -1 * elbow.axis,
                                 (is_goal ? point : goal) - elbow.point, elbow.point - meeting);
    for (const auto& [theta, multiplicity] : subproblem3(moving, distance)) {
      const auto add = [&, angle = theta, times = multiplicity](double alpha, double beta, int m) {
        all.push_back(is_goal ? angles{alpha, beta, angle, times * m}
                              : angles{angle, alpha, beta, times * m});
      };
      if (is_any) {
        constexpr double quarter_turn = std::numbers::pi / 2;
        for (int k = 0; k < 16; ++k) {
          add(k / 4 * quarter_turn, k % 4 * quarter_turn, 1);
        }
        continue;
      }
      const vector3d v = moving.at(theta), moved_direction = 1 / length_of(v) * v,
                     fixed_direction = 1 / distance * fixed;
      const subproblem2 both(is_goal ? first.axis : second.axis, is_goal ? second.axis : third.axis,
                             is_goal ? moved_direction : fixed_direction,
                             is_goal ? fixed_direction : moved_direction,
                             (rounding + separation) / distance);
      for (const auto& [alpha, beta, m] : both) {
        add(alpha, beta, m);
      }
      is_certain = is_certain && both.nearest() > 2 * close_by;
    }
  }
};

DUET_ABI_END
} // namespace duet::detail
