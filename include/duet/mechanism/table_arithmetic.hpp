// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/constants.hpp>
#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>

#include <array>
#include <concepts>
#include <limits>
#include <numbers>

/// \file
/// Arithmetic of the constants in a mechanism's table, which the compiler can do: the functions of
/// the standard library are not `constexpr`.

namespace duet::detail {

template <class T>
[[nodiscard]] constexpr bool is_finite(const std::array<T, 3>& a) {
  return a[0] - a[0] == 0 && a[1] - a[1] == 0 && a[2] - a[2] == 0;
}

template <class T>
[[nodiscard]] constexpr T squared_norm(const std::array<T, 3>& a) {
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

/// How far from 1 the squared norm of an axis or of a constant rotation may be, as they are written
/// with few digits.
template <class T>
[[nodiscard]] constexpr bool is_nearly_one(const T& square) {
  return square - 1 <= 2e-3 && 1 - square <= 2e-3;
}

/// 1/√s for s near 1, by Newton's method.
template <class T>
[[nodiscard]] constexpr T inverse_root_near_one(const T& s) {
  T x(1);
  for (int i = 0; i < 8; ++i) {
    x = x * (3 - s * x * x) / 2;
  }
  return x;
}

/// A unit vector of which what is 0 or ±1 but for rounding is so: the products of its components
/// are then left out where the table is known to the compiler.
template <class T>
[[nodiscard]] constexpr three_vector<T> cleaned_direction(three_vector<T> n) {
  const T tolerance = 8 * std::numeric_limits<T>::epsilon();
  for (T* x : {&n.x, &n.y, &n.z}) {
    for (const int value : {-1, 0, 1}) {
      if (*x - value <= tolerance && value - *x <= tolerance) {
        *x = T(value);
      }
    }
  }
  return n;
}

template <class T>
struct table_angle {
  T sine, cosine;
};

/// sin and cos of a constant angle. Multiples of a quarter turn are exact, although π/2 of the
/// table is a rounded number: it means a right angle.
template <class T>
[[nodiscard]] constexpr table_angle<T> sine_and_cosine_of_constant(const T& angle) {
  T quarter{};
  if constexpr (std::floating_point<T>) {
    quarter = std::numbers::pi_v<T> / 2;
  } else {
    quarter = constant::pi<T>() / 2;
  }
  const T turns = angle / quarter;
  const auto quarters = static_cast<long long>(turns + (turns < 0 ? T(-0.5) : T(0.5)));
  const T rest = angle - T(quarters) * quarter;
  T cosine(1), sine(rest), term(rest);
  T even(1);
  for (int k = 1; k < 60; ++k) {
    even = even * -rest * rest / ((2 * k - 1) * (2 * k));
    term = term * -rest * rest / ((2 * k) * (2 * k + 1));
    cosine = cosine + even;
    sine = sine + term;
  }
  switch ((quarters % 4 + 4) % 4) {
  case 0:
    return {sine, cosine};
  case 1:
    return {cosine, -sine};
  case 2:
    return {-sine, -cosine};
  default:
    return {-cosine, sine};
  }
}

/// Rotation about the axis 0 = x, 1 = y, 2 = z.
template <class T>
[[nodiscard]] constexpr quaternion<T> turn_about(int axis, const T& angle) {
  const table_angle<T> half = sine_and_cosine_of_constant(T(angle / 2));
  const T zero(0);
  return {half.cosine, axis == 0 ? half.sine : zero, axis == 1 ? half.sine : zero,
          axis == 2 ? half.sine : zero};
}

} // namespace duet::detail
