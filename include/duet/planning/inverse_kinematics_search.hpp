// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/comparison/random_source.hpp>
#include <duet/core/errors.hpp>
#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/mechanism/jacobian.hpp>
#include <duet/planning/bounded_step.hpp>
#include <duet/planning/motion_plan.hpp>
#include <duet/planning/path_step.hpp>
#include <duet/planning/plan_options.hpp>
#include <duet/planning/reach.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
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

/// A chain with what all searches on it have in common.
template <class C>
class inverse_kinematics_search {
  using vector = joint_vector<double, C::joints>;
  using result_type = inverse_kinematics_result<C::joints>;

public:
  template <class Start>
  inverse_kinematics_search(const C& chain, const Start& start,
                            const inverse_kinematics_options& options)
      : chain_(chain), options_(options), reach_(chain), lower_(lower_limits(chain)),
        upper_(upper_limits(chain)), turn_(chain.size()), beyond_(chain.size()) {
    require_options(options);
    require_size(chain, start);
    start_ = joint_vector_of(chain, start);
    for (int i = 0; i < chain.size(); ++i) {
      if (!(start_[i] - start_[i] == 0)) {
        std::ostringstream message;
        message << "duet: inverse_kinematics: the start has " << start_[i] << " for joint " << i;
        throw invalid_input(message.str());
      }
      const auto& step = chain.steps()[std::size_t(i)];
      constexpr double turn = 2 * std::numbers::pi;
      turn_[i] = step.turns && !step.slides && upper_[i] - lower_[i] >= turn ? turn : 0;
      beyond_[i] = turn_[i] > 0 ? std::numeric_limits<double>::infinity() : 0;
    }
    start_ = within_limits(start_);
  }

  /// \param goal  a unit dual quaternion
  [[nodiscard]] result_type operator()(const dual_quaternion<double>& goal) const {
    if (reach_.is_beyond(goal, options_.tolerance)) {
      result_type result{start_, deviation_between(chain_.pose(start_), goal)};
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
    chain_jacobian<C, vector> jacobian;
    vector6<double> e;
    pose_deviation left;
  };

  [[nodiscard]] equations equations_at(const vector& theta,
                                       const dual_quaternion<double>& goal) const {
    const auto [a, m] = pose_and_jacobian(chain_, theta, frame::hybrid);
    equations result{m, error_twist(a, goal), {}};
    result.left = {(translation(goal) - translation(a)).norm(), result.e.template tail<3>().norm()};
    result.jacobian.template topRows<3>() /= reach_.scale();
    result.e.template head<3>() /= reach_.scale();
    return result;
  }

  /// Levenberg and Marquardt's step.
  [[nodiscard]] auto step(const vector& theta, const equations& at) const {
    const double damping = std::min(.02 * at.e.squaredNorm(), .08) + 1e-9;
    return bounded_step(at.jacobian, at.e, vector(lower_ - theta - beyond_),
                        vector(upper_ - theta + beyond_), [&](matrix6<double> gram) {
                          gram.diagonal().array() += damping;
                          return Eigen::LLT<matrix6<double>>(gram);
                        });
  }

  [[nodiscard]] attempt approach(vector theta, const dual_quaternion<double>& goal) const {
    attempt best{{theta, {}}, std::numeric_limits<double>::infinity()};
    double before = best.error;
    int since = 0; // the error last fell by a tenth
    for (int iteration = 0;; ++iteration) {
      const equations at = equations_at(theta, goal);
      const double error = at.e.squaredNorm();
      const bool is_reached =
          at.left.length <= options_.tolerance && at.left.angle <= options_.tolerance;
      if (iteration == 0 || error < best.error || is_reached) {
        best = {{theta, at.left}, error};
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
      theta = within_limits(vector(theta + step(theta, at).step));
    }
  }

  /// Why there is no way on from a configuration.
  [[nodiscard]] stop_reason obstacle(const vector& theta,
                                     const dual_quaternion<double>& goal) const {
    const equations at = equations_at(theta, goal);
    if (step(theta, at).is_bounded) {
      return stop_reason::joint_limit;
    }
    const damped_gram gram(matrix6<double>(at.jacobian * at.jacobian.transpose()));
    return chain_.size() >= 6 && gram.smallest() < 10 * damping_threshold
               ? stop_reason::singular
               : stop_reason::no_progress;
  }

  /// Turning joints whose range holds a whole turn are turned back into it, others stop at limits.
  [[nodiscard]] vector within_limits(vector theta) const {
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      if (turn_[i] > 0 && theta[i] > upper_[i]) {
        theta[i] -= turn_[i] * std::ceil((theta[i] - upper_[i]) / turn_[i]);
      } else if (turn_[i] > 0 && theta[i] < lower_[i]) {
        theta[i] += turn_[i] * std::ceil((lower_[i] - theta[i]) / turn_[i]);
      }
      theta[i] = std::clamp(theta[i], lower_[i], upper_[i]);
    }
    return theta;
  }

  /// Uniform within the limits; without them, about the start.
  [[nodiscard]] vector configuration(random_source& random) const {
    vector theta = start_;
    for (int i = 0; i < chain_.size(); ++i) {
      double lower = lower_[i], upper = upper_[i];
      if (!(upper - lower < std::numeric_limits<double>::infinity())) {
        const auto& step = chain_.steps()[std::size_t(i)];
        const double most = step.turns ? std::numbers::pi : reach_.scale();
        lower = std::max(lower, start_[i] - most);
        upper = std::min(upper, start_[i] + most);
      }
      theta[i] = random.uniform(lower, upper);
    }
    return theta;
  }

  const C& chain_;
  inverse_kinematics_options options_;
  chain_reach reach_;
  vector lower_, upper_;
  vector turn_;   ///< a whole turn where it leads to the same pose within limits, else 0
  vector beyond_; ///< how far steps may go beyond limits: any way if they are turned back
  vector start_;
};

} // namespace detail
} // namespace duet
