// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <cstring>

/// \file
/// Sine and cosine of several doubles at once, over the compilers' vectors.

namespace duet::detail {

template <class V>
struct vector_sine_cosine_result {
  V sine;
  V cosine;
};

/// Beyond this, three parts of π/2 are too few.
inline constexpr double vector_sine_cosine_limit = 8e5;

template <class Bits, class V>
[[nodiscard]] DUET_ALWAYS_INLINE V with_flipped_sign(const V& x, const Bits& sign) {
  Bits bits;
  std::memcpy(&bits, &x, sizeof(V));
  bits ^= sign;
  V result;
  std::memcpy(&result, &bits, sizeof(V));
  return result;
}

/// sin x and cos x lane by lane, for |x| < vector_sine_cosine_limit; elsewhere anything.
///
/// \tparam V  a vector of doubles of any width
///
/// x − n π/2 = r + e, n whole, |r| ≤ π/4, by π/2 in three parts (Cody and Waite), of which the
/// first two have 33 bits, so that n times them is exact; then the polynomials of fdlibm (k_sin.c,
/// k_cos.c). Off by less than 1 ulp.
template <class V>
[[nodiscard]] DUET_ALWAYS_INLINE vector_sine_cosine_result<V> vector_sine_cosine(const V& x) {
  using mask = decltype(V{} == V{});
  // Added to a number below 2^51, it leaves its whole part in the lowest bits.
  constexpr double shifter = 0x1.8p52;
  const V shifted = x * 0x1.45f306dc9c883p-1 + shifter;
  const V n = shifted - shifter;
  mask quadrant;
  std::memcpy(&quadrant, &shifted, sizeof(V));

  const V first = x - n * 0x1.921fb544p0;
  const V second = n * 0x1.0b4611a6p-34;
  const V difference = first - second;
  const V third = n * 0x1.3198a2e037073p-69 - ((first - difference) - second);
  const V r = difference - third;
  const V e = (difference - r) - third;

  const V z = r * r;
  const V odd = 8.33333333332248946124e-03 +
                z * (-1.98412698298579493134e-04 +
                     z * (2.75573137070700676789e-06 +
                          z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
  const V cube = z * r;
  const V sine = r - ((z * (0.5 * e - cube * odd) - e) - cube * -1.66666666666666324348e-01);

  const V even =
      z * (4.16666666666666019037e-02 +
           z * (-1.38888888888741095749e-03 +
                z * (2.48015872894767294178e-05 +
                     z * (-2.75573143513906633035e-07 +
                          z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
  const V half = 0.5 * z;
  const V about_one = 1.0 - half;
  const V cosine = about_one + (((1.0 - about_one) - half) + (z * even - r * e));

  // sin and cos of the quadrants: ±s, ±c; ±c, ∓s; …
  const mask is_odd = (quadrant & 1) != 0;
  return {with_flipped_sign<mask>(is_odd ? cosine : sine, (quadrant & 2) << 62),
          with_flipped_sign<mask>(is_odd ? sine : cosine, ((quadrant + 1) & 2) << 62)};
}

} // namespace duet::detail
