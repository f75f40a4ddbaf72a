// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/quaternion/euler.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/spline/cumulative_bspline.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <type_traits>
#include <vector>

/// \file
/// A uniform cubic spline of 100 segments, by duet and as a kernel for this one curve.

namespace duet_bench {

inline constexpr int segments = 100;
inline constexpr double knot_distance = 0.1;

/// Value, angular velocity and acceleration in body axes.
using numbers = std::array<double, 10>;
/// Value, angular velocity, acceleration and jerk in body axes.
using numbers_with_jerk = std::array<double, 13>;

/// Smooth tumbling motion with up to 0.25 rad per segment.
inline duet::quaternion<double> orientation(double t) {
  return duet::from_euler<duet::zyx>(1.9 * std::sin(t), 0.8 * std::sin(1.3 * t + 1),
                                     2 * std::cos(0.7 * t));
}

/// Control quaternions one knot apart; the domain is [0, segments · knot_distance].
inline std::vector<duet::quaternion<double>> controls() {
  std::vector<duet::quaternion<double>> result;
  for (int i = 0; i < segments + 3; ++i) {
    result.push_back(orientation((i - 1) * knot_distance));
  }
  return result;
}

inline duet::cumulative_bspline<double> make_spline() {
  std::vector<double> knots;
  for (int i = -3; i <= segments + 3; ++i) {
    knots.push_back(i * knot_distance);
  }
  return {knots, controls()};
}

/// Parameters of the curve in random order.
class random_parameters {
public:
  random_parameters() {
    std::mt19937_64 engine(1);
    for (double& u : values_) {
      u = double(engine() >> 11) * 0x1p-53 * segments * knot_distance;
    }
  }
  double next() { return values_[next_++ % values_.size()]; }

private:
  std::array<double, 1024> values_;
  std::size_t next_ = 0;
};

/// Hand-written cubic for uniform knots: logarithms are cached as axis and half angle, the segment
/// is found by one product, polynomials are written out.
class hand_written_spline {
public:
  explicit hand_written_spline(const std::vector<duet::quaternion<double>>& controls) {
    duet::quaternion<double> previous = controls.front();
    for (duet::quaternion<double> q : controls) {
      if (dot(previous, q) < 0) {
        q = -q;
      }
      const duet::vector3<double> omega = log(conj(previous) * q).vec();
      const double angle = omega.norm();
      const duet::vector3<double> axis = angle > 0 ? duet::vector3<double>(omega / angle) : omega;
      nodes_.push_back({{q.w(), q.x(), q.y(), q.z()}, {axis[0], axis[1], axis[2]}, angle});
      previous = q;
    }
  }

  [[nodiscard]] std::array<double, 4> value(double u) const {
    const location at(u);
    const node* n = &nodes_[at.segment];
    std::array<double, 4> q = n->q;
    const auto b = weights(at.x);
    for (int i = 0; i < 3; ++i) {
      q = product(q, exponential(*++n, b[i]));
    }
    return q;
  }

  [[nodiscard]] numbers motion(double u) const { return motion_of<numbers>(u); }
  [[nodiscard]] numbers_with_jerk motion_with_jerk(double u) const {
    return motion_of<numbers_with_jerk>(u);
  }

private:
  static constexpr double r = 1 / knot_distance;

  struct node {
    std::array<double, 4> q;
    std::array<double, 3> axis;
    double angle;
  };

  struct location {
    explicit location(double u) {
      const double s = u * (1 / knot_distance);
      segment = static_cast<std::size_t>(s);
      x = s - double(segment);
    }
    std::size_t segment;
    double x;
  };

  /// \tparam Numbers  `numbers`, or `numbers_with_jerk`
  template <class Numbers>
  [[nodiscard]] Numbers motion_of(double u) const {
    constexpr bool has_jerk = std::is_same_v<Numbers, numbers_with_jerk>;
    constexpr double third[] = {r * r * r, -2 * r * r * r, r * r * r};
    const location at(u);
    const node* n = &nodes_[at.segment];
    const double x = at.x;
    const auto b = weights(x);
    const auto first = first_derivatives(x), second = second_derivatives(x);
    std::array<double, 4> q = n->q;
    std::array<double, 3> w{}, a{}, j{};
    for (int i = 0; i < 3; ++i) {
      ++n;
      const auto e = exponential(*n, b[i]);
      q = product(q, e);
      const auto d = multiple(n->axis, n->angle * first[i]);
      const auto d2 = multiple(n->axis, n->angle * second[i]);
      const auto d3 = multiple(n->axis, n->angle * third[i]);
      if (i == 0) {
        w = d;
        a = d2;
        j = d3;
        continue;
      }
      w = rotated_back(e, w);
      a = rotated_back(e, a);
      const auto wd = cross(w, d);
      if constexpr (has_jerk) {
        j = rotated_back(e, j);
        const auto wd2 = cross(w, d2);
        const auto twice = cross({a[0] + wd[0], a[1] + wd[1], a[2] + wd[2]}, d);
        j = {j[0] + d3[0] + 4 * twice[0] + 2 * wd2[0], j[1] + d3[1] + 4 * twice[1] + 2 * wd2[1],
             j[2] + d3[2] + 4 * twice[2] + 2 * wd2[2]};
      }
      a = {a[0] + d2[0] + 2 * wd[0], a[1] + d2[1] + 2 * wd[1], a[2] + d2[2] + 2 * wd[2]};
      w = {w[0] + d[0], w[1] + d[1], w[2] + d[2]};
    }
    Numbers result = {q[0],     q[1],     q[2],     q[3],     2 * w[0],
                      2 * w[1], 2 * w[2], 2 * a[0], 2 * a[1], 2 * a[2]};
    if constexpr (has_jerk) {
      for (int k = 0; k < 3; ++k) {
        result[10 + k] = 2 * j[k];
      }
    }
    return result;
  }

  static std::array<double, 3> weights(double x) {
    const double x2 = x * x, x3 = x2 * x;
    return {(5 + 3 * x - 3 * x2 + x3) / 6, (1 + 3 * x + 3 * x2 - 2 * x3) / 6, x3 / 6};
  }
  static std::array<double, 3> first_derivatives(double x) {
    return {r * (1 - x) * (1 - x) / 2, r * (0.5 + x - x * x), r * x * x / 2};
  }
  static std::array<double, 3> second_derivatives(double x) {
    return {r * r * (x - 1), r * r * (1 - 2 * x), r * r * x};
  }
  static std::array<double, 3> multiple(const std::array<double, 3>& v, double factor) {
    return {v[0] * factor, v[1] * factor, v[2] * factor};
  }
  static std::array<double, 3> cross(const std::array<double, 3>& a,
                                     const std::array<double, 3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  static std::array<double, 4> exponential(const node& n, double b) {
    const double s = std::sin(n.angle * b), c = std::cos(n.angle * b);
    return {c, n.axis[0] * s, n.axis[1] * s, n.axis[2] * s};
  }
  static std::array<double, 4> product(const std::array<double, 4>& p,
                                       const std::array<double, 4>& q) {
    return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
            p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
            p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
  }
  /// Vector e* v e, rotated back by e.
  static std::array<double, 3> rotated_back(const std::array<double, 4>& e,
                                            const std::array<double, 3>& v) {
    const double tx = 2 * (e[2] * v[2] - e[3] * v[1]);
    const double ty = 2 * (e[3] * v[0] - e[1] * v[2]);
    const double tz = 2 * (e[1] * v[1] - e[2] * v[0]);
    return {v[0] - e[0] * tx + (e[2] * tz - e[3] * ty), v[1] - e[0] * ty + (e[3] * tx - e[1] * tz),
            v[2] - e[0] * tz + (e[1] * ty - e[2] * tx)};
  }

  std::vector<node> nodes_;
};

} // namespace duet_bench
