// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "path_planner.hpp"
#include "planning_model.hpp"
#include "singularity.hpp"

#include <duet/core/errors.hpp>
#include <duet/core/text/printable.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/quaternion/norm.hpp>
#include <duet/robotics/follow_path.hpp>
#include <duet/robotics/plan_screw_motion.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace duet::detail {
namespace {

void require_options(const plan_options& o, const char* caller) {
  require_positive(caller, "tolerance", o.tolerance);
  require_positive(caller, "deviation", o.deviation);
  require_positive(caller, "largest_step", o.largest_step);
  require_positive(caller, "smallest_step", o.smallest_step);
  require_positive(caller, "self_motion_step", o.self_motion_step);
  require_option(caller, "centring", o.centring, o.centring >= 0, "a non-negative number");
  require_option(caller, "search_step", o.search_step,
                 o.search_step == 0 || (o.search_step >= 1e-6 && o.search_step <= 1),
                 "0 or a number from 1e-6 to 1");
}

/// `body 3 (wrist)`
[[nodiscard]] std::string name_of_body(const scene& around, std::size_t i) {
  const std::string& name = around.bodies[i].name;
  return "body " + std::to_string(i) + (name.empty() ? "" : " (" + name + ")");
}

/// \throws invalid_input if obstacles are closer than their margin
void require_clearance(const chain_clearance<double>& closest, const scene& around,
                       double tolerance) {
  if (!(closest.distance >= around.margin - tolerance)) {
    raise(invalid_input(
        printable(message("duet: follow_path: at the start ", name_of_body(around, closest.body),
                          " is ", closest.distance, " from ",
                          closest.is_self ? name_of_body(around, closest.other)
                                          : "obstacle " + std::to_string(closest.other),
                          ", closer than the margin of ", around.margin))));
  }
}

/// Plan along a path; if its end is certainly out of reach and `may_be_out_of_reach`, the start
/// alone.
template <int Capacity>
[[nodiscard]] motion_plan
planned(const planning_model<Capacity>& model, const Eigen::VectorXd& start,
        const path_function& target, const std::vector<double>& stops, const plan_options& options,
        const objective_view& objective, const scene* around, bool may_be_out_of_reach) {
  using vector = small_vector<Capacity>;
  const vector theta = model.joints(start);
  const tip_path scaled_path = [&](double u) { return model.scaled_pose(target(u)); };
  const auto start_error =
      model.unscaled_error(pose_error_between(model.at(theta).tip, scaled_path(stops.front())));
  require(options.tolerance.ratio(start_error) <= 1, "duet: follow_path: the path begins ",
          start_error.translation, " units of length and ", start_error.rotation,
          " rad away from the tip at the start");
  if (around != nullptr) {
    require_clearance(model.nearest_obstacle(theta), *around, options.tolerance.translation);
  }
  if (objective && std::isnan(objective(start))) {
    fail_not_a_number("duet: follow_path: the objective is nan at the start,", start);
  }
  std::function<vector(const vector&)> objective_gradient;
  if (objective) {
    objective_gradient = [&](const vector& x) {
      // Gradient with respect to coordinates in the planner's units.
      const Eigen::VectorXd gradient = objective.gradient(model.chain_joints(x));
      vector result;
      for (int i = 0; i < model.size; ++i) {
        result[i] = gradient[i] * model.unit[i];
      }
      return result;
    };
  }
  const bool is_out_of_reach =
      may_be_out_of_reach &&
      model.reach.is_beyond(scaled_path(stops.back()), model.tolerance(options.tolerance));
  path_planner<Capacity> planner(model, scaled_path, stops, options, objective_gradient);
  const auto joint_path = is_out_of_reach ? planner.stay(theta) : planner.plan(theta);
  motion_plan plan;
  for (const auto& w : joint_path.waypoints) {
    const Eigen::VectorXd joints =
        plan.joints.empty() ? start : Eigen::VectorXd(model.joints_within_limits(w.state.theta));
    add_waypoint(plan, model.chain(), joints, model.unscaled_pose(w.state.tip), w.u,
                 model.unscaled_error(w.residual));
    plan.smallest_clearance =
        std::min(plan.smallest_clearance, model.length * model.clearance(w.state.theta));
  }
  // The steps recorded, in the planner's units, where the singular value is smallest: at one end of
  // a step.
  const auto most_singular = std::min_element(
      joint_path.waypoints.begin(), joint_path.waypoints.end(), [](const auto& a, const auto& b) {
        return a.smallest_singular_value < b.smallest_singular_value;
      });
  for (auto w = most_singular - (most_singular != joint_path.waypoints.begin()); w <= most_singular;
       ++w) {
    plan.smallest_singular_value =
        std::min(plan.smallest_singular_value,
                 smallest_singular_value_of(model.unscaled_jacobian(w->state.jacobian)));
  }
  plan.iterations = planner.iterations();
  plan.reason = is_out_of_reach ? stop_reason::out_of_reach : planner.reason(joint_path);
  return plan;
}

/// Path along screw motions from pose to pose, pose i at the parameter i.
struct path_through {
  std::vector<dual_quaternion<double>> poses;

  [[nodiscard]] dual_quaternion<double> operator()(double u) const {
    const std::size_t i = std::min(std::size_t(u), poses.size() - 1);
    const std::size_t next = std::min(i + 1, poses.size() - 1);
    return sclerp(poses[i], poses[next], u - double(i));
  }
};

/// Shorter screw motion between two poses (N19), as a function of τ.
[[nodiscard]] path_function screw_path(const dual_quaternion<double>& first,
                                       const dual_quaternion<double>& last) {
  dual_quaternion<double> between = conj(first) * normalized(last);
  if (innermost(between.w()) < 0) {
    between = -between;
  }
  return [first, half = log_vector(between, "plan_screw_motion")](double tau) {
    return dual_quaternion<double>(first *
                                   exp(dual_vector<double>(half * screw_dual<double>(tau))));
  };
}

} // namespace

DUET_ABI_BEGIN

motion_plan follow(const chain_view& chain, const Eigen::Ref<const Eigen::VectorXd>& start,
                   const path_function& target, const std::vector<double>& stops,
                   const plan_options& options, const objective_view& objective,
                   const scene* around) {
  require_options(options, "follow_path");
  return with_capacity(chain.size(), [&]<int Capacity>(std::integral_constant<int, Capacity>) {
    return planned(planning_model<Capacity>(chain, around), start, target, stops, options,
                   objective, around, false);
  });
}

motion_plan follow_poses(const chain_view& chain, const Eigen::Ref<const Eigen::VectorXd>& start,
                         std::span<const dual_quaternion<double>> poses,
                         const plan_options& options, const objective_view& objective,
                         const scene* around) {
  require(!poses.empty(), "duet: follow_path: the list of poses is empty");
  path_through target;
  std::vector<double> stops;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    require_pose(poses[i], "follow_path", "pose " + std::to_string(i));
    target.poses.push_back(normalized(poses[i]));
    stops.push_back(double(i));
  }
  return follow(chain, start, target, stops, options, objective, around);
}

motion_plan plan_screw_motion(const chain_view& chain,
                              const Eigen::Ref<const Eigen::VectorXd>& start,
                              const dual_quaternion<double>& goal, const plan_options& options,
                              const objective_view& objective, const scene* around) {
  require_options(options, "plan_screw_motion");
  return with_capacity(chain.size(), [&]<int Capacity>(std::integral_constant<int, Capacity>) {
    const planning_model<Capacity> model(chain, around);
    const auto first = model.unscaled_pose(model.at(model.joints(start)).tip);
    return planned(model, start, screw_path(first, goal), {0, 1}, options, objective, around, true);
  });
}

DUET_ABI_END
} // namespace duet::detail
