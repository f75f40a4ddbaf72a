// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Functions to be differentiated: plain generic code independent of any library, so that all
/// contenders run the same code.

namespace duet_bench {

/// sin x · exp(−x²) + log(1 + x²)/√(2 + cos x)
template <class S>
S f_scalar(const S& x) {
  using std::cos;
  using std::exp;
  using std::log;
  using std::sin;
  using std::sqrt;
  const S square = x * x;
  const S wave = sin(x) * exp(-square);
  const S hill = log(1.0 + square) / sqrt(2.0 + cos(x));
  return wave + hill;
}

struct value_and_slope {
  double value;
  double slope;
};

/// f_scalar and its derivative written by hand, with common subexpressions evaluated once.
inline value_and_slope f_scalar_by_hand(double x) {
  const double square = x * x;
  const double s = std::sin(x);
  const double c = std::cos(x);
  const double bell = std::exp(-square);
  const double root = std::sqrt(2.0 + c);
  const double logarithm = std::log(1.0 + square);
  const double hill = logarithm / root;
  return {s * bell + hill, (c - 2.0 * x * s) * bell + 2.0 * x / ((1.0 + square) * root) +
                               0.5 * hill * s / (2.0 + c)};
}

template <class S, std::size_t N>
using inputs = std::array<S, N>;

/// A loop of short statements over the inputs, each with its neighbour: a sine, an exponential, a
/// root or a quotient in turn, between products and sums.
template <class X>
auto f_grad(const X& x) {
  using std::exp;
  using std::sin;
  using std::sqrt;
  using S = typename X::value_type;
  const std::size_t n = x.size();
  S sum = x[0];
  S carry = x[n - 1];
  for (std::size_t i = 0; i < n; ++i) {
    const S& a = x[i];
    const S& b = x[i + 1 < n ? i + 1 : 0];
    const S u = a * b + 0.5 * carry;
    switch (i % 4) {
    case 0:
      carry = sin(u);
      break;
    case 1:
      carry = exp(-u);
      break;
    case 2:
      carry = sqrt(1.0 + u * u);
      break;
    default:
      carry = u / (2.0 + a);
    }
    const S step = a - b;
    sum = sum + carry * step;
  }
  return S(sum * carry);
}

/// The seven-joint arm of the benches: Denavit–Hartenberg rows in Craig's convention, those of a
/// Panda. Row i: rotate by α about x, translate by a along x, rotate by θᵢ about z, translate by d
/// along z.
struct arm_row {
  double a;
  double d;
  double half_cos; ///< cos α/2
  double half_sin; ///< sin α/2
};

inline constexpr int joints = 7;
inline constexpr double half_root = 0.70710678118654752440;
inline constexpr std::array<arm_row, joints> arm = {{
    {0.0, 0.333, 1.0, 0.0},
    {0.0, 0.0, half_root, -half_root},
    {0.0, 0.316, half_root, half_root},
    {0.0825, 0.0, half_root, half_root},
    {-0.0825, 0.384, half_root, -half_root},
    {0.0, 0.0, half_root, half_root},
    {0.088, 0.107, half_root, half_root},
}};

template <class S>
struct pose {
  std::array<S, 3> position;
  std::array<S, 4> rotation; ///< unit quaternion, scalar first
};

/// Forward kinematics: pose of the flange.
template <class S>
pose<S> fk7(const inputs<S, joints>& angles) {
  using std::cos;
  using std::sin;
  S w(1.0), x(0.0), y(0.0), z(0.0);
  S px(0.0), py(0.0), pz(0.0);
  for (std::size_t i = 0; i < joints; ++i) {
    const arm_row& row = arm[i];
    const S half = 0.5 * angles[i];
    const S c = cos(half);
    const S s = sin(half);
    // First column of the rotation matrix, which the rotation about x does not change.
    const S x_axis_x = 1.0 - 2.0 * (y * y + z * z);
    const S x_axis_y = 2.0 * (x * y + w * z);
    const S x_axis_z = 2.0 * (x * z - w * y);
    const S w1 = w * row.half_cos - x * row.half_sin;
    const S x1 = x * row.half_cos + w * row.half_sin;
    const S y1 = y * row.half_cos + z * row.half_sin;
    const S z1 = z * row.half_cos - y * row.half_sin;
    w = w1 * c - z1 * s;
    x = x1 * c + y1 * s;
    y = y1 * c - x1 * s;
    z = z1 * c + w1 * s;
    const S z_axis_x = 2.0 * (x * z + w * y);
    const S z_axis_y = 2.0 * (y * z - w * x);
    const S z_axis_z = 1.0 - 2.0 * (x * x + y * y);
    px = px + x_axis_x * row.a + z_axis_x * row.d;
    py = py + x_axis_y * row.a + z_axis_y * row.d;
    pz = pz + x_axis_z * row.a + z_axis_z * row.d;
  }
  return {{px, py, pz}, {w, x, y, z}};
}

/// An arm of N joints that repeats the rows of the arm.
template <std::size_t N>
inline constexpr std::array<arm_row, N> long_arm = [] {
  std::array<arm_row, N> rows{};
  for (std::size_t i = 0; i < N; ++i) {
    rows[i] = arm[i % joints];
  }
  return rows;
}();

/// Rows: three of the position, four of the quaternion.
template <std::size_t N>
using long_pose_jacobian = std::array<std::array<double, N>, 7>;
using pose_jacobian = long_pose_jacobian<joints>;

/// The pose and its derivatives in closed form: joint i rotates the flange about its axis zᵢ
/// through its origin oᵢ, so ∂p/∂θᵢ = zᵢ × (p − oᵢ) and ∂q/∂θᵢ = ½ zᵢ q.
template <std::size_t N>
pose<double> long_arm_by_hand(const inputs<double, N>& angles, long_pose_jacobian<N>& jacobian) {
  std::array<std::array<double, 3>, N> axes;
  std::array<std::array<double, 3>, N> origins;
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
  double px = 0.0, py = 0.0, pz = 0.0;
  for (std::size_t i = 0; i < N; ++i) {
    const arm_row& row = long_arm<N>[i];
    px += row.a * (1.0 - 2.0 * (y * y + z * z));
    py += row.a * 2.0 * (x * y + w * z);
    pz += row.a * 2.0 * (x * z - w * y);
    const double w1 = w * row.half_cos - x * row.half_sin;
    const double x1 = x * row.half_cos + w * row.half_sin;
    const double y1 = y * row.half_cos + z * row.half_sin;
    const double z1 = z * row.half_cos - y * row.half_sin;
    const double c = std::cos(0.5 * angles[i]);
    const double s = std::sin(0.5 * angles[i]);
    w = w1 * c - z1 * s;
    x = x1 * c + y1 * s;
    y = y1 * c - x1 * s;
    z = z1 * c + w1 * s;
    axes[i] = {2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)};
    px += row.d * axes[i][0];
    py += row.d * axes[i][1];
    pz += row.d * axes[i][2];
    origins[i] = {px, py, pz};
  }
  for (std::size_t i = 0; i < N; ++i) {
    const auto& [ax, ay, az] = axes[i];
    const double rx = px - origins[i][0];
    const double ry = py - origins[i][1];
    const double rz = pz - origins[i][2];
    jacobian[0][i] = ay * rz - az * ry;
    jacobian[1][i] = az * rx - ax * rz;
    jacobian[2][i] = ax * ry - ay * rx;
    jacobian[3][i] = -0.5 * (ax * x + ay * y + az * z);
    jacobian[4][i] = 0.5 * (ax * w + ay * z - az * y);
    jacobian[5][i] = 0.5 * (ay * w + az * x - ax * z);
    jacobian[6][i] = 0.5 * (az * w + ax * y - ay * x);
  }
  return {{px, py, pz}, {w, x, y, z}};
}
inline pose<double> fk7_by_hand(const inputs<double, joints>& angles, pose_jacobian& jacobian) {
  return long_arm_by_hand(angles, jacobian);
}

} // namespace duet_bench
