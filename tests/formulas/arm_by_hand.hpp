// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "formulas/by_hand.hpp"

#include <array>
#include <cmath>
#include <cstddef>

/// \file
/// Kinematics of arms from the tables of their manufacturers, for closed forms that share no code
/// with duet.

namespace by_hand {

template <class T>
using six = std::array<T, 6>;

/// Denavit–Hartenberg parameters: a and d in metres, α and the offset of θ in quarter turns.
struct arm_row {
  double length, offset;
  int twist, angle_offset;
};

template <std::size_t N>
struct arm_table {
  bool is_modified; ///< true if a and α precede the joint
  std::array<arm_row, N> rows;
  double flange; ///< distance from the last frame along its z axis
};

inline constexpr arm_table<7> panda_table{true,
                                          {{{0, .333, 0, 0},
                                            {0, 0, -1, 0},
                                            {0, .316, 1, 0},
                                            {.0825, 0, 1, 0},
                                            {-.0825, .384, -1, 0},
                                            {0, 0, 1, 0},
                                            {.088, 0, 1, 0}}},
                                          .107};
inline constexpr arm_table<7> iiwa14_table{false,
                                           {{{0, .36, -1, 0},
                                             {0, 0, 1, 0},
                                             {0, .42, 1, 0},
                                             {0, 0, -1, 0},
                                             {0, .4, -1, 0},
                                             {0, 0, 1, 0},
                                             {0, .126, 0, 0}}},
                                           0};
inline constexpr arm_table<6> ur5e_table{false,
                                         {{{0, .1625, 1, 0},
                                           {-.425, 0, 0, 0},
                                           {-.3922, 0, 0, 0},
                                           {0, .1333, 1, 0},
                                           {0, .0997, -1, 0},
                                           {0, .0996, 0, 0}}},
                                         0};
inline constexpr arm_table<7> baxter_left_table{false,
                                                {{{.069, .27035, -1, 0},
                                                  {0, 0, 1, 1},
                                                  {.069, .36442, -1, 0},
                                                  {0, 0, 1, 0},
                                                  {.01, .37429, -1, 0},
                                                  {0, 0, 1, 0},
                                                  {0, .229525, 0, 0}}},
                                                0};

/// The arm at θ, and its rates along dθ: γ = [t; α] of the tip and the joints' screws.
template <class T, std::size_t N>
struct arm {
  v3<T> t, dt;
  q4<T> alpha, dalpha;
  std::array<six<T>, N> columns, dcolumns; ///< [v; ω], v at the origin

  arm(const arm_table<N>& table, const std::array<T, N>& theta, const std::array<T, N>& dtheta) {
    using std::cos, std::sin;
    t = dt = {T(0), T(0), T(0)};
    alpha = {T(1), T(0), T(0), T(0)};
    v3<T> v = t, w = t; // velocity at the origin and angular velocity of the preceding link
    for (std::size_t i = 0; i < N; ++i) {
      const arm_row& row = table.rows[i];
      if (table.is_modified) {
        shift(row.length, 0);
        quarters<1>(row.twist);
        shift(0, row.offset);
      }
      const v3<T> z = vec(product(product(alpha, q4<T>{T(0), T(0), T(0), T(1)}), conj(alpha)));
      const v3<T> m = cross(t, z);
      columns[i] = {m[0], m[1], m[2], z[0], z[1], z[2]};
      const v3<T> dz = cross(w, z), dm = plus(cross(w, m), cross(v, z));
      dcolumns[i] = {dm[0], dm[1], dm[2], dz[0], dz[1], dz[2]};
      v = plus(v, times(dtheta[i], m));
      w = plus(w, times(dtheta[i], z));
      const T half = theta[i] / 2;
      alpha = product(alpha, q4<T>{T(cos(half)), T(0), T(0), T(sin(half))});
      quarters<3>(row.angle_offset);
      if (!table.is_modified) {
        shift(row.length, row.offset);
        quarters<1>(row.twist);
      }
    }
    shift(0, table.flange);
    dt = plus(v, cross(w, t));
    dalpha = times(T(0.5), product(pure(w), alpha));
  }

  /// Σ a bᵀ of columns.
  static std::array<six<T>, 6> gram(const std::array<six<T>, N>& a,
                                    const std::array<six<T>, N>& b) {
    std::array<six<T>, 6> result;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) {
        result[i][j] = T(0);
        for (std::size_t k = 0; k < N; ++k) {
          result[i][j] += a[k][i] * b[k][j];
        }
      }
    }
    return result;
  }

private:
  void shift(double x, double z) {
    t = plus(t, vec(product(product(alpha, pure(v3<T>{T(x), T(0), T(z)})), conj(alpha))));
  }
  /// Rotation by 0 or ±1 quarter turns about the x axis (1) or the z axis (3).
  template <std::size_t Axis>
  void quarters(int count) {
    using std::sqrt;
    if (count != 0) {
      const T root = sqrt(T(0.5));
      q4<T> rotation{root, T(0), T(0), T(0)};
      rotation[Axis] = count * root;
      alpha = product(alpha, rotation);
    }
  }
};

} // namespace by_hand
