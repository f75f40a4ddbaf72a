// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/own_numbers.hpp>
#include <duet/core/structure.hpp>
#include <duet/dual/eigen/structure.hpp>

#include <type_traits>
#include <utility>

/// \file
/// What a function that duet calls may return.

namespace duet::detail {

/// What a function of the caller's returned, as an object of its own. (Its type is deduced, so that
/// compilers say first of all what is wrong, also where only the type is asked for.)
template <class X>
[[nodiscard]] constexpr auto result_of_call(X&& x) {
  using result = std::remove_cvref_t<X>;
  require_own_numbers<result>();
  static_assert(
      refers_elsewhere<result> || requires { sizeof(structure<result>); },
      "duet: a function must return a scalar, an Eigen vector or matrix, a rotation, a "
      "pose, or a std::array, std::tuple or std::pair of these");
  return std::forward<X>(x);
}

} // namespace duet::detail
