// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/dual/promotion.hpp>
#include <duet/quaternion/quaternion.hpp>

/// \file
/// Operations on 3-vectors, of two scalars, coefficient by coefficient: Eigen's expressions would
/// load two coefficients at once just after they were stored one by one, and the processor waits
/// for that.

namespace duet::detail {

/// a b
template <class A, class B>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<promote_t<A, B>> scaled(const A& a, const vector3<B>& b) {
  return {a * b[0], a * b[1], a * b[2]};
}

/// a + N b
template <int N = 1, class A, class B>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<promote_t<A, B>> sum_of(const vector3<A>& a,
                                                                 const vector3<B>& b) {
  if constexpr (N == 1) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  } else {
    const real_type_t<B> n(N);
    return {a[0] + n * b[0], a[1] + n * b[1], a[2] + n * b[2]};
  }
}

template <class A, class B>
[[nodiscard]] DUET_ALWAYS_INLINE promote_t<A, B> inner_product(const vector3<A>& a,
                                                               const vector3<B>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class A, class B>
[[nodiscard]] DUET_ALWAYS_INLINE vector3<promote_t<A, B>> cross_product(const vector3<A>& a,
                                                                        const vector3<B>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

} // namespace duet::detail
