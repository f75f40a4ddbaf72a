// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "bounded_step.hpp"
#include "path_step.hpp"
#include "planning_model.hpp"
#include "singularity.hpp"
#include "small_vector.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// \file
/// Self-motion components: configurations that a chain can move among with its tip fixed.

namespace duet::detail {
DUET_ABI_BEGIN

/// Configuration that can be reached, and its predecessor: one at the same parameter, by a
/// self-motion, or one before.
template <int Capacity>
struct search_node {
  chain_state<Capacity> state;
  double u;
  std::ptrdiff_t from;              ///< index of the predecessor, −1 for none
  bool escapes_singularity = false; ///< true if the predecessor is singular, and this one near it
  bool is_isolated = false;         ///< true if it is an isolated component
};

/// Collects configurations, and with each the self-motion component that contains it.
template <int Capacity>
class self_motion_components {
public:
  using vector = small_vector<Capacity>;

  /// \param spacing     joint step from one configuration of a component to the next
  /// \param iterations  maximum number of iterations of Newton's method
  self_motion_components(const pose_solver<Capacity>& solver, double spacing, int iterations)
      : solver_(solver), spacing_(spacing), remaining_iterations_(iterations) {
    for (std::ptrdiff_t i = 0; i < solver.model.size; ++i) {
      is_endless_ = is_endless_ || solver.is_endless(i);
    }
  }

protected:
  [[nodiscard]] step_result<Capacity> tried(const chain_state<Capacity>& from,
                                            const tip_pose& target, const vector& desired_step) {
    auto result = solver_.approach(from, target, desired_step);
    remaining_iterations_ -= result.iterations;
    return result;
  }

  [[nodiscard]] bool is_known(const vector& theta, std::size_t first) const {
    return std::any_of(nodes_.begin() + std::ptrdiff_t(first), nodes_.end(), [&](const auto& x) {
      // Two components that separate at a singularity are near each other at first.
      return is_near(x.state.theta, theta, (x.is_isolated ? 1e-4 : .5) * spacing_ * spacing_);
    });
  }

  /// Adds the component that contains nodes_[start], unless it is larger than a point only because
  /// of the tolerance.
  void follow(std::size_t start, const tip_pose& target) {
    extend(start, target);
    const bool is_isolated =
        std::all_of(nodes_.begin() + std::ptrdiff_t(start), nodes_.end(), [&](const auto& x) {
          return norm(x.state.theta - nodes_[start].state.theta) < .1 * spacing_;
        });
    if (is_isolated) {
      nodes_.erase(nodes_.begin() + std::ptrdiff_t(start) + 1, nodes_.end());
      nodes_[start].is_isolated = true;
    }
  }

  const pose_solver<Capacity>& solver_;
  double spacing_;
  int remaining_iterations_;
  std::vector<search_node<Capacity>> nodes_;

private:
  /// True if near each other except for full turns of joints without limits.
  [[nodiscard]] bool is_near(const vector& a, const vector& b, double square) const {
    const vector difference = a - b;
    const auto square_of = [](const vector& x) { return dot(x, x); };
    return square_of(difference) < square ||
           (is_endless_ && square_of(solver_.modulo_full_turns(difference)) < square);
  }

  /// Adds the configurations on a curve with nodes_[start], alternately in both directions, so that
  /// those nearby come first.
  void extend(std::size_t start, const tip_pose& target) {
    const vector along = self_motion_space(nodes_[start].state.jacobian).any_direction();
    front ends[2] = {{start, along, spacing_}, {start, -1 * along, spacing_}};
    bool is_open[2] = {norm(along) > 0, norm(along) > 0};
    for (int count = 0; (is_open[0] || is_open[1]) && remaining_iterations_ > 0; ++count) {
      const int side = count % 2;
      if (is_open[side]) {
        is_open[side] = extend_by_step(ends[side], target);
        // If the ends meet, the curve is closed.
        if (count > 6 && is_near(nodes_[ends[0].at].state.theta, nodes_[ends[1].at].state.theta,
                                 .64 * spacing_ * spacing_)) {
          return;
        }
      }
    }
  }

  struct front {
    std::size_t at;
    vector direction;
    double step;
  };

  /// Takes one step on; false at the end of the component.
  bool extend_by_step(front& end, const tip_pose& target) {
    const chain_state<Capacity>& current = nodes_[end.at].state;
    // Step length up to the limits.
    double reach = end.step;
    for (std::ptrdiff_t i = 0; i < current.theta.size(); ++i) {
      const double d = end.direction[i];
      if (std::abs(d) > 1e-9) {
        const double bound = d > 0 ? solver_.upper[i] : solver_.lower[i];
        reach = std::min(reach, (bound - current.theta[i]) / d);
      }
    }
    for (; reach > spacing_ / 100; reach /= 2) {
      const auto next = tried(current, target, reach * end.direction);
      const vector displacement = next.state.theta - current.theta;
      if (next.is_within(solver_.tolerance) && norm(displacement) < 2 * reach &&
          dot(displacement, end.direction) > .7 * reach) {
        const vector direction = self_motion_space(next.state.jacobian).direction(end.direction);
        const bool reverses_orientation = orientation(next.state.jacobian, direction) *
                                              orientation(current.jacobian, end.direction) <
                                          0;
        if (dot(direction, end.direction) > .7 &&
            (!reverses_orientation || reach < spacing_ / 50)) {
          nodes_.push_back({next.state, nodes_[end.at].u, std::ptrdiff_t(end.at)});
          end = {nodes_.size() - 1, direction, std::min(spacing_, 2 * reach)};
          return true;
        }
      }
    }
    return false;
  }

  bool is_endless_ = false; ///< true if any joint has no limits
};

DUET_ABI_END
} // namespace duet::detail
