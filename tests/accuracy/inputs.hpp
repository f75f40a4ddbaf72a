// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "accuracy/probe.hpp"
#include "support/random.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Rotations and poses on which formulas fail, rounded once from 100 digits.

namespace duet_test::accuracy {

struct named {
  const char* name;
  double value;
};

inline constexpr double pi = 3.141592653589793;

/// Angles, with the hard ones first.
inline constexpr named hard_angles[] = {
    {"identity", 0},
    {"angle 1e-8", 1e-8},
    {"half turn", pi},
    {"angle 2", 2},
    {"1e-4 from a full turn", 2 * pi - 1e-4},
    {"angle 1e-300", 1e-300},
    {"angle 1e-3", 1e-3},
    {"1e-8 from a half turn", pi - 1e-8},
    {"angle 0.3", 0.3},
    {"angle 1e-30", 1e-30},
    {"angle 1", 1},
    {"angle 1.9", 1.9},
    {"beyond a half turn", 4},
    {"angle 1e-16", 1e-16},
    {"angle 2.9", 2.9},
    {"1e-2 from a full turn", 2 * pi - 1e-2},
};
inline constexpr named hard_lengths[] = {
    {"translation 1", 1},         {"no translation", 0},          {"translation 1e8", 1e8},
    {"translation 1e-8", 1e-8},   {"translation 1e-300", 1e-300}, {"translation 30", 30},
    {"translation 1e100", 1e100},
};

/// The directions in which axes, translations and rates point.
[[nodiscard]] inline std::array<double, 3> some_direction(random_source& random, int kind) {
  if (kind % 5 == 4) {
    std::array<double, 3> d = {0, 0, 0};
    d[std::size_t(kind / 5 % 3)] = 1;
    return d;
  }
  return random.direction<3>();
}

/// Rates: 0 of order one, 1 in proportion, 2 few of them.
[[nodiscard]] inline numbers some_rates(random_source& random, const numbers& x, int kind) {
  numbers d;
  for (const double v : x) {
    const double normal = random.normal();
    d.push_back(kind % 3 == 0   ? normal
                : kind % 3 == 1 ? normal * v
                                : (random.uniform(0, 1) < 0.3 ? normal : 0));
  }
  return d;
}

/// The unit quaternion of a rotation about a unit vector, in 100 digits.
[[nodiscard]] inline std::array<real, 4> exact_rotation(const std::array<double, 3>& axis,
                                                        double angle) {
  const real x(axis[0]), y(axis[1]), z(axis[2]), half = real(angle) / 2;
  const real factor = sin(half) / sqrt(x * x + y * y + z * z);
  return {cos(half), x * factor, y * factor, z * factor};
}

/// The n-th hard rotation, four numbers.
[[nodiscard]] inline input hard_rotation(int n, random_source& random) {
  const named angle = hard_angles[std::size_t(n) % std::size(hard_angles)];
  input result{angle.name, {}, {}, {1, 3}};
  for (const real& c : exact_rotation(some_direction(random, n), angle.value)) {
    result.x.push_back(double(c));
  }
  result.direction = some_rates(random, result.x, n / 2);
  return result;
}

/// The n-th hard pose, the eight numbers of a unit dual quaternion.
[[nodiscard]] inline input hard_pose(int n, random_source& random) {
  const named angle = hard_angles[std::size_t(n) % std::size(hard_angles)];
  const named length = hard_lengths[std::size_t(n) % std::size(hard_lengths)];
  const auto axis = some_direction(random, n);
  const auto along = n % 4 == 3 ? axis : some_direction(random, n / 3);
  const auto a = exact_rotation(axis, angle.value);
  real half[3];
  for (std::size_t i = 0; i < 3; ++i) {
    half[i] = real(along[i]) * length.value / 2;
  }
  input result{std::string(angle.name) + ", " + length.name, {}, {}, {1, 3, 1, 3}};
  for (const real& c : a) {
    result.x.push_back(double(c));
  }
  // ½ t α
  result.x.push_back(double(real(-half[0] * a[1] - half[1] * a[2] - half[2] * a[3])));
  result.x.push_back(double(real(half[0] * a[0] + half[1] * a[3] - half[2] * a[2])));
  result.x.push_back(double(real(half[1] * a[0] + half[2] * a[1] - half[0] * a[3])));
  result.x.push_back(double(real(half[2] * a[0] + half[0] * a[2] - half[1] * a[1])));
  result.direction = some_rates(random, result.x, n / 2);
  return result;
}

/// Both inputs as one.
[[nodiscard]] inline input joined(input a, const input& b) {
  a.where += "; " + b.where;
  a.x.insert(a.x.end(), b.x.begin(), b.x.end());
  a.direction.insert(a.direction.end(), b.direction.begin(), b.direction.end());
  a.parts.insert(a.parts.end(), b.parts.begin(), b.parts.end());
  return a;
}
[[nodiscard]] inline input joined(input a, double x, double rate) {
  a.x.push_back(x);
  a.direction.push_back(rate);
  a.parts.push_back(1);
  return a;
}

} // namespace duet_test::accuracy
