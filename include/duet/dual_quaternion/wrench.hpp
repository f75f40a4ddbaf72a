// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual_quaternion/twist.hpp>

/// \file
/// Forces and moments on rigid bodies, the duals of twists: columns [f; m] with the power
/// f·v + m·ω, which no choice of frame changes.

namespace duet {

/// The coadjoint [R 0; t̂R R] = Ad(A)⁻ᵀ: carries wrenches [f; m], m about the origin, as Ad(A)
/// carries twists: F^s = coAd(A) F^b, and (coAd(A) F)·(Ad(A) V) = F·V.
template <class T>
[[nodiscard]] matrix6<T> coAd(const dual_quaternion<T>& a) {
  const matrix6<T> m = Ad(a);
  matrix6<T> result = matrix6<T>::Zero();
  result.template topLeftCorner<3, 3>() = m.template topLeftCorner<3, 3>();
  result.template bottomRightCorner<3, 3>() = m.template topLeftCorner<3, 3>();
  result.template bottomLeftCorner<3, 3>() = m.template topRightCorner<3, 3>();
  return result;
}

/// −ad(V)ᵀ: the rate of coAd(exp(½ V t)) F at t = 0 is coad(V) F.
template <class T>
[[nodiscard]] matrix6<T> coad(const vector6<T>& twist) {
  return -ad(twist).transpose();
}

} // namespace duet
