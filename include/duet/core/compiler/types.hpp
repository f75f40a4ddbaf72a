// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <string_view>
#include <type_traits>

/// \file
/// What only compilers know of types.

namespace duet::detail {

/// Are they the same type? The compiler's own answer makes no class template.
#ifdef DUET_PORTABLE
#define DUET_IS_SAME(A, B) std::is_same_v<A, B>
#else
#define DUET_IS_SAME(A, B) __is_same(A, B)
#endif

/// A text that is another for every type, and longer for one that has the other within its name.
/// (`std::source_location` has it, too, in the standard libraries of newer compilers.)
template <class T>
[[nodiscard]] constexpr std::string_view type_text() {
#if defined(_MSC_VER) && !defined(__clang__)
  return __FUNCSIG__;
#else
  return __PRETTY_FUNCTION__;
#endif
}

} // namespace duet::detail
