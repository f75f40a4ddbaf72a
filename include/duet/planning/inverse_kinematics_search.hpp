// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/core/errors.hpp>
#include <duet/mechanism/serial_chain.hpp>
#include <duet/planning/bounded_step.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/planning/small_vector.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

/// \file
/// The search for joint coordinates that take the tip of a chain to a pose.

namespace duet {

/// Settings of `inverse_kinematics`.
struct inverse_kinematics_options {
  /// How close the tip comes to the goal, in units of length and radians.
  double tolerance = 1e-6;
  /// How many random configurations to begin anew from once the given start has led nowhere.
  int restarts = 100;
  /// The most from each of them.
  int iterations = 50;
  /// Of the random configurations.
  std::uint64_t seed = 1;
};

/// What was found; where `reason` is not `reached`, the nearest to the goal that was met with.
///
/// \tparam N  as of `serial_chain`
template <int N>
struct inverse_kinematics_result {
  detail::joint_vector<double, N> joints; ///< within the limits
  pose_deviation deviation;               ///< of the tip from the goal
  int iterations = 0;                     ///< from all configurations together
  int restarts = 0;                       ///< how many random configurations it began anew from
  /// Why it ended: `reached` where the tip is at the goal, else what is in the way.
  stop_reason reason = stop_reason::no_progress;

  /// For those who extend duet: for `to_text`.
  void for_each_field(const auto& f) const {
    f("joints", joints);
    f("deviation", deviation);
    f("iterations", iterations);
    f("restarts", restarts);
    f("reason", reason);
  }
};

namespace detail {

/// \throws invalid_input
inline void require_options(const inverse_kinematics_options& options) {
  constexpr const char* caller = "inverse_kinematics";
  require_positive(caller, "tolerance", options.tolerance);
  require_positive(caller, "iterations", options.iterations);
  require_option(caller, "restarts", options.restarts, options.restarts >= 0, "a number from 0 up");
}

/// Numbers from 0 to 1, the same on every machine: SplitMix64 (Steele, Lea, Flood, Fast splittable
/// pseudorandom number generators, 2014). `<random>` would cost the compiler more than the search.
class split_mix {
public:
  explicit split_mix(std::uint64_t seed) : state_(seed) {}

  [[nodiscard]] double operator()() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30U) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27U) * 0x94d049bb133111eb;
    return double((z ^ z >> 31U) >> 11U) * 0x1p-53;
  }

private:
  std::uint64_t state_;
};

/// What all searches for configurations of a chain have in common.
template <int Room>
class inverse_kinematics_search {
  using vector = small_vector<Room>;

public:
  struct attempt {
    vector joints;
    pose_deviation left;
    double error; ///< |e|²
    int iterations = 0;
    int restarts = 0;
    stop_reason reason = stop_reason::no_progress;
  };

  inverse_kinematics_search(const planning_model<Room>& model, const vector& start,
                            const inverse_kinematics_options& options)
      : model_(model), options_(options), start_(start) {
    require_options(options);
    for (int i = 0; i < model.size; ++i) {
      require(start[i] - start[i] == 0, "duet: inverse_kinematics: the start has ", start[i],
              " for joint ", i);
      const bool turns = model.turns[std::size_t(i)];
      constexpr double turn = 2 * std::numbers::pi;
      const bool has_turn =
          turns && !model.slides[std::size_t(i)] && model.upper[i] - model.lower[i] >= turn;
      turn_[i] = has_turn ? turn : 0;
      beyond_[i] = has_turn ? std::numeric_limits<double>::infinity() : 0;
      spread_[i] = turns ? std::numbers::pi : model.reach.scale();
    }
    start_ = within_limits(start_);
  }

  [[nodiscard]] attempt operator()(const tip_place& goal) const;

private:
  /// What is left to do at some θ: J Δ = e. Lengths count as parts of the chain's.
  struct equations {
    chain_state<Room> at;
    small_twist e;
    pose_deviation left;
  };

  [[nodiscard]] equations equations_at(const vector& theta, const tip_place& goal) const {
    equations result{model_.at(theta), {}, {}};
    const tip_place& tip = result.at.tip;
    result.e = error_twist(tip, goal);
    result.left = {length_of(goal.translation - tip.translation), deviation_of(result.e).angle};
    const double per_length = 1 / model_.reach.scale();
    for (std::ptrdiff_t k = 0; k < 3; ++k) {
      result.e[k] *= per_length;
      for (std::ptrdiff_t i = 0; i < model_.size; ++i) {
        result.at.jacobian(k, i) *= per_length;
      }
    }
    return result;
  }

  /// Levenberg and Marquardt's step.
  [[nodiscard]] bounded_step_result<vector> step(const equations& x) const {
    const vector& theta = x.at.theta;
    return bounded_step(x.at.jacobian, x.e, model_.lower - theta - beyond_,
                        model_.upper - theta + beyond_, std::min(.02 * dot(x.e, x.e), .08) + 1e-9);
  }

  [[nodiscard]] attempt approach(vector theta, const tip_place& goal) const {
    attempt best{theta, {}, std::numeric_limits<double>::infinity()};
    double before = best.error;
    int since = 0; // the error last fell by a tenth
    for (int iteration = 0;; ++iteration) {
      const equations now = equations_at(theta, goal);
      const double error = dot(now.e, now.e);
      const bool is_reached =
          now.left.length <= options_.tolerance && now.left.angle <= options_.tolerance;
      if (iteration == 0 || error < best.error || is_reached) {
        best = {theta, now.left, error};
      }
      if (error < .9 * before) {
        before = error;
        since = 0;
      }
      best.iterations = iteration;
      if (is_reached || since == 4 || iteration == options_.iterations) {
        best.reason = is_reached   ? stop_reason::reached
                      : since == 4 ? stop_reason::no_progress
                                   : stop_reason::iteration_limit;
        return best;
      }
      ++since;
      theta = within_limits(theta + step(now).step);
    }
  }

  /// Why there is no way on from a configuration.
  [[nodiscard]] stop_reason obstacle(const vector& theta, const tip_place& goal) const {
    const equations here = equations_at(theta, goal);
    if (step(here).is_bounded) {
      return stop_reason::joint_limit;
    }
    const damped_gram gram(gram_of(here.at.jacobian));
    return model_.size >= 6 && gram.smallest() < 10 * damping_threshold ? stop_reason::singular
                                                                        : stop_reason::no_progress;
  }

  /// Turning joints whose range holds a whole turn are turned back into it, others stop at limits.
  [[nodiscard]] vector within_limits(vector theta) const {
    for (std::ptrdiff_t i = 0; i < model_.size; ++i) {
      const double lower = model_.lower[i], upper = model_.upper[i];
      if (turn_[i] > 0 && theta[i] > upper) {
        theta[i] -= turn_[i] * std::ceil((theta[i] - upper) / turn_[i]);
      } else if (turn_[i] > 0 && theta[i] < lower) {
        theta[i] += turn_[i] * std::ceil((lower - theta[i]) / turn_[i]);
      }
      theta[i] = std::clamp(theta[i], lower, upper);
    }
    return theta;
  }

  /// Uniform within the limits; without them, about the start.
  [[nodiscard]] vector configuration(split_mix& random) const {
    vector theta;
    for (std::ptrdiff_t i = 0; i < model_.size; ++i) {
      double lower = model_.lower[i], upper = model_.upper[i];
      if (!(upper - lower < std::numeric_limits<double>::infinity())) {
        lower = std::max(lower, start_[i] - spread_[i]);
        upper = std::min(upper, start_[i] + spread_[i]);
      }
      theta[i] = lower + (upper - lower) * random();
    }
    return theta;
  }

  const planning_model<Room>& model_;
  inverse_kinematics_options options_;
  vector turn_;   ///< a whole turn where it leads to the same pose within limits, else 0
  vector beyond_; ///< how far steps may go beyond limits: any way if they are turned back
  vector spread_; ///< how far from the start random coordinates are that have no limits
  vector start_;
};

template <int Room>
typename inverse_kinematics_search<Room>::attempt
inverse_kinematics_search<Room>::operator()(const tip_place& goal) const {
  if (model_.reach.is_beyond(goal, options_.tolerance)) {
    return {start_, equations_at(start_, goal).left, 0, 0, 0, stop_reason::out_of_reach};
  }
  attempt best = approach(start_, goal);
  int iterations = best.iterations, restarts = 0;
  split_mix random(options_.seed);
  while (best.reason != stop_reason::reached && restarts < options_.restarts) {
    const attempt next = approach(configuration(random), goal);
    iterations += next.iterations;
    ++restarts;
    if (!(best.error <= next.error)) { // nor is it a number if coordinates overflow
      best = next;
    }
  }
  if (best.reason == stop_reason::no_progress) {
    best.reason = obstacle(best.joints, goal);
  }
  best.iterations = iterations;
  best.restarts = restarts;
  return best;
}

#ifdef DUET_COMPILED
DUET_COMPILED_TEMPLATE class inverse_kinematics_search<8>;
DUET_COMPILED_TEMPLATE class inverse_kinematics_search<16>;
#endif

} // namespace detail
} // namespace duet
