// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "../wheel_carrier/carrier.hpp"
#include "../wheel_carrier/table.hpp"

#include <duet/derivative/frame.hpp>
#include <duet/dual/dual.hpp>
#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/interpolate.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// Pose of the carrier at a wheel height u and its twist per unit of u, by solving the constraints
/// or from a table.

namespace bump_ride {

using screw = duet::dual<double, 1, duet::screw_tag>;
using pose_type = duet::dual_quaternion<double>;
using duet::vector3;
using duet::vector6;

/// Pose of the wheel centre frame, its twist [v; ω] per unit of u in body axes, and the derivative
/// of the twist.
struct motion_state {
  pose_type pose;
  vector6<double> twist, twist_first;
};

/// Solves the constraints of the five rods by Newton's method in every call.
class exact_model {
public:
  explicit exact_model(const wheel_carrier::carrier& mechanism) : mechanism_(mechanism) {}

  [[nodiscard]] motion_state at(double u) const {
    const wheel_carrier::state s = mechanism_.at(u);
    const auto back = conj(s.q);
    const vector3<double> omega = rotate(back, s.omega());
    const vector3<double> v = rotate(back, s.centre_first);
    motion_state p{duet::pose(s.q, s.centre), {}, {}};
    p.twist << v, omega;
    p.twist_first << rotate(back, s.centre_second) - omega.cross(v), rotate(back, s.omega_first());
    return p;
  }

private:
  const wheel_carrier::carrier& mechanism_;
};

/// The lookup table: poses at heights u.
struct pose_table {
  std::vector<double> u;
  std::vector<pose_type> poses;
};

/// The rows of the paper's table of rotations, each with the wheel centre.
inline pose_table make_table(const wheel_carrier::carrier& mechanism, int rows) {
  const wheel_carrier::arc_length arcs(mechanism);
  pose_table result;
  for (const double u : wheel_carrier::equal_arc_table(mechanism, arcs, rows).u) {
    const wheel_carrier::state s = mechanism.at(u);
    result.u.push_back(u);
    result.poses.push_back(duet::pose(s.q, s.centre));
  }
  return result;
}

/// A spline through the rows of the table.
template <class Spline>
class spline_model {
public:
  explicit spline_model(const pose_table& table)
      : spline_(duet::interpolate<Spline>(table.u, table.poses, duet::not_a_knot{})) {}

  [[nodiscard]] motion_state at(double u) const {
    const auto m = spline_.motion(u, duet::frame::body);
    return {m.value, m.velocity, m.acceleration};
  }

private:
  Spline spline_;
};
using cumulative_model = spline_model<duet::cumulative_bspline<screw>>;
using rotation_vector_model = spline_model<duet::rotation_vector_spline<screw>>;

/// A screw motion from each row to the next (ScLERP), with rates that jump at the rows.
class screw_model {
public:
  explicit screw_model(pose_table table) : table_(std::move(table)) {}

  [[nodiscard]] motion_state at(double u) const {
    const auto above = std::upper_bound(table_.u.begin() + 1, table_.u.end() - 1, u);
    const auto i = std::size_t(above - table_.u.begin()) - 1;
    const double step = table_.u[i + 1] - table_.u[i];
    const auto relative =
        duet::dual_vector<double>(log(conj(table_.poses[i]) * table_.poses[i + 1]).vec());
    return {duet::sclerp(table_.poses[i], table_.poses[i + 1], (u - table_.u[i]) / step),
            duet::twist_of<double>(relative) * (2 / step), vector6<double>::Zero()};
  }

private:
  pose_table table_;
};

} // namespace bump_ride
