// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/robotics/branches/branch_search.hpp>
#include <duet/robotics/branches/chain_loop.hpp>
#include <duet/robotics/branches/curve_tracer.hpp>
#include <duet/robotics/branches/loop_equation.hpp>
#include <duet/robotics/branches/loop_solution_set.hpp>
#include <duet/robotics/branches/redundant_arm.hpp>
#include <duet/robotics/branches/self_motion_set.hpp>
#include <duet/robotics/branches/seven_joint_arm.hpp>
#include <duet/robotics/branches/surface_sampler.hpp>
#include <duet/robotics/splitmix64.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

/// \file
/// Search for all components of the self-motion of seven joints. Compiled into duet::compiled.

namespace duet::detail {

/// Collects the components of the self-motion set of one redundant arm at one goal.
class component_search {
public:
  component_search(const redundant_arm& arm, double resolution)
      : arm_(arm), set_(arm), tracer_(set_, resolution), sampler_(set_), resolution_(resolution) {}

  [[nodiscard]] std::vector<traced_curve> operator()() {
    add_slices();
    if (is_degenerate_ || seeds_[1].empty()) {
      add_random_points();
    }
    // Seeds with the smallest null spaces first: almost all points of a component have a null space
    // of the same dimension, some have larger ones.
    for (std::size_t kernel = 1; kernel < seeds_.size(); ++kernel) {
      for (const seven_coordinates& x : seeds_[kernel]) {
        add(x, int(kernel));
      }
    }
    return std::move(components_);
  }

private:
  /// Adds all solutions of the other six joints with one joint fixed, for each joint at values one
  /// resolution apart.
  void add_slices() {
    const int count = int(std::ceil(2 * std::numbers::pi / resolution_));
    for (int fixed = 0; fixed < 7; ++fixed) {
      for (int k = 0; k < count && arm_.is_revolute[std::size_t(fixed)]; ++k) {
        // not at round numbers from tables, where arms are singular
        add_slice(fixed, 2 * std::numbers::pi * (k + .37) / count - std::numbers::pi);
      }
    }
  }
  void add_slice(int fixed, double value) {
    const chain_screws axes = arm_.axes_without(fixed, value);
    const branch_search search(axes.loop_to(arm_.goal));
    for (const loop_solution& x : search.answer().solutions) {
      seven_coordinates theta;
      for (int i = 0, k = 0; i < 7; ++i) {
        theta[i] =
            i == fixed ? value : x.theta[k] * (arm_.is_revolute[std::size_t(i)] ? 1 : axes.size);
        k += i != fixed;
      }
      // If other joints can move while this one is fixed, its value is singular, or the set has
      // more dimensions.
      is_degenerate_ = is_degenerate_ || !search.answer().is_complete;
      if (const auto on_set = set_.projected(theta, .1)) {
        add_seed(*on_set);
      }
    }
  }

  /// Adds points of components on which no joint can be fixed alone, by searches from random
  /// configurations.
  void add_random_points() {
    constexpr int count = 256;
    for (int k = 0; k < count; ++k) {
      if (const auto x = set_.any_point(random_)) {
        add_seed(*x);
      }
    }
  }

  void add_seed(const seven_coordinates& x) {
    const auto kernel = std::size_t(set_.kernel(x).cols());
    is_degenerate_ = is_degenerate_ || kernel > 1;
    seeds_[kernel].push_back(x);
  }

  [[nodiscard]] bool is_known(const seven_coordinates& x, int kernel) {
    return std::any_of(components_.begin(), components_.end(), [&](const traced_curve& component) {
      return component.dimension > 1 ? kernel > 1 && sampler_.is_on(component, x, random_)
                                     : tracer_.is_on(component, x, kernel);
    });
  }

  void add(const seven_coordinates& x, int kernel) {
    if (is_known(x, kernel)) {
      return;
    }
    if (kernel == 1) {
      components_.push_back(tracer_.trace(x, set_.kernel(x).col(0), 1));
    } else if (set_.dimension(x, step, random_) == 0) {
      components_.push_back({{x}, false, 0, kernel});
    } else {
      add_near(x);
    }
  }

  /// Adds components near a singular point, at which several of them may cross.
  void add_near(const seven_coordinates& singular) {
    struct neighbour {
      seven_coordinates x;
      int kernel;
    };
    const auto basis = set_.kernel(singular);
    std::vector<neighbour> neighbours;
    for (int k = 0; k < 4 * basis.cols(); ++k) {
      const auto x = set_.neighbour(singular, step, basis, random_);
      if (x && set_.difference(*x, singular).norm() > small_step) {
        neighbours.push_back({*x, int(set_.kernel(*x).cols())});
      }
    }
    std::sort(neighbours.begin(), neighbours.end(),
              [](const neighbour& a, const neighbour& b) { return a.kernel < b.kernel; });
    for (const auto& [x, kernel] : neighbours) {
      if (is_known(x, kernel)) {
        continue;
      }
      const int dimension = std::min(set_.dimension(x, small_step, random_),
                                     set_.dimension(x, small_step / 8, random_));
      if (dimension > 1) {
        components_.push_back(sampler_.sample(x, dimension, kernel, random_));
      } else if (dimension == 1) {
        const seven_coordinates along = set_.difference(x, singular).normalized();
        components_.push_back(tracer_.trace(x, along, kernel));
      }
    }
  }

  static constexpr double step = .05, small_step = .005; ///< steps from a singular point to others

  const redundant_arm& arm_;
  self_motion_set set_;
  curve_tracer tracer_;
  surface_sampler sampler_;
  double resolution_;
  splitmix64 random_{1};
  bool is_degenerate_ = false; ///< true if the tip pose is known to be singular
  std::array<std::vector<seven_coordinates>, 8> seeds_; ///< seeds by null-space dimension
  std::vector<traced_curve> components_;
};

#ifdef DUET_DEFINES_COMPILED
DUET_COMPILED_FUNCTION std::vector<traced_curve> all_curves(const redundant_arm& arm,
                                                            double resolution) {
  return component_search(arm, resolution)();
}
#endif

} // namespace duet::detail
