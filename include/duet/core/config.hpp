// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// What duet needs of the compiler and its flags. (What it knows of each is in core/compiler/.)

#ifdef _MSVC_LANG
#define DUET_LANGUAGE _MSVC_LANG
#else
#define DUET_LANGUAGE __cplusplus
#endif
#if DUET_LANGUAGE < 202002L
// After an #error compilers go on, with thousands of errors; where a file is missing they stop.
#include "duet: needs C++20: compile with -std=c++20"
#endif
#undef DUET_LANGUAGE

#if (defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)) &&         \
    !defined(DUET_ALLOW_FAST_MATH)
#error                                                                                             \
    "duet: -ffast-math drops NaN, infinities and signed zeros, on which structural zeros rely; compile without it, or define DUET_ALLOW_FAST_MATH to take that risk"
#endif

#include <duet/core/compiler/attributes.hpp>
#include <duet/core/compiler/target.hpp>
