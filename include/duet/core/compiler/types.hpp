// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <bit>
#include <string_view>
#include <type_traits>

/// \file
/// Type information from compiler built-ins; `std::bit_cast`, also if the compiler supports it but
/// the standard library does not, as libc++ 13.

namespace duet::detail {

/// True if A and B are the same type. The built-in instantiates no class template.
#ifdef DUET_PORTABLE
#define DUET_IS_SAME(A, B) std::is_same_v<A, B>
#else
#define DUET_IS_SAME(A, B) __is_same(A, B)
#endif

/// A text that differs for every type, and is longer for a type whose name contains another's.
/// (`std::source_location` has it, too, in the standard libraries of newer compilers.)
template <class T>
[[nodiscard]] constexpr std::string_view type_text() {
#if defined(_MSC_VER) && !defined(__clang__)
  return __FUNCSIG__;
#else
  return __PRETTY_FUNCTION__;
#endif
}

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
