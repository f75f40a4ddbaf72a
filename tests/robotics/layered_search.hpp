// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../../src/robotics/tip_pose.hpp"

#include "robotics/complete_search.hpp"

#include "robotics/limits.hpp"

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/kinematics/jacobian.hpp>
#include <duet/kinematics/motion_plan.hpp>
#include <duet/kinematics/serial_chain.hpp>
#include <duet/robotics/self_motion_curves.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

/// \file
/// Search for the parameter up to which an arm of seven joints can follow a path with self-motions.

namespace duet_test {

/// All self-motion curves, layer by layer along a path, cut into components by limits, and the
/// components that can be reached from those of the layer before. Ranges of joints are less than a
/// full turn, so angles identify configurations.
class layered_search {
public:
  using joints = Eigen::Matrix<double, 7, 1>;
  using path_function = std::function<duet::dual_quaternion<double>(double)>;

  /// \param known  a configuration that is known to be within reach at a parameter, or nothing
  layered_search(const duet::serial_chain<7>& arm, path_function path,
                 std::function<std::optional<joints>(double)> known)
      : arm_(arm), path_(std::move(path)), known_(std::move(known)) {}

  [[nodiscard]] path_verdict operator()(const joints& start) const {
    constexpr int layers = 48;
    layer current = layer_at(0);
    reach(current, start);
    for (int k = 0; k < layers; ++k) {
      const double end = double(k + 1) / layers;
      double step = end - current.u;
      while (current.u < end) {
        layer next = layer_at(current.u + step > end - 1e-9 ? end : current.u + step);
        advance(current, next);
        if (next.reached.empty()) {
          step /= 4;
          if (step < min_step) {
            const bool is_beyond = goes_on_without_limits(current, 4 * min_step);
            return {current.u,
                    is_beyond ? duet::stop_reason::joint_limit : duet::stop_reason::singular,
                    is_beyond && !goes_on_without_limits(current, 1e-4)};
          }
        } else {
          current = std::move(next);
        }
      }
    }
    return {1, duet::stop_reason::reached};
  }

private:
  static constexpr double min_step = 1e-6, resolution = .2;
  static constexpr int none = -1;

  struct point {
    joints x;
    int curve, component; ///< `none`: outside the limits
    std::ptrdiff_t next;  ///< on its curve
  };
  struct layer {
    double u;
    std::vector<point> points;
    int component_count = 0;
    std::set<int> reached;
    std::vector<joints> isolated; ///< reached configurations on no component with points
  };

  [[nodiscard]] layer layer_at(double u) const {
    layer result;
    result.u = u;
    int number = 0;
    for (const auto& curve : duet::self_motion_curves(arm_, path_(u), {resolution})) {
      const std::size_t first = result.points.size();
      for (joints x : curve.joints) {
        for (int i = 0; i < 7; ++i) {
          const double centre = (arm_.limits(i).lower + arm_.limits(i).upper) / 2;
          x[i] = centre + std::remainder(x[i] - centre, 2 * std::numbers::pi);
        }
        const bool is_inside = is_within_limits(arm_, x, 1e-9);
        if (result.points.size() > first && curve.dimension == 1) {
          result.points.back().next = std::ptrdiff_t(result.points.size());
        }
        const bool goes_on = is_inside && curve.dimension == 1 && result.points.size() > first &&
                             result.points.back().component != none &&
                             (result.points.back().x - x).norm() < 1;
        result.points.push_back({x, number,
                                 !is_inside ? none
                                 : goes_on  ? result.points.back().component
                                            : result.component_count++,
                                 none});
      }
      if (curve.is_closed && result.points.size() > first) {
        point& last = result.points.back();
        last.next = std::ptrdiff_t(first);
        const int component = result.points[first].component;
        if (last.component != none && component != none &&
            (last.x - result.points[first].x).norm() < 1) {
          const int same = last.component;
          for (std::size_t i = first; i < result.points.size(); ++i) {
            point& p = result.points[i];
            p.component = p.component == same ? component : p.component;
          }
        }
      }
      ++number;
    }
    return result;
  }

  /// Newton's method by least-norm steps of the joints that are not at limits; nothing if it leads
  /// far away.
  [[nodiscard]] std::optional<joints> at(double u, const joints& from, bool keeps_limits) const {
    const auto goal = duet::detail::to_tip_pose(path_(u));
    joints x = from;
    for (int round = 0; round < 8; ++round) {
      const auto e = duet::detail::error_twist(duet::detail::to_tip_pose(arm_.pose(x)), goal);
      const Eigen::Matrix<double, 6, 1>& error = e;
      if (error.norm() < 1e-9) {
        return x;
      }
      Eigen::Matrix<double, 6, 7> j = duet::jacobian(arm_, x, duet::frame::hybrid);
      const auto step = [&] {
        Eigen::Matrix<double, 6, 6> gram = j * j.transpose();
        gram.diagonal().array() += 1e-14;
        return joints(j.transpose() * gram.ldlt().solve(error));
      };
      joints y = x + step();
      if (keeps_limits) {
        bool is_fixed = false;
        for (int i = 0; i < 7; ++i) {
          const double bounded = std::clamp(y[i], arm_.limits(i).lower, arm_.limits(i).upper);
          if (bounded != y[i] && bounded == x[i]) {
            j.col(i).setZero();
            is_fixed = true;
          }
        }
        y = is_fixed ? joints(x + step()) : y;
        for (int i = 0; i < 7; ++i) {
          y[i] = std::clamp(y[i], arm_.limits(i).lower, arm_.limits(i).upper);
        }
      }
      if (!((y - from).norm() < .15)) {
        return {};
      }
      x = y;
    }
    return {};
  }

  [[nodiscard]] std::optional<joints> follow(joints x, double u, double to,
                                             bool keeps_limits) const {
    constexpr int parts = 4;
    for (int k = 1; k <= parts; ++k) {
      const auto next = at(u + (to - u) * k / parts, x, keeps_limits);
      if (!next) {
        return {};
      }
      x = *next;
    }
    return x;
  }

  /// Marks the component of a configuration as reached.
  void reach(layer& at, const joints& x) const {
    double nearest = .05;
    int component = none;
    for (const point& p : at.points) {
      if (p.next == none) {
        continue;
      }
      const point& q = at.points[std::size_t(p.next)];
      const joints segment = q.x - p.x;
      const int its = p.component != none ? p.component : q.component;
      if (its == none || segment.norm() > 1) {
        continue;
      }
      const double part = std::clamp(segment.dot(x - p.x) / segment.squaredNorm(), 0., 1.);
      const double distance = (p.x + part * segment - x).norm();
      if (distance < nearest) {
        nearest = distance;
        component = p.component != none && q.component != none && part > .5 ? q.component : its;
      }
    }
    if (component != none) {
      at.reached.insert(component);
    } else {
      if (std::none_of(at.isolated.begin(), at.isolated.end(),
                       [&](const joints& y) { return (x - y).norm() < .02; })) {
        at.isolated.push_back(x);
      }
      at.reached.insert(at.component_count); // one that no point is on
    }
  }

  void advance(const layer& current, layer& next) const {
    const auto go = [&](const joints& x) {
      if (const auto y = follow(x, current.u, next.u, true)) {
        reach(next, *y);
      }
    };
    for (const point& p : current.points) {
      if (p.component != none && current.reached.count(p.component) > 0) {
        go(p.x);
      }
    }
    for (const joints& x : current.isolated) {
      go(x);
    }
    if (const auto x = known_(next.u)) {
      if (const auto y = at(next.u, *x, true)) {
        reach(next, *y);
      }
    }
  }

  [[nodiscard]] bool goes_on_without_limits(const layer& current, double by) const {
    std::set<int> curves;
    for (const point& p : current.points) {
      if (current.reached.count(p.component) > 0) {
        curves.insert(p.curve);
      }
    }
    const auto goes_on = [&](const joints& x) {
      return bool(follow(x, current.u, std::min(1., current.u + by), false));
    };
    return std::any_of(current.points.begin(), current.points.end(),
                       [&](const point& p) { return curves.count(p.curve) > 0 && goes_on(p.x); }) ||
           std::any_of(current.isolated.begin(), current.isolated.end(), goes_on);
  }

  const duet::serial_chain<7>& arm_;
  path_function path_;
  std::function<std::optional<joints>(double)> known_;
};

/// Verdict of the search, which may leave a plan at any of its waypoints.
template <class Plan>
[[nodiscard]] path_verdict complete_path_verdict(const duet::serial_chain<7>& arm,
                                                 const layered_search::path_function& path,
                                                 const Plan& plan) {
  const auto known = [&](double u) -> std::optional<layered_search::joints> {
    const auto next = std::lower_bound(plan.tau.begin(), plan.tau.end(), u) - plan.tau.begin();
    if (next == std::ptrdiff_t(plan.tau.size())) {
      return {};
    }
    const auto k = std::size_t(next);
    const double part = k == 0 ? 0 : (u - plan.tau[k - 1]) / (plan.tau[k] - plan.tau[k - 1]);
    return k == 0 ? plan.joints[0] : (1 - part) * plan.joints[k - 1] + part * plan.joints[k];
  };
  return layered_search(arm, path, known)(plan.joints.front());
}

} // namespace duet_test
