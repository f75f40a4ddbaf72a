// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// Requirements on the compiler and its flags. (Compiler-specific code is in core/compiler/.)

#ifdef _MSVC_LANG
#define DUET_LANGUAGE _MSVC_LANG
#else
#define DUET_LANGUAGE __cplusplus
#endif
#if DUET_LANGUAGE < 202002L
// After an #error compilers continue, with thousands of errors; at a missing file they stop.
#include "duet: needs C++20: compile with -std=c++20"
#endif
#undef DUET_LANGUAGE

#if (defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)) &&         \
    !defined(DUET_ALLOW_FAST_MATH)
#error                                                                                             \
    "duet: -ffast-math drops NaN, infinities and signed zeros, on which structural zeros rely; compile without it, or define DUET_ALLOW_FAST_MATH to take that risk"
#endif

#include <duet/core/compiler/target.hpp>
