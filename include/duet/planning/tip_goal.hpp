// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/planning/goal_equations.hpp>
#include <duet/planning/inverse_kinematics_search.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/planning/pose_region.hpp>
#include <duet/planning/small_vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Goals of any type for the search for joint coordinates, which is compiled once for all.

namespace duet::detail {

/// What a search knows of a goal, with lengths as planners count them.
class tip_goal {
public:
  virtual ~tip_goal() = default;
  [[nodiscard]] virtual wanted_twist wanted(const tip_place& tip) const = 0;
  [[nodiscard]] virtual double distance_from(const three_vector<double>&) const { return 0; }
};

/// A goal of the type G, which knows of a user's lengths alone.
template <TipGoal G>
class tip_goal_of final : public tip_goal {
public:
  /// \param length  that planners count in
  tip_goal_of(const G& goal, double length) : goal_(goal), length_(length) {}
  [[nodiscard]] wanted_twist wanted(const tip_place& tip) const override {
    wanted_twist x = goal_.wanted(pose_at({tip.rotation, length_ * tip.translation}));
    x.least.head<3>() /= length_;
    x.most.head<3>() /= length_;
    x.rows.topRightCorner<3, 3>() /= length_;
    x.rows.bottomLeftCorner<3, 3>() *= length_;
    return x;
  }
  [[nodiscard]] double distance_from(const three_vector<double>& point) const override {
    if constexpr (requires { goal_.distance_from(point.eigen()); }) {
      const three_vector<double> given = length_ * point;
      return goal_.distance_from(given.eigen()) / length_;
    } else {
      return 0;
    }
  }

private:
  const G& goal_;
  double length_;
};

/// A pose as one goal among others.
struct whole_pose {
  tip_place place;

  [[nodiscard]] wanted_twist wanted(const dual_quaternion<double>& tip) const {
    wanted_twist result;
    const small_twist e = error_twist(place_of(tip), place);
    result.rows.setIdentity();
    for (std::ptrdiff_t i = 0; i < 6; ++i) {
      result.least[i] = e[i];
    }
    result.most = result.least;
    return result;
  }
  [[nodiscard]] double distance_from(const vector3<double>& point) const {
    return length_of(place.translation - components(point));
  }
};

/// What is wanted of a tip as far as it is missing, and how much that is.
struct missing_twist {
  small_twist e;
  pose_deviation left;

  explicit missing_twist(const wanted_twist& wanted) {
    for (std::ptrdiff_t i = 0; i < 6; ++i) {
      e[i] = std::max(wanted.least[i], std::min(wanted.most[i], 0.0));
    }
    left = deviation_of(e);
  }
};

/// The row of M J, J in `frame::hybrid`.
template <int Room>
[[nodiscard]] small_vector<Room> goal_row(const wanted_twist& wanted, std::ptrdiff_t row,
                                          const small_matrix<6, Room>& jacobian) {
  small_vector<Room> result;
  for (std::ptrdiff_t k = 0; k < jacobian.cols(); ++k) {
    for (std::ptrdiff_t i = 0; i < 6; ++i) {
      result[k] += wanted.rows(row, i) * jacobian(i, k);
    }
  }
  return result;
}

/// What is within its bounds asks for nothing.
template <int Room>
void set_equations(goal_equations<Room>& x, const tip_goal& goal) {
  const wanted_twist wanted = goal.wanted(x.at.tip);
  const missing_twist missing(wanted);
  x.e = missing.e;
  x.left = missing.left;
  const small_matrix<6, Room> jacobian = x.at.jacobian;
  for (std::ptrdiff_t i = 0; i < 6; ++i) {
    const bool is_equation = wanted.least[i] == wanted.most[i] && !wanted.rows.row(i).isZero(0);
    x.is_free[std::size_t(i)] = x.e[i] == 0 && !is_equation;
    const auto row =
        x.is_free[std::size_t(i)] ? small_vector<Room>{} : goal_row(wanted, i, jacobian);
    for (std::ptrdiff_t k = 0; k < jacobian.cols(); ++k) {
      x.at.jacobian(i, k) = row[k];
    }
  }
}

/// The tip is no farther from the first joint than links, sliding joints and tool are long.
[[nodiscard]] inline bool is_beyond(const chain_reach& reach, const tip_goal& goal,
                                    const pose_tolerance& tolerance) {
  const double most = (reach.links + reach.travel + reach.tool) * (1 + 1e-12);
  return reach.has_joints && goal.distance_from(reach.first) > most + tolerance.length;
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE class inverse_kinematics_search<8, tip_goal>;
DUET_COMPILED_TEMPLATE class inverse_kinematics_search<16, tip_goal>;
#endif

} // namespace duet::detail
