// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "accuracy/probe.hpp"
#include "support/random.hpp"

/// \file
/// Rotations and poses at which formulas may fail, rounded once from 100 digits.

namespace duet_test::accuracy {

struct named {
  const char* name;
  double value;
};

inline constexpr double pi = 3.141592653589793;

/// Angles, difficult ones first.
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

/// Directions of axes, translations and rates.
[[nodiscard]] std::array<double, 3> some_direction(random_source& random, int kind);

/// Kinds of rates: 0 of order one, 1 proportional to the values, 2 only a few nonzero ones.
[[nodiscard]] numbers some_rates(random_source& random, const numbers& x, int kind);

/// The n-th difficult rotation, four numbers.
[[nodiscard]] input hard_rotation(int n, random_source& random);

/// The n-th difficult pose, the eight numbers of a unit dual quaternion.
[[nodiscard]] input hard_pose(int n, random_source& random);

/// The input with rates of the quaternion at x[first] that preserve its norm.
[[nodiscard]] input of_constant_norm(input at, std::size_t first);
/// The input with rates of the dual quaternion at x[first] that preserve its norm.
[[nodiscard]] input of_constant_dual_norm(input at, std::size_t first);

/// Both inputs concatenated.
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
