// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/planning/branches/joint_loop.hpp>
#include <duet/planning/branches/middle_turn.hpp>
#include <duet/planning/branches/turns.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <cmath>
#include <numbers>

/// \file
/// Three turns that take a point close to where two of their axes meet.
///
/// How far the point is from there is known as the length of a vector, to rounding; by its square
/// half of the digits are lost. The third turn alone makes that length, and then the two take one
/// direction to another. (Page: all_inverse_kinematics.)

namespace duet::detail {

/// Calls visit(θ, multiplicity) where |v(θ)| is a given length, less than half of the most.
/// Of the least |v|, at a known angle, |v|² = least² + 4 r sin²(x/2) at x from there.
template <class Visit>
void visit_length(const turned_vector& v, double length, const Visit& visit) {
  constexpr double rounding = 1e-14;
  const double b = dot(v.along, v.across), c = dot(v.along, v.beside), r = std::hypot(b, c);
  const double at_least = std::atan2(-c, -b), least = length_of(v.at(at_least));
  const double both = length + least, square = (length - least) * both / (4 * r);
  if (std::abs(length - least) <= rounding) {
    visit(at_least, 2);
  } else if (square > 0 && square <= 1) {
    const double x = 2 * std::asin(std::sqrt(square));
    visit(at_least - x, 1);
    visit(at_least + x, 1);
  }
}

/// What is known of three turns that take a point to its goal.
struct fold {
  bool is_visited = false; ///< have all been visited that there are, but for what is not certain?
  bool is_certain = true;
};

/// Calls visit(θ₁, θ₂, θ₃, multiplicity) where the first three joints of a loop take a point to its
/// goal, if one of these is close to the point in which the second axis meets the first or third.
/// In that point two of the joints may be anything: quarter turns are tried until visit is true.
template <class Visit>
fold visit_folded(const joint_loop& loop, const vector3d& point, const vector3d& goal,
                  const Visit& visit) {
  constexpr double close_by = 1e-3, rounding = 4e-15, in_it = 1e-14, certain = 2e-11;
  const auto &first = loop.joints[0], &second = loop.joints[1], &third = loop.joints[2];
  fold result;
  for (const bool is_goal : {true, false}) { // close to axes 1 and 2; the point to axes 2 and 3
    const loop_joint &other = is_goal ? first : third, &elbow = is_goal ? third : first;
    const vector3d meeting = nearest_point(second, other);
    const vector3d still = (is_goal ? goal : point) - meeting;
    const double distance = length_of(still),
                 apart = length_of(cross(other.axis, meeting - other.point)),
                 error = (rounding + apart) / distance;
    if (!(distance < close_by && apart < close_by)) {
      continue;
    }
    if (apart > rounding + 1e-3 * distance) { // nor far enough from each other for `angle_pairs`
      result.is_certain = false;
      continue;
    }
    const turned_vector moving(is_goal ? elbow.axis : -1 * elbow.axis,
                               (is_goal ? point : goal) - elbow.point, elbow.point - meeting);
    result = {true, distance > certain};
    visit_length(moving, distance, [&](double theta, int multiplicity) {
      const auto visit_both = [&](double alpha, double beta, int m) {
        return is_goal ? visit(alpha, beta, theta, multiplicity * m)
                       : visit(theta, alpha, beta, multiplicity * m);
      };
      if (!(distance > in_it)) {
        constexpr double quarter = std::numbers::pi / 2;
        for (int k = 0; k < 16 && !visit_both(k / 4 * quarter, k % 4 * quarter, 1); ++k) {
        }
        return;
      }
      const vector3d v = moving.at(theta), moved = 1 / length_of(v) * v,
                     stays = 1 / distance * still;
      const double nearest =
          is_goal ? visit_two_turns(first.axis, second.axis, moved, stays, visit_both, error)
                  : visit_two_turns(second.axis, third.axis, stays, moved, visit_both, error);
      result.is_certain = result.is_certain && nearest > 2 * close_by;
    });
    return result;
  }
  return result;
}

} // namespace duet::detail
