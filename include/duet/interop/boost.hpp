// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/quaternion/quaternion.hpp>

#include <boost/math/quaternion.hpp>

/// \file
/// Conversion to and from `boost::math::quaternion`: the same algebra, scalar part first.

namespace duet {

/// q as Boost's, component by component.
template <class T>
[[nodiscard]] boost::math::quaternion<T> to_boost(const quaternion<T>& q) {
  return boost::math::quaternion<T>(q.w(), q.x(), q.y(), q.z());
}

/// Boost's q as duet's, component by component.
template <class T>
[[nodiscard]] quaternion<T> from_boost(const boost::math::quaternion<T>& q) {
  return {q.R_component_1(), q.R_component_2(), q.R_component_3(), q.R_component_4()};
}

} // namespace duet
