// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>
#include <duet/core/random_source.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/planning/bounded_step.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/plan_options.hpp>
#include <duet/planning/planning_model.hpp>
#include <duet/planning/reach.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <sstream>

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
  int restarts = 0;
  stop_reason reason = stop_reason::no_progress;
};

namespace detail {

/// \throws invalid_input
inline void require_options(const inverse_kinematics_options& options) {
  constexpr const char* caller = "inverse_kinematics";
  require_positive_option(caller, "tolerance", options.tolerance);
  require_positive_option(caller, "iterations", options.iterations);
  require_option(options.restarts >= 0, caller, "restarts", options.restarts, "a number from 0 up");
}

inline void require_finite_start(Eigen::Index joint, double x) {
  if (!(x - x == 0)) {
    std::ostringstream message;
    message << "duet: inverse_kinematics: the start has " << x << " for joint " << joint;
    throw invalid_input(message.str());
  }
}

/// What all searches for configurations of a chain have in common.
template <int N>
class inverse_kinematics_search {
  using vector = joint_vector<double, N>;
  using result_type = inverse_kinematics_result<N>;

public:
  template <class C>
  inverse_kinematics_search(const C& chain, const vector& start,
                            const inverse_kinematics_options& options)
      : set_([&chain](chain_state<N>& state, const vector& theta) {
          set_state(state, chain, theta);
        }),
        options_(options), reach_(chain), lower_(lower_limits(chain)), upper_(upper_limits(chain)),
        turn_(start), beyond_(start), spread_(start), start_(start) {
    require_options(options);
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      require_finite_start(i, start[i]);
      const auto& step = chain.steps()[std::size_t(i)];
      constexpr double turn = 2 * std::numbers::pi;
      const bool has_turn = step.turns && !step.slides && upper_[i] - lower_[i] >= turn;
      turn_[i] = has_turn ? turn : 0;
      beyond_[i] = has_turn ? std::numeric_limits<double>::infinity() : 0;
      spread_[i] = step.turns ? std::numbers::pi : reach_.scale();
    }
    start_ = within_limits(start_);
  }

  /// \param goal  a unit dual quaternion
  [[nodiscard]] result_type operator()(const dual_quaternion<double>& goal) const {
    if (reach_.is_beyond(goal, options_.tolerance)) {
      result_type result{start_, equations_at(start_, goal).left};
      result.reason = stop_reason::out_of_reach;
      return result;
    }
    attempt best = approach(start_, goal);
    int iterations = best.found.iterations, restarts = 0;
    std::optional<random_source> random; // its seeding takes as long as an iteration
    while (best.found.reason != stop_reason::reached && restarts < options_.restarts) {
      if (!random) {
        random.emplace(options_.seed);
      }
      const attempt next = approach(configuration(*random), goal);
      iterations += next.found.iterations;
      ++restarts;
      if (!(best.error <= next.error)) { // nor is it a number if coordinates overflow
        best = next;
      }
    }
    if (best.found.reason == stop_reason::no_progress) {
      best.found.reason = obstacle(best.found.joints, goal);
    }
    best.found.iterations = iterations;
    best.found.restarts = restarts;
    return best.found;
  }

private:
  struct attempt {
    result_type found;
    double error; ///< |e|²
  };
  /// What is left to do at some θ: J Δ = e. Lengths count as parts of the chain's.
  struct equations {
    chain_state<N> at;
    vector6<double> e;
    pose_deviation left;
  };

  [[nodiscard]] equations equations_at(const vector& theta,
                                       const dual_quaternion<double>& goal) const {
    equations result;
    set_(result.at, theta);
    const dual_quaternion<double>& a = result.at.pose;
    result.e = error_twist(a, goal);
    result.left = {(translation(goal) - translation(a)).norm(), result.e.template tail<3>().norm()};
    const double per_length = 1 / reach_.scale();
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      result.at.jacobian.col(i).template head<3>() *= per_length;
    }
    result.e.template head<3>() *= per_length;
    return result;
  }

  /// Levenberg and Marquardt's step.
  [[nodiscard]] bounded_step_result<vector> step(const equations& x) const {
    const vector& theta = x.at.theta;
    return bounded_step(x.at.jacobian, x.e, vector(lower_ - theta - beyond_),
                        vector(upper_ - theta + beyond_),
                        std::min(.02 * x.e.squaredNorm(), .08) + 1e-9);
  }

  [[nodiscard]] attempt approach(vector theta, const dual_quaternion<double>& goal) const {
    attempt best{{theta, {}}, std::numeric_limits<double>::infinity()};
    double before = best.error;
    int since = 0; // the error last fell by a tenth
    for (int iteration = 0;; ++iteration) {
      const equations now = equations_at(theta, goal);
      const double error = now.e.squaredNorm();
      const bool is_reached =
          now.left.length <= options_.tolerance && now.left.angle <= options_.tolerance;
      if (iteration == 0 || error < best.error || is_reached) {
        best = {{theta, now.left}, error};
      }
      if (error < .9 * before) {
        before = error;
        since = 0;
      }
      best.found.iterations = iteration;
      if (is_reached || since == 4 || iteration == options_.iterations) {
        best.found.reason = is_reached   ? stop_reason::reached
                            : since == 4 ? stop_reason::no_progress
                                         : stop_reason::iteration_limit;
        return best;
      }
      ++since;
      theta = within_limits(vector(theta + step(now).step));
    }
  }

  /// Why there is no way on from a configuration.
  [[nodiscard]] stop_reason obstacle(const vector& theta,
                                     const dual_quaternion<double>& goal) const {
    const equations here = equations_at(theta, goal);
    if (step(here).is_bounded) {
      return stop_reason::joint_limit;
    }
    const damped_gram gram(gram_matrix(here.at.jacobian));
    return theta.size() >= 6 && gram.smallest() < 10 * damping_threshold ? stop_reason::singular
                                                                         : stop_reason::no_progress;
  }

  /// Turning joints whose range holds a whole turn are turned back into it, others stop at limits.
  [[nodiscard]] vector within_limits(vector theta) const {
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      const double lower = lower_[i], upper = upper_[i];
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
  [[nodiscard]] vector configuration(random_source& random) const {
    vector theta = start_;
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      double lower = lower_[i], upper = upper_[i];
      if (!(upper - lower < std::numeric_limits<double>::infinity())) {
        lower = std::max(lower, start_[i] - spread_[i]);
        upper = std::min(upper, start_[i] + spread_[i]);
      }
      theta[i] = random.uniform(lower, upper);
    }
    return theta;
  }

  std::function<void(chain_state<N>&, const vector&)> set_; ///< a state to that at some θ
  inverse_kinematics_options options_;
  chain_reach reach_;
  vector lower_, upper_;
  vector turn_;   ///< a whole turn where it leads to the same pose within limits, else 0
  vector beyond_; ///< how far steps may go beyond limits: any way if they are turned back
  vector spread_; ///< how far from the start random coordinates are that have no limits
  vector start_;
};

} // namespace detail
} // namespace duet
