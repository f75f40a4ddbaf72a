// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>

/// \file
/// Work on the parts of an infinitesimal number, down to the real numbers it is made of.

namespace duet::detail {

/// f of every real number in x: its value first, then all its infinitesimal parts, always in the
/// same order.
template <class T, class F>
[[nodiscard]] T map_reals(const T& x, F&& f) {
  if constexpr (!Infinitesimal<T>) {
    return f(x);
  } else if constexpr (requires { x.partials(); }) {
    const auto part = [&](const auto& p) { return map_reals(p, f); };
    const auto value = part(x.value());
    return T(value, T::partials_type::map_elements(part, x.partials()));
  } else if constexpr (requires { x.hessian(); }) {
    return x.map_parts([&](const auto& p) { return map_reals(p, f); });
  } else {
    T result = x;
    constexpr int highest = scalar_traits<T>::order - scalar_traits<typename T::value_type>::order;
    for (int k = 0; k <= highest; ++k) {
      result.set_coefficient(k, map_reals(x.coefficient(k), f));
    }
    return result;
  }
}

/// x with another real number as its innermost value; all infinitesimal parts stay.
template <class T>
[[nodiscard]] T with_innermost(const T& x, const real_type_t<T>& value) {
  if constexpr (!Infinitesimal<T>) {
    return value;
  } else if constexpr (requires { x.partials(); }) {
    return T(with_innermost(x.value(), value), x.partials());
  } else if constexpr (requires { x.hessian(); }) {
    return T(with_innermost(x.value(), value), x.gradient(), x.hessian());
  } else {
    T result = x;
    result.set_coefficient(0, with_innermost(x.value(), value));
    return result;
  }
}

} // namespace duet::detail
