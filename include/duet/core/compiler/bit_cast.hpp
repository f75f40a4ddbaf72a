// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <bit>

/// \file
/// `std::bit_cast`, also if the compiler supports it but the standard library does not, as libc++
/// 13.

namespace duet::detail {

/// `std::bit_cast<To>(x)`.
template <class To, class From>
[[nodiscard]] constexpr To bit_cast(const From& x) noexcept {
#ifdef __cpp_lib_bit_cast
  return std::bit_cast<To>(x);
#else
  return __builtin_bit_cast(To, x);
#endif
}

} // namespace duet::detail
