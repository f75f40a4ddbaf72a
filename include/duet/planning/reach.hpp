// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/pose.hpp>
#include <duet/mechanism/serial_chain.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>

/// \file
/// How far a chain can stretch.

namespace duet::detail {

/// The origin of the first joint stands still in the base, that of the last in the tip's frame, and
/// between the two are links and sliding joints.
class chain_reach {
public:
  template <class C>
  explicit chain_reach(const C& chain) : tool_(conj(chain.tip().offset.pose())) {
    for (std::size_t i = 0; i < std::size_t(chain.size()); ++i) {
      const auto& step = chain.steps()[i];
      if (i == 0) {
        first_ = step.offset;
      } else {
        links_ += std::hypot(step.offset.x, step.offset.y, step.offset.z);
      }
      if (step.slides) {
        const auto& limits = chain.limits(int(i));
        travel_ += std::abs(step.pitch) * std::max(std::abs(limits.lower), std::abs(limits.upper));
      }
    }
    const auto& tool = chain.tip().offset.translation;
    tool_length_ = std::hypot(tool[0], tool[1], tool[2]);
    has_joints_ = chain.size() > 0;
  }

  /// Is it certain that no pose of the tip is as near to the goal as that, in length and radians?
  [[nodiscard]] bool is_beyond(const dual_quaternion<double>& goal, double tolerance) const {
    const double distance = (translation(goal * tool_) - first_).norm();
    return has_joints_ &&
           distance > (links_ + travel_) * (1 + 1e-12) + tolerance * (1 + tool_length_);
  }

  /// A length typical of the chain, 1 where there is none in its table.
  [[nodiscard]] double scale() const {
    const double length = links_ + tool_length_;
    return length > 0 ? length : 1;
  }

private:
  dual_quaternion<double> tool_; ///< from the tip to the last joint
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  double links_ = 0;
  double travel_ = 0;
  double tool_length_ = 0;
  bool has_joints_ = false;
};

} // namespace duet::detail
