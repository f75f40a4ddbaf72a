// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../../src/robotics/tip_pose.hpp"

#include "robotics/limits.hpp"

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/all_inverse_kinematics.hpp>

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

/// \file
/// Complete search for the parameter up to which an arm of six joints can follow a path.

namespace duet_test {

/// Parameter at which a path ends, and the reason: `joint_limit` if a solution continues beyond the
/// limits, `singular` if it ends, `no_progress` if the search cannot decide.
struct path_verdict {
  double end = 0;
  duet::stop_reason why = duet::stop_reason::no_progress;
  /// True if limits end the path, and without them it would end within 1e-4 as well: both reasons
  /// are true. Not determined for six joints.
  bool is_both = false;
};

/// Follows all solutions of an arm along a path from one of them, by what `all_inverse_kinematics`
/// finds at parameters as close as need be: 1/128 of the path, or 2⁻³⁰ of it where solutions do not
/// go on. Two of them are connected where joints that move straight on from one to the other keep
/// the tip within 1e-5 of the path. At the start and where a determinant changes its sign the
/// joints may also move with the tip fixed. Joints respect their limits and do not jump by full
/// turns.
class complete_search {
public:
  using joints = Eigen::Matrix<double, 6, 1>;
  using path_function = std::function<duet::dual_quaternion<double>(double)>;

  complete_search(const duet::serial_chain<6>& arm, path_function path)
      : arm_(arm), path_(std::move(path)) {}

  [[nodiscard]] path_verdict operator()(const joints& start) {
    constexpr int parts = 128;
    verdict_ = {};
    std::vector<joints> current = leave(start, 0);
    for (int k = 0; k < parts && !current.empty(); ++k) {
      current =
          advance(current, k == 0 ? near_offset : double(k) / parts, double(k + 1) / parts, 23);
    }
    if (!current.empty()) {
      verdict_ = {1, duet::stop_reason::reached};
    }
    return verdict_;
  }

  /// Exact configuration at u nearest to an approximate one; nothing if none is within limits.
  [[nodiscard]] std::optional<joints> exact(double u, const joints& x) const {
    const joints y = at(u, x);
    return deviation(y, path_(u)) < 1e-12 && (y - x).norm() < .01 && is_within_limits(arm_, y, 1e-9)
               ? std::optional(y)
               : std::nullopt;
  }

private:
  static constexpr double near_offset = 1e-4, fibre_step = .02;

  /// Larger one of the errors of the tip in length and angle.
  [[nodiscard]] double deviation(const joints& x, const duet::dual_quaternion<double>& pose) const {
    const auto error = duet::pose_error_between(arm_.pose(x), pose);
    return std::max(error.translation, error.rotation);
  }

  using decomposition = Eigen::JacobiSVD<Eigen::Matrix<double, 6, 6>>;
  [[nodiscard]] decomposition jacobian_at(const joints& x) const {
    return decomposition(duet::jacobian(arm_, x, duet::frame::hybrid),
                         Eigen::ComputeFullU | Eigen::ComputeFullV);
  }

  /// Configuration at a pose by Newton's method.
  ///
  /// \param singular  singular value, relative to the largest, that counts as zero; or nothing
  [[nodiscard]] joints solved(const duet::dual_quaternion<double>& pose, joints x,
                              std::optional<double> singular = {}) const {
    for (int round = 0; round < 5; ++round) {
      decomposition svd = jacobian_at(x);
      if (singular) {
        svd.setThreshold(*singular);
      }
      x += svd.solve(duet::detail::error_twist(duet::detail::to_tip_pose(arm_.pose(x)),
                                               duet::detail::to_tip_pose(pose)));
    }
    return x;
  }
  [[nodiscard]] joints at(double u, const joints& x) const { return solved(path_(u), x); }

  /// All solutions at u, each moved next to x by full turns, and the result of Newton's method from
  /// x: `all_inverse_kinematics` may miss solutions that are singular up to round-off.
  [[nodiscard]] std::vector<joints> solutions(double u, const joints& x) {
    if (u != known_at_ || known_.empty()) {
      known_at_ = u;
      known_.clear();
      for (const auto& each : duet::all_inverse_kinematics(arm_, path_(u)).solutions) {
        known_.push_back(each.joints);
      }
    }
    constexpr double full_turn = 2 * std::numbers::pi;
    std::vector<joints> result = known_;
    for (joints& each : result) {
      for (int i = 0; i < 6; ++i) {
        each[i] += full_turn * std::round((x[i] - each[i]) / full_turn);
      }
    }
    const joints nearby = at(u, x);
    if (deviation(nearby, path_(u)) < 1e-12) {
      add(result, nearby);
    }
    return result;
  }

  [[nodiscard]] bool is_link(const joints& x, double u, const joints& y, double v) const {
    if ((y - x).norm() > .5) {
      return false;
    }
    for (const double part : {.5, .25, .75}) {
      if (deviation((1 - part) * x + part * y, path_((1 - part) * u + part * v)) > 1e-5) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] double determinant(const joints& x) const {
    const Eigen::Matrix<double, 6, 6> j = duet::jacobian(arm_, x, duet::frame::hybrid);
    return j.determinant();
  }

  static void add(std::vector<joints>& to, const joints& x) {
    if (std::none_of(to.begin(), to.end(),
                     [&](const joints& each) { return (each - x).norm() < 1e-7; })) {
      to.push_back(x);
    }
  }

  /// Configurations at b that can be reached from those of `from` at a.
  [[nodiscard]] std::vector<joints> advance(const std::vector<joints>& from, double a, double b,
                                            int halvings) {
    std::vector<joints> result;
    bool is_lost = false, is_beyond = false, is_singular = false;
    for (const joints& x : from) {
      bool goes_on = false, goes_beyond = false;
      for (const joints& y : solutions(b, x)) {
        if (!is_link(x, a, y, b)) {
          continue;
        }
        if (!is_within_limits(arm_, y, 1e-9)) {
          goes_beyond = true;
          continue;
        }
        goes_on = true;
        add(result, y);
        if (halvings == 0) {
          continue;
        }
        if (determinant(x) * determinant(y) < 0) {
          for (const joints& z : cross(x, a, y, b)) {
            add(result, z);
          }
        }
      }
      is_lost = is_lost || !goes_on;
      is_beyond = is_beyond || goes_beyond;
      is_singular = is_singular || (!goes_on && !goes_beyond && std::abs(determinant(x)) < 1e-3);
    }
    if (!is_lost) {
      return result;
    }
    if (halvings > 0) {
      const double midpoint = (a + b) / 2;
      const auto reached = advance(from, a, midpoint, halvings - 1);
      return reached.empty() ? reached : advance(reached, midpoint, b, halvings - 1);
    }
    if (result.empty() && a >= verdict_.end) {
      verdict_ = {a, is_beyond     ? duet::stop_reason::joint_limit
                     : is_singular ? duet::stop_reason::singular
                                   : duet::stop_reason::no_progress};
    }
    return result;
  }

  /// Configurations at b that can be reached from x through a singularity between x and y, with
  /// self-motions in the singularity.
  [[nodiscard]] std::vector<joints> cross(joints x, double a, const joints& y, double b) {
    const double end = b;
    joints z = y;
    while (b - a > 1e-9) {
      const double u = (a + b) / 2;
      const joints midpoint = (x + z) / 2;
      const auto all = solutions(u, midpoint);
      const auto nearest =
          std::min_element(all.begin(), all.end(), [&](const auto& p, const auto& q) {
            return (p - midpoint).norm() < (q - midpoint).norm();
          });
      if (nearest == all.end() || (*nearest - midpoint).norm() > (z - x).norm() + 1e-9) {
        return {};
      }
      (determinant(*nearest) * determinant(x) > 0 ? x : z) = *nearest;
      (z == *nearest ? b : a) = u;
    }
    const joints midpoint = (x + z) / 2;
    if (fibre(midpoint, path_(a), true).size() < 3) {
      return {};
    }
    const double next = a + near_offset;
    if (next > end) {
      return {};
    }
    const auto reached = leave(midpoint, a);
    return reached.empty() ? reached : advance(reached, next, end, 20);
  }

  /// Configurations at u + `near_offset` that can be reached after a self-motion at u.
  [[nodiscard]] std::vector<joints> leave(const joints& from, double u) {
    const auto all = fibre(from, path_(u), true);
    if (all.size() < 3) {
      return advance({from}, u, u + near_offset, 17);
    }
    std::vector<joints> result;
    const auto next_to = [&](const std::vector<joints>& these) {
      bool is_any = false;
      for (const joints& x : these) {
        for (const joints& y : solutions(u + near_offset, x)) {
          const bool is_near = (y - x).norm() < fibre_step;
          is_any = is_any || is_near;
          if (is_near && is_within_limits(arm_, y, 1e-9)) {
            add(result, y);
          }
        }
      }
      return is_any;
    };
    const bool is_any = next_to(all);
    if (result.empty() && u >= verdict_.end) {
      verdict_ = {u, is_any || next_to(fibre(from, path_(u), false))
                         ? duet::stop_reason::joint_limit
                         : duet::stop_reason::singular};
      result.clear();
    }
    return result;
  }

  /// Configurations that a singular one reaches by self-motions, in small steps.
  [[nodiscard]] std::vector<joints>
  fibre(const joints& from, const duet::dual_quaternion<double>& pose, bool keeps_limits) const {
    std::vector<joints> result{from};
    for (const double side : {1., -1.}) {
      joints x = from, direction = joints::Zero();
      for (int k = 0; k < 2000; ++k) {
        const decomposition svd = jacobian_at(x);
        const joints along = svd.matrixV().col(5);
        if (svd.singularValues()[5] > 1e-4) {
          break;
        }
        direction =
            k == 0 ? joints(side * along) : joints(along.dot(direction) < 0 ? -along : along);
        const joints y = solved(pose, x + fibre_step * direction, 1e-4);
        if (deviation(y, pose) > 1e-9 || (y - x).dot(direction) < .7 * fibre_step ||
            (keeps_limits && !is_within_limits(arm_, y, 1e-9))) {
          break;
        }
        result.push_back(y);
        x = y;
        if (k > 3 && (y - from).norm() < .7 * fibre_step) {
          break;
        }
      }
    }
    return result;
  }

  const duet::serial_chain<6>& arm_;
  path_function path_;
  path_verdict verdict_;
  double known_at_ = -1;
  std::vector<joints> known_;
};

/// Verdict from the start of a plan, and from its waypoints: within its tolerance the plan may have
/// passed poses of the path that are not exactly within reach.
template <class Plan>
[[nodiscard]] path_verdict complete_path_verdict(const duet::serial_chain<6>& arm,
                                                 const complete_search::path_function& path,
                                                 const Plan& plan) {
  path_verdict result = complete_search(arm, path)(plan.joints.front());
  for (std::size_t k = 1; k < plan.tau.size(); ++k) {
    const double begin = plan.tau[k];
    if (begin == 1 || begin < result.end + 1e-4) {
      continue;
    }
    complete_search rest(arm, [&](double u) { return path(begin + (1 - begin) * u); });
    if (const auto x = rest.exact(0, plan.joints[k])) {
      const path_verdict verdict = rest(*x);
      result = {begin + (1 - begin) * verdict.end, verdict.why};
    }
  }
  return result;
}

} // namespace duet_test
