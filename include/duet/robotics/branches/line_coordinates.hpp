// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/quaternion/three_vector.hpp>
#include <duet/robotics/branches/loop_equation.hpp>

#include <Eigen/Core>

#include <array>

/// \file
/// Products of a point and a direction on which displacements act linearly, after M. Raghavan and
/// B. Roth, Inverse kinematics of the general 6R manipulator and related linkages, 1993.

namespace duet::detail {

/// Vector (1, p, p·p, l, p×l, p·l, (p·p) l − 2 (p·l) p) of a point p and a
/// direction l, or a sum of such.
struct line_coordinates {
  three_vector<double> p{0, 0, 0}, l{0, 0, 0}, m{0, 0, 0}, c{0, 0, 0};
  double one = 0, pp = 0, pl = 0;

  [[nodiscard]] static line_coordinates of(const three_vector<double>& p,
                                           const three_vector<double>& l) {
    const double pp = dot(p, p), pl = dot(p, l);
    return {p, l, cross(p, l), pp * l - 2 * pl * p, 1, pp, pl};
  }

  /// Coordinates of p + t and l.
  [[nodiscard]] line_coordinates moved(const three_vector<double>& t) const {
    const double tt = dot(t, t), tl = dot(t, l);
    return {p + one * t,
            l,
            m + cross(t, l),
            c - 2 * cross(t, m) + tt * l - 2 * (pl + tl) * t,
            one,
            pp + 2 * dot(t, p) + tt * one,
            pl + tl};
  }

  /// All coordinates except the first, which is 1.
  [[nodiscard]] Eigen::Matrix<double, 14, 1> equations() const {
    Eigen::Matrix<double, 14, 1> result;
    result << p.x, p.y, p.z, l.x, l.y, l.z, m.x, m.y, m.z, c.x, c.y, c.z, pp, pl;
    return result;
  }
};

/// Coordinates displaced by a joint: the sum of the result with the weights 1, cos θ, sin θ; for a
/// prismatic joint 1, d, d².
[[nodiscard]] inline std::array<line_coordinates, 3> by_joint(const loop_joint& j,
                                                              const line_coordinates& x) {
  const three_vector<double>& n = j.axis;
  const three_vector<double> none{0, 0, 0};
  if (!j.is_revolute) {
    return {x,
            {x.one * n, none, cross(n, x.l), -2 * (cross(n, x.m) + x.pl * n), 0, 2 * dot(n, x.p),
             dot(n, x.l)},
            {none, none, none, x.l - 2 * dot(n, x.l) * n, 0, x.one, 0}};
  }
  const line_coordinates at = x.moved(-1 * j.point);
  const auto along = [&](const three_vector<double>& v) { return dot(n, v) * n; };
  const line_coordinates still{along(at.p), along(at.l), along(at.m), along(at.c),
                               at.one,      at.pp,       at.pl};
  const line_coordinates cosine{
      at.p - still.p, at.l - still.l, at.m - still.m, at.c - still.c, 0, 0, 0};
  const line_coordinates sine{
      cross(n, at.p), cross(n, at.l), cross(n, at.m), cross(n, at.c), 0, 0, 0};
  return {still.moved(j.point), cosine.moved(j.point), sine.moved(j.point)};
}

} // namespace duet::detail
