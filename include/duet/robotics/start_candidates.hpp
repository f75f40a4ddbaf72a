// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>
#include <duet/robotics/clearance.hpp>
#include <duet/robotics/goals.hpp>
#include <duet/robotics/inverse_kinematics.hpp>
#include <duet/robotics/objective.hpp>
#include <duet/robotics/self_motion_curves.hpp>
#include <duet/robotics/solutions_within_limits.hpp>
#include <duet/robotics/splitmix64.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

/// \file
/// Candidates for the start configuration of a path.

namespace duet::detail {

/// Solutions for poses of the tip of a chain, among obstacles if there are any.
template <int Capacity>
class pose_solutions {
public:
  using chain = serial_chain<-Capacity>;
  using joints = joint_vector<double, -Capacity>;
  /// Solutions that are connected by self-motions.
  using family = std::vector<joints>;

  pose_solutions(const chain& arm, const scene* around, const pose_tolerance& tolerance)
      : chain_(arm), around_(around), tolerance_(tolerance) {}

  /// All solutions of six joints; of seven joints points of their self-motion curves, `resolution`
  /// apart; of others, and where these find none or not all, those that random starts find.
  [[nodiscard]] std::vector<family> at(const dual_quaternion<double>& goal,
                                       double resolution) const {
    std::vector<family> result;
    bool is_complete = false;
    if (is_algebraic(chain_, 6)) {
      const auto all = all_inverse_kinematics(chain_, goal);
      is_complete = all.is_complete;
      for (const auto& branch : all.solutions) {
        add(result, {branch.joints});
      }
    } else if (is_algebraic(chain_, 7)) {
      for (auto& curve : self_motion_curves(chain_, goal, {.resolution = resolution})) {
        add(result, std::move(curve.joints));
      }
      is_complete = !result.empty();
    }
    splitmix64 random(1);
    for (int i = 0; i < 100 && !is_complete; ++i) {
      const auto solution = from(configuration(random), goal, 0, 1e-3);
      if (solution.reason == stop_reason::reached && is_new(solution.joints, result)) {
        add(result, {solution.joints});
      }
    }
    return result;
  }

  /// One solution, or the reason for its absence.
  ///
  /// \param part  fraction of the tolerance
  [[nodiscard]] inverse_kinematics_result<-Capacity> from(const joints& start,
                                                          const dual_quaternion<double>& goal,
                                                          int restarts, double part = 1) const {
    const inverse_kinematics_options options{
        .tolerance = {part * tolerance_.translation, part * tolerance_.rotation},
        .max_restarts = restarts};
    return around_ == nullptr
               ? inverse_kinematics(chain_, goal, start, options)
               : inverse_kinematics(chain_, goal, start, options, no_objective{}, *around_);
  }

  /// Joints moved by full turns into their limits, as far as that is possible.
  [[nodiscard]] joints wrapped_into_limits(joints theta) const {
    for (int i = 0; i < chain_.size(); ++i) {
      if (chain_.steps()[std::size_t(i)].is_rotational &&
          !chain_.steps()[std::size_t(i)].is_translational) {
        theta[i] = wrap_into_limits(theta[i], chain_.limits(i));
      }
    }
    return theta;
  }
  [[nodiscard]] bool is_within_limits(const joints& theta) const {
    for (int i = 0; i < chain_.size(); ++i) {
      if (!(chain_.limits(i).lower <= theta[i] && theta[i] <= chain_.limits(i).upper)) {
        return false;
      }
    }
    return true;
  }
  [[nodiscard]] bool is_clear(const joints& theta) const {
    return around_ == nullptr ||
           clearance(chain_, theta, *around_).distance >= around_->margin - tolerance_.translation;
  }

private:
  void add(std::vector<family>& to, family all) const {
    for (joints& theta : all) {
      theta = wrapped_into_limits(theta);
    }
    std::erase_if(all, [&](const joints& x) { return !is_within_limits(x) || !is_clear(x); });
    if (!all.empty()) {
      to.push_back(std::move(all));
    }
  }
  [[nodiscard]] static bool is_new(const joints& theta, const std::vector<family>& others) {
    return std::none_of(others.begin(), others.end(), [&](const family& other) {
      return (other.front() - theta).cwiseAbs().maxCoeff() < 1e-3;
    });
  }
  [[nodiscard]] joints configuration(splitmix64& random) const {
    joints theta(chain_.size());
    for (int i = 0; i < chain_.size(); ++i) {
      const auto& limits = chain_.limits(i);
      const double lower = std::max(limits.lower, std::min(-std::numbers::pi, limits.upper));
      const double upper = std::min(limits.upper, std::max(std::numbers::pi, limits.lower));
      theta[i] = lower + (upper - lower) * random();
    }
    return theta;
  }

  const chain& chain_;
  const scene* around_;
  pose_tolerance tolerance_;
};

} // namespace duet::detail
