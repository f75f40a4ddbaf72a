// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/derivative/manifold.hpp>
#include <duet/derivative/structure.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>

#include <type_traits>

/// \file
/// What `derivative/` must know of quaternions: their scalars, and the tangent space of rotations.

namespace duet {

template <class T>
struct structure<quaternion<T>> {
  template <class F>
  [[nodiscard]] static constexpr auto map(F&& f, const quaternion<T>& q) {
    using result = std::decay_t<std::invoke_result_t<F, const T&>>;
    return quaternion<result>(f(q.w()), f(q.x()), f(q.y()), f(q.z()));
  }
};

/// A rotation is moved by a small rotation vector in spatial axes: exp(δ/2) q.
template <class T>
struct manifold<quaternion<T>> {
  static constexpr int dimension = 3;
  template <class Delta>
  [[nodiscard]] static auto plus(const quaternion<T>& q, const Delta& delta) {
    using S = std::decay_t<decltype(delta[0])>;
    return duet::exp(vector3<S>(delta[0] / 2, delta[1] / 2, delta[2] / 2)) * q;
  }
};

} // namespace duet
