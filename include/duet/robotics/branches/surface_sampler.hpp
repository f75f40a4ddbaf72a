// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/robotics/branches/self_motion_set.hpp>
#include <duet/robotics/branches/seven_joint_arm.hpp>
#include <duet/robotics/splitmix64.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

/// \file
/// Samples of self-motion components of two and more dimensions, and membership of points.

namespace duet::detail {

/// Walks on components of two and more dimensions of the self-motion set of one arm and goal.
class surface_sampler {
public:
  explicit surface_sampler(const self_motion_set& set) : set_(set) {}

  /// Up to 64 points of the component that contains x, as far from each other as they can be found.
  [[nodiscard]] traced_curve sample(const seven_coordinates& x, int dimension, int kernel,
                                    splitmix64& random) const {
    constexpr std::size_t count = 64;
    constexpr int tries = 32;
    traced_curve result{{x}, false, dimension, kernel};
    auto& points = result.points;
    for (double separation = 2; separation > .05 && points.size() < count; separation *= .7) {
      for (int failed = 0; failed < tries && points.size() < count; ++failed) {
        const auto& from = points[std::size_t(random() * double(points.size()))];
        const auto end = wander(from, std::numbers::pi * random(), random);
        const auto is_near = [&](const auto& p) {
          return set_.difference(end, p).norm() < separation;
        };
        if (std::none_of(points.begin(), points.end(), is_near)) {
          points.push_back(end);
          failed = 0;
        }
      }
    }
    return result;
  }

  /// True if a walk on the component leads from x to one of the sample's points.
  [[nodiscard]] bool is_on(const traced_curve& component, const seven_coordinates& x,
                           splitmix64& random) const {
    constexpr int detours = 4;
    bool result = leads_to_sample(component, x);
    for (int k = 0; k < detours && !result; ++k) {
      result = leads_to_sample(component, wander(x, std::numbers::pi * random(), random));
    }
    return result;
  }

private:
  static constexpr double stride = .2;

  /// True if a walk leads to one of the nearest points of a sample.
  [[nodiscard]] bool leads_to_sample(const traced_curve& component,
                                     const seven_coordinates& x) const {
    constexpr std::size_t max_count = 8;
    std::vector<seven_coordinates> nearest = component.points;
    std::sort(nearest.begin(), nearest.end(), [&](const auto& a, const auto& b) {
      return set_.difference(a, x).norm() < set_.difference(b, x).norm();
    });
    nearest.resize(std::min(max_count, nearest.size()));
    return std::any_of(nearest.begin(), nearest.end(),
                       [&](const auto& s) { return is_straight(x, s); }) ||
           std::any_of(nearest.begin(), nearest.end(), [&](const auto& s) { return leads(x, s); });
  }

  /// True if the straight line between two points is on the set.
  [[nodiscard]] bool is_straight(const seven_coordinates& x, const seven_coordinates& end) const {
    constexpr std::array parts{.07, .19, .31, .5, .62, .74, .83, .93};
    constexpr double close = 1e-7;
    const seven_coordinates direction = set_.difference(end, x);
    return std::all_of(parts.begin(), parts.end(), [&](double part) {
      return set_.error(set_.moved(x, part * direction)) < close;
    });
  }

  /// Step on the component in a direction; empty if no step stays on it.
  [[nodiscard]] std::optional<seven_coordinates>
  step(const seven_coordinates& x, const seven_coordinates& direction, double max_length) const {
    const auto basis = set_.kernel(x);
    const seven_coordinates along = basis * (basis.transpose() * direction);
    const double size = along.norm();
    if (!(size > .1 * direction.norm())) {
      return {};
    }
    return set_.projected(set_.moved(x, std::min(1., max_length / size) * along), 2 * stride);
  }

  /// True if a walk towards `end` reaches it.
  [[nodiscard]] bool leads(seven_coordinates x, const seven_coordinates& end) const {
    constexpr int steps = 100;
    for (int k = 0; k < steps; ++k) {
      const seven_coordinates direction = set_.difference(end, x);
      const double remaining = direction.norm();
      if (remaining < self_motion_tolerance::same_rough) {
        return true;
      }
      const auto next = step(x, direction, stride);
      if (!next || !(set_.difference(end, *next).norm() < .95 * remaining)) {
        return false;
      }
      x = *next;
    }
    return false;
  }

  /// End of a walk of a given length in a random direction.
  [[nodiscard]] seven_coordinates wander(seven_coordinates x, double length,
                                         splitmix64& random) const {
    seven_coordinates direction = self_motion_set::any_direction(set_.kernel(x), random);
    for (; length > 0; length -= stride) {
      const auto next = step(x, direction, std::min(length, stride));
      const seven_coordinates moved = next ? set_.difference(*next, x) : seven_coordinates::Zero();
      if (!(moved.norm() > 0)) {
        break;
      }
      x = *next;
      direction = moved.normalized();
    }
    return x;
  }

  const self_motion_set& set_;
};

} // namespace duet::detail
