// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "options.hpp"

#include <duet/core/text/csv.hpp>
#include <duet/duet.hpp>
#include <duet/planning/save_plan.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

/// \file
/// What is drawn, as CSV.

namespace motion_plan_example {

using plan_type = duet::motion_plan<-16>;

struct worst_case {
  duet::pose_deviation deviation;
  double clearance = std::numeric_limits<double>::infinity();
};

/// How far the tip is from the screw motion and the arm from obstacles, at ten points from waypoint
/// to waypoint; and the largest and smallest of them.
inline worst_case deviations_csv(const problem& p, const plan_type& plan, std::string& text) {
  worst_case worst;
  text = "tau,deviation [m],deviation [rad],clearance [m]\n";
  for (std::size_t k = 1; k < plan.joints.size(); ++k) {
    for (int part = 0; part <= 10; ++part) {
      const double x = part / 10.0;
      const Eigen::VectorXd theta = (1 - x) * plan.joints[k - 1] + x * plan.joints[k];
      const double tau = (1 - x) * plan.tau[k - 1] + x * plan.tau[k];
      const auto d =
          duet::deviation_between(p.arm.pose(theta), duet::sclerp(plan.poses.front(), p.goal, tau));
      const double apart = duet::clearance(p.arm, theta, p.around).distance;
      worst.deviation.length = std::max(worst.deviation.length, d.length);
      worst.deviation.angle = std::max(worst.deviation.angle, d.angle);
      worst.clearance = std::min(worst.clearance, apart);
      text += duet::csv_line({tau, d.length, d.angle, std::min(apart, 1e9)});
    }
  }
  return worst;
}

/// The arm at about ten waypoints, as lines from joint to joint: x, y, z, which; an empty line
/// after each.
inline std::string arms_csv(const problem& p, const plan_type& plan) {
  std::string text = "x,y,z,tau\n";
  const int count = 9;
  for (int i = 0; i < count; ++i) {
    const std::size_t k = (plan.joints.size() - 1) * std::size_t(i) / (count - 1);
    const auto add = [&](const point& x) {
      text += duet::csv_line({x[0], x[1], x[2], double(i) / (count - 1)});
    };
    add(point(0, 0, 0));
    for (int link = 1; link <= p.arm.size(); ++link) {
      add(duet::translation(p.arm.pose(plan.joints[k], link)));
    }
    add(duet::translation(p.arm.pose(plan.joints[k])));
    text += "\n\n";
  }
  return text;
}

/// Wire frames: a ball as meridians and parallels, a box as its edges, a half-space as a grid
/// around the base.
inline std::string obstacles_csv(const problem& p) {
  std::string text = "x,y,z\n";
  const auto line = [&](const std::vector<point>& points) {
    for (const point& x : points) {
      text += duet::csv_line({x[0], x[1], x[2]});
    }
    text += "\n";
  };
  const auto curve = [&](const auto& f) {
    std::vector<point> points;
    for (int i = 0; i <= 36; ++i) {
      points.push_back(f(i * std::acos(-1.0) / 18));
    }
    line(points);
  };
  const auto draw = [&](const auto& o) {
    if constexpr (requires { o.centre; }) {
      for (int i = 0; i < 6; ++i) {
        const double a = i * std::acos(-1.0) / 6, z = std::cos(a + .26), r = std::sin(a + .26);
        curve([&](double t) {
          return point(o.centre + o.radius * point(std::cos(t) * std::cos(a),
                                                   std::cos(t) * std::sin(a), std::sin(t)));
        });
        curve([&](double t) {
          return point(o.centre + o.radius * point(r * std::cos(t), r * std::sin(t), z));
        });
      }
    } else if constexpr (requires { o.placed; }) {
      for (int axis = 0; axis < 3; ++axis) {
        for (int corner = 0; corner < 4; ++corner) {
          point from = o.half_sizes;
          from[(axis + 1) % 3] *= corner % 2 == 0 ? 1 : -1;
          from[(axis + 2) % 3] *= corner / 2 == 0 ? 1 : -1;
          point to = from;
          to[axis] = -to[axis];
          line({duet::transform_point(o.placed, from), duet::transform_point(o.placed, to)});
        }
      }
    } else {
      for (int i = -4; i <= 4; ++i) {
        line({point(.1 * i, -.4, o.offset), point(.1 * i, .4, o.offset)});
        line({point(-.4, .1 * i, o.offset), point(.4, .1 * i, o.offset)});
      }
    }
  };
  for (const duet::obstacle& each : p.around.obstacles) {
    std::visit(draw, each);
  }
  return text;
}

} // namespace motion_plan_example
