// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>

#include <limits>

/// \file
/// `std::numeric_limits` of infinitesimal numbers: those of the innermost real, as constants.

namespace duet::detail {

template <class D>
struct infinitesimal_limits : std::numeric_limits<real_type_t<D>> {
  using real_limits = std::numeric_limits<real_type_t<D>>;
  static constexpr D min() noexcept { return real_limits::min(); }
  static constexpr D max() noexcept { return real_limits::max(); }
  static constexpr D lowest() noexcept { return real_limits::lowest(); }
  static constexpr D epsilon() noexcept { return real_limits::epsilon(); }
  static constexpr D round_error() noexcept { return real_limits::round_error(); }
  static constexpr D infinity() noexcept { return real_limits::infinity(); }
  static constexpr D quiet_NaN() noexcept { return real_limits::quiet_NaN(); }
  static constexpr D signaling_NaN() noexcept { return real_limits::signaling_NaN(); }
  static constexpr D denorm_min() noexcept { return real_limits::denorm_min(); }
};

} // namespace duet::detail

template <duet::Infinitesimal D>
class std::numeric_limits<D> : public duet::detail::infinitesimal_limits<D> {};
