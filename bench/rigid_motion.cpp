// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

/// \file
/// Unit dual quaternions: product, exponential, logarithm, ScLERP, a point transformed. By hand:
/// the same in eight plain doubles, with one branch for small angles. Eigen's Isometry if it
/// has the same operation.

#include "support/contest.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/dual_quaternion/screw.hpp>
#include <duet/dual_quaternion/twist.hpp>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace duet_bench {
namespace {

using pose_type = duet::dual_quaternion<double>;
using eight = std::array<double, 8>; // real part, then dual part
using six = std::array<double, 6>;   // ½ω, then ½v
using three = std::array<double, 3>;

eight numbers_of(const pose_type& a) {
  const auto p = real_part(a);
  const auto q = dual_part(a);
  return {p.w(), p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
}

namespace by_hand {

/// r += p q
inline void add_product(double* r, const double* p, const double* q) {
  r[0] += p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3];
  r[1] += p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2];
  r[2] += p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1];
  r[3] += p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0];
}

inline eight product(const eight& a, const eight& b) {
  eight r{};
  add_product(&r[0], &a[0], &b[0]);
  add_product(&r[4], &a[0], &b[4]);
  add_product(&r[4], &a[4], &b[0]);
  return r;
}

inline eight conjugate(const eight& a) {
  return {a[0], -a[1], -a[2], -a[3], a[4], -a[5], -a[6], -a[7]};
}

/// exp(w + εv)
inline eight exponential(const six& x) {
  const double s = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
  const double d = x[0] * x[3] + x[1] * x[4] + x[2] * x[5];
  double c, f, g; // cos, sin/θ, (cos − sin/θ)/θ²
  if (s < 1e-4) {
    c = 1 - s / 2 + s * s / 24;
    f = 1 - s / 6 + s * s / 120;
    g = -1.0 / 3 + s / 30 - s * s / 840;
  } else {
    const double angle = std::sqrt(s);
    c = std::cos(angle);
    f = std::sin(angle) / angle;
    g = (c - f) / s;
  }
  const double e = g * d;
  return {c,
          f * x[0],
          f * x[1],
          f * x[2],
          -f * d,
          f * x[3] + e * x[0],
          f * x[4] + e * x[1],
          f * x[5] + e * x[2]};
}

/// ½(φ + εd)(n + εm) of a unit
inline six logarithm(const eight& a) {
  const double s = a[1] * a[1] + a[2] * a[2] + a[3] * a[3];
  const double d = a[1] * a[5] + a[2] * a[6] + a[3] * a[7];
  double f, e; // θ/sin θ, and its dual part
  if (s < 1e-4 && a[0] > 0) {
    f = 1 + s / 6 + s * s * 3 / 40;
    e = (1.0 / 3 + s * 3 / 10) * d;
  } else {
    const double root = std::sqrt(s);
    f = std::atan2(root, a[0]) / root;
    e = (a[0] - f) / s * d - a[4];
  }
  return {f * a[1],           f * a[2], f * a[3], f * a[5] + e * a[1], f * a[6] + e * a[2],
          f * a[7] + e * a[3]};
}

/// log|A| + ½(φ + εd)(n + εm), as duet's logarithm of any dual quaternion, unit or not
inline eight general_logarithm(const eight& a) {
  const double s = a[1] * a[1] + a[2] * a[2] + a[3] * a[3];
  const double d = a[1] * a[5] + a[2] * a[6] + a[3] * a[7];
  const double square = s + a[0] * a[0];
  double f, e; // θ/(|A| sin θ), and its dual part
  if (s < 1e-4 * square && a[0] > 0) {
    const double w = 1 / a[0];
    const double x = s * w * w;
    f = w * (1 - x / 3 + x * x / 5);
    e = w * w * w * (-2.0 / 3 + x * 4 / 5) * d - w * w * (1 - x + x * x) * a[4];
  } else {
    const double root = std::sqrt(s);
    f = std::atan2(root, a[0]) / root;
    e = (a[0] / square - f) / s * d - a[4] / square;
  }
  return {std::log(square) / 2,
          f * a[1],
          f * a[2],
          f * a[3],
          (d + a[0] * a[4]) / square,
          f * a[5] + e * a[1],
          f * a[6] + e * a[2],
          f * a[7] + e * a[3]};
}

inline eight interpolation(const eight& a, const eight& b, double tau) {
  const double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  eight relative = product(conjugate(a), b);
  if (cosine < 0) {
    for (double& x : relative) {
      x = -x;
    }
  }
  six v = logarithm(relative);
  for (double& x : v) {
    x *= tau;
  }
  return product(a, exponential(v));
}

inline three transformed(const eight& a, const three& x) {
  // R x = x + 2 (p₀ n + p⃗ × n), n = p⃗ × x; t = 2 q p*
  const double n[] = {a[2] * x[2] - a[3] * x[1], a[3] * x[0] - a[1] * x[2],
                      a[1] * x[1] - a[2] * x[0]};
  const double t[] = {-a[4] * a[1] + a[5] * a[0] - a[6] * a[3] + a[7] * a[2],
                      -a[4] * a[2] + a[5] * a[3] + a[6] * a[0] - a[7] * a[1],
                      -a[4] * a[3] - a[5] * a[2] + a[6] * a[1] + a[7] * a[0]};
  return {x[0] + 2 * (a[0] * n[0] + a[2] * n[2] - a[3] * n[1] + t[0]),
          x[1] + 2 * (a[0] * n[1] + a[3] * n[0] - a[1] * n[2] + t[1]),
          x[2] + 2 * (a[0] * n[2] + a[1] * n[1] - a[2] * n[0] + t[2])};
}

} // namespace by_hand

template <class P>
struct two {
  P a, b;
};
template <class P, class X>
struct with_point {
  P a;
  X x;
};

const bool registered = [] {
  const pose_type a = duet::pose(duet::from_rotation_vector(duet::vector3<double>(0.4, -1, 0.7)),
                                 duet::vector3<double>(1, 2, -0.5));
  const pose_type b = duet::pose(duet::from_rotation_vector(duet::vector3<double>(-0.3, 0.2, 1.4)),
                                 duet::vector3<double>(0.3, -1, 0.8));
  const eight a8 = numbers_of(a), b8 = numbers_of(b);
  const auto isometry = [](const pose_type& p) {
    return Eigen::Isometry3d(duet::transform_matrix(p));
  };

  const auto product = [](const two<pose_type>& p) { return p.a * p.b; };
  const auto product_by_hand = [](const two<eight>& p) { return by_hand::product(p.a, p.b); };
  expect_agreement("pose_product", "hand", numbers_of(a * b), by_hand::product(a8, b8));
  register_benchmark("pose_product", "duet", two<pose_type>{a, b}, product);
  register_benchmark("pose_product", "hand", two<eight>{a8, b8}, product_by_hand);
  register_benchmark("pose_product", "Eigen Isometry3d",
                     two<Eigen::Isometry3d>{isometry(a), isometry(b)},
                     [](const two<Eigen::Isometry3d>& p) { return Eigen::Isometry3d(p.a * p.b); });

  const duet::dual_vector<double> v = log(a).vec();
  const six v6 = by_hand::logarithm(a8);
  const auto exponential = [](const duet::dual_vector<double>& x) { return duet::exp(x); };
  expect_agreement("pose_exp", "hand", a8, by_hand::exponential(v6));
  register_benchmark("pose_exp", "duet", v, exponential);
  register_benchmark("pose_exp", "hand", v6, by_hand::exponential);

  const auto logarithm = [](const pose_type& p) { return log(p); };
  expect_agreement(
      "pose_log", "hand",
      six{v[0].value(), v[1].value(), v[2].value(), v[0].epsilon(), v[1].epsilon(), v[2].epsilon()},
      v6);
  register_benchmark("pose_log", "duet", a, logarithm);
  register_benchmark("pose_log", "hand", a8, by_hand::general_logarithm);

  const auto interpolation = [](const two<pose_type>& p) { return sclerp(p.a, p.b, 0.3); };
  expect_agreement("sclerp", "hand", numbers_of(sclerp(a, b, 0.3)),
                   by_hand::interpolation(a8, b8, 0.3));
  register_benchmark("sclerp", "duet", two<pose_type>{a, b}, interpolation);
  register_benchmark("sclerp", "hand", two<eight>{a8, b8},
                     [](const two<eight>& p) { return by_hand::interpolation(p.a, p.b, 0.3); });

  using point = duet::vector3<double>;
  const point x(0.1, 0.2, -0.4);
  const point moved = duet::transform_point(a, x);
  expect_agreement("transform_point", "hand", three{moved[0], moved[1], moved[2]},
                   by_hand::transformed(a8, {x[0], x[1], x[2]}));
  register_benchmark(
      "transform_point", "duet", with_point<pose_type, point>{a, x},
      [](const with_point<pose_type, point>& p) { return duet::transform_point(p.a, p.x); });
  register_benchmark(
      "transform_point", "hand", with_point<eight, three>{a8, {x[0], x[1], x[2]}},
      [](const with_point<eight, three>& p) { return by_hand::transformed(p.a, p.x); });
  register_benchmark(
      "transform_point", "Eigen Isometry3d", with_point<Eigen::Isometry3d, point>{isometry(a), x},
      [](const with_point<Eigen::Isometry3d, point>& p) { return point(p.a * p.x); });
  return true;
}();

} // namespace
} // namespace duet_bench
