// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "options.hpp"

#include "../support/curves.hpp"

#include <duet/core/constants.hpp>
#include <duet/core/text/csv.hpp>
#include <duet/derivative/derivative.hpp>
#include <duet/dual_quaternion/pose_coordinates.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

/// \file
/// The screw motion between two poses, and poses and velocities along it.

namespace screw_motion {

using duet::vector3;
using duet::vector6;
using screw = duet::screw_motion<double>;

/// Screw of the displacement B A* from A to B in fixed axes.
inline screw screw_between(const pose_type& from, const pose_type& to, bool is_longer_arc) {
  screw s = duet::screw_parameters(to * conj(from));
  if (is_longer_arc && s.angle > 0) {
    s.angle -= 2 * duet::constant::pi<double>();
  }
  return s;
}

inline const char* kind_text(duet::screw_kind kind) {
  switch (kind) {
  case duet::screw_kind::translation:
    return "translation";
  case duet::screw_kind::rotation:
    return "rotation";
  case duet::screw_kind::screw:
    return "screw";
  default:
    return "none";
  }
}

inline std::string triple(const vector3<double>& v) {
  std::ostringstream text;
  const auto clean = [](double x) { return std::abs(x) < 1e-12 ? 0.0 : x; };
  text << "(" << clean(v[0]) << ", " << clean(v[1]) << ", " << clean(v[2]) << ")";
  return text.str();
}

/// The point of the axis closest to the origin, n × m.
inline vector3<double> point_on_axis(const screw& s) { return s.axis.cross(s.moment); }

inline std::string in_words(const screw& s) {
  std::ostringstream text;
  switch (s.kind) {
  case duet::screw_kind::none:
    return "The poses are the same.\n";
  case duet::screw_kind::translation:
    text << "A translation by " << s.translation << " along " << triple(s.axis) << ".\n";
    return text.str();
  default:
    break;
  }
  text << "A rotation by " << s.angle << " rad (" << s.angle * 180 / duet::constant::pi<double>()
       << " degrees) about the line through " << triple(point_on_axis(s)) << " along "
       << triple(s.axis);
  if (s.kind == duet::screw_kind::screw) {
    text << ",\nand a translation by " << s.translation << " along it: a pitch of "
         << s.translation / s.angle * 2 * duet::constant::pi<double>() << " per turn";
  }
  text << ".\n";
  return text.str();
}

struct sample {
  double tau;
  pose_type pose;
  vector6<double> twist; ///< spatial, [v; ω] per unit of τ, by automatic differentiation
  vector6<double> rates; ///< the same, hybrid: of the pose's own origin, in fixed axes
};

inline std::vector<sample> samples(const pose_type& from, const pose_type& to, duet::slerp_arc arc,
                                   int steps) {
  std::vector<sample> result;
  for (int i = 0; i <= steps; ++i) {
    const double tau = double(i) / steps;
    const auto [a, a_dot] =
        duet::derivative([&](auto t) { return duet::sclerp(from, to, t, arc); }, tau);
    result.push_back({tau, a, duet::twist(a, a_dot, duet::frame::spatial),
                      duet::twist(a, a_dot, duet::frame::hybrid)});
  }
  return result;
}

/// Closed form of the twist, which is constant along the path: ω = φ n, v = d n + φ m.
inline vector6<double> constant_twist(const screw& s) {
  vector6<double> v;
  v << s.translation * s.axis + s.angle * s.moment, s.angle * s.axis;
  return v;
}

/// The largest difference between both twists, relative to the larger of 1 and the twist.
inline double largest_difference(const std::vector<sample>& path, const screw& s) {
  const vector6<double> exact = constant_twist(s);
  double largest = 0;
  for (const sample& p : path) {
    largest = std::max(largest, (p.twist - exact).cwiseAbs().maxCoeff());
  }
  return largest / std::max(1.0, exact.cwiseAbs().maxCoeff());
}

/// Pose, velocity of its origin and angular velocity, in fixed axes, per unit of τ.
inline std::string path_csv(const std::vector<sample>& path) {
  std::string text = "tau,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
  for (const sample& p : path) {
    const auto gamma = duet::pose_coordinates(p.pose);
    const auto& v = p.rates;
    text += duet::csv_line({p.tau, gamma[0], gamma[1], gamma[2], gamma[3], gamma[4], gamma[5],
                            gamma[6], v[0], v[1], v[2], v[3], v[4], v[5]});
  }
  return text;
}

/// Length of the drawn axes: a sixth of the largest displacement of the origin.
inline double axis_length(const std::vector<sample>& path) {
  double size = 0;
  for (const sample& p : path) {
    const vector3<double> displacement =
        duet::translation(p.pose) - duet::translation(path.front().pose);
    size = std::max(size, displacement.norm());
  }
  return size > 0 ? size / 6 : 1;
}

/// Arrows of about ten frames along the path, and of the axis: start, direction, number (0 to 2; 3
/// for the axis).
inline std::string frames_csv(const std::vector<sample>& path, const screw& s) {
  std::string text = "x,y,z,dx,dy,dz,arrow\n";
  double low = 0;
  double high = 0;
  for (const sample& p : path) {
    const double along = s.axis.dot(duet::translation(p.pose));
    low = &p == &path.front() ? along : std::min(low, along);
    high = &p == &path.front() ? along : std::max(high, along);
  }
  const double length = axis_length(path);
  const std::size_t stride = std::max<std::size_t>(1, (path.size() - 1) / 10);
  const auto add = [&](const vector3<double>& from, const vector3<double>& arrow, int which) {
    text +=
        duet::csv_line({from[0], from[1], from[2], arrow[0], arrow[1], arrow[2], double(which)});
  };
  for (std::size_t i = 0; i < path.size(); i += stride) {
    const duet::matrix3<double> r = duet::rotation_matrix(duet::rotation(path[i].pose));
    for (int axis = 0; axis < 3; ++axis) {
      add(duet::translation(path[i].pose), length * r.col(axis), axis);
    }
  }
  if (s.kind == duet::screw_kind::rotation || s.kind == duet::screw_kind::screw) {
    add(point_on_axis(s) + (low - length) * s.axis, (high - low + 2 * length) * s.axis, 3);
  }
  return text;
}

inline std::string path_title(const screw& s) {
  std::ostringstream degrees;
  degrees << std::setprecision(3) << std::abs(s.angle) * 180 / duet::constant::pi<double>();
  const std::string angle = degrees.str();
  switch (s.kind) {
  case duet::screw_kind::none:
    return "The poses are the same";
  case duet::screw_kind::translation:
    return "From pose to pose: a shift by " + example::two_digits(s.translation);
  case duet::screw_kind::rotation:
    return "From pose to pose: a turn by " + angle + " degrees about one axis";
  default:
    return "From pose to pose: a turn by " + angle + " degrees about one axis, and a shift by " +
           example::two_digits(s.translation) + " along it";
  }
}

/// Frames along the path and the axis of the screw, with their names; lengths are in the unit of
/// the poses.
inline std::string path_script(const screw& s, const std::vector<sample>& path) {
  const auto label = [](const std::string& text, const vector3<double>& at, const char* style) {
    return "set label " + example::in_quotes(text) + " at " + duet::to_text(at[0]) + "," +
           duet::to_text(at[1]) + "," + duet::to_text(at[2]) + " front " + style + "\n";
  };
  const double length = axis_length(path);
  std::string labels;
  const duet::matrix3<double> r = duet::rotation_matrix(duet::rotation(path.front().pose));
  const char* const colours[] = {"vermillion", "green", "blue"};
  const char* const names[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    labels +=
        label(names[axis],
              vector3<double>(duet::translation(path.front().pose)) + 1.3 * length * r.col(axis),
              (std::string("center tc rgb ") + colours[axis]).c_str());
  }
  labels += label("from", duet::translation(path.front().pose), "right offset -.8,-.6 tc rgb ink") +
            label("to", duet::translation(path.back().pose), "right offset -.5,-1 tc rgb ink");
  if (s.kind == duet::screw_kind::rotation || s.kind == duet::screw_kind::screw) {
    const double along = s.axis.dot(duet::translation(path.front().pose));
    labels +=
        label("screw axis", point_on_axis(s) + along * s.axis, "right offset -1,0 tc rgb ink");
  }
  const auto arrows = [](int which, const char* style) {
    return "'frames.csv' using ($7==" + std::to_string(which) +
           "?$1:1/0):2:3:4:5:6 skip 1 with vectors " + style;
  };
  return "set border 31 lc rgb pale\nset view equal xyz\nset view 62,35,1.25\n"
         "set xyplane relative 0\nset xtics .5 offset 0,-.2\nset ytics .5 offset .5,0\n"
         "set ztics .5\nset format '%.1f'\nset xlabel 'x'\nset ylabel 'y'\nset zlabel 'z'\n"
         "set label " +
         example::title(path_title(s)) + " at screen .5,.95 center tc rgb ink\n" + labels +
         "splot 'path.csv' using 2:3:4 skip 1 with lines lw 3 lc rgb ink, \\\n  " +
         arrows(0, "lw 2 lc rgb vermillion") + ", \\\n  " + arrows(1, "lw 2 lc rgb green") +
         ", \\\n  " + arrows(2, "lw 2 lc rgb blue") + ", \\\n  " +
         arrows(3, "nohead lw 2 dt 2 lc rgb ink") + "\n";
}

} // namespace screw_motion
