// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "formulas/formula.hpp"

#include <duet/dual_quaternion/dual_quaternion.hpp>
#include <duet/quaternion/quaternion.hpp>

/// \file
/// Conversion between rows of numbers and arguments of duet's functions.

namespace duet_formulas {

template <class T>
duet::quaternion<T> q_of(const numbers<T>& x, std::size_t i) {
  return {x[i], x[i + 1], x[i + 2], x[i + 3]};
}
template <class T>
duet::vector3<T> v_of(const numbers<T>& x, std::size_t i) {
  return {x[i], x[i + 1], x[i + 2]};
}

template <class T>
void append(numbers<T>& y, const T& x) {
  y.push_back(x);
}
template <class T>
void append(numbers<T>& y, const duet::quaternion<T>& q) {
  y.insert(y.end(), {q.w(), q.x(), q.y(), q.z()});
}
template <class T>
void append(numbers<T>& y, const duet::vector3<T>& v) {
  y.insert(y.end(), {v[0], v[1], v[2]});
}
template <class T>
void append(numbers<T>& y, const duet::screw_dual<T>& d) {
  y.insert(y.end(), {d.value(), d.epsilon()});
}
template <class T>
void append(numbers<T>& y, const duet::dual_vector<T>& v) {
  append(y, real_part(v));
  append(y, dual_part(v));
}
template <class T>
void append(numbers<T>& y, const duet::dual_quaternion<T>& a) {
  append(y, real_part(a));
  append(y, dual_part(a));
}
template <class T, class... A>
numbers<T> all(const A&... a) {
  numbers<T> y;
  (append(y, a), ...);
  return y;
}

} // namespace duet_formulas
