// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual_quaternion/twist.hpp>
#include <duet/quaternion/quaternion.hpp>

/// \file
/// Halved angular velocities and twists, the form in which splines compute.

namespace duet::detail {

/// Half of a rate, as a vector or a dual vector.
template <class T, class V>
[[nodiscard]] vector3<T> half_rate(const V& rate) {
  const real_type_t<T> half(0.5);
  if constexpr (V::SizeAtCompileTime == 6) {
    using S = typename scalar_traits<T>::value_type;
    return dual_vector_of(vector6<S>(rate.template cast<S>())) * half;
  } else {
    return rate.template cast<T>() * half;
  }
}

} // namespace duet::detail
