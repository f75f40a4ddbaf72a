// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// What duet needs to know of the compiler and its target.

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

/// Width in bytes of the vectors that batches fill, the target's own, and of those that packed
/// partials are stored in: the same, save that clang does better with two 256-bit vectors there
/// than with one of 512 bits, where a row fills no more than two of these.
#if defined(__AVX512F__)
#define DUET_BATCH_BYTES 64
#ifdef __clang__
#define DUET_VECTOR_BYTES 32
#define DUET_ABI_NAMESPACE vector_512_in_halves
#else
#define DUET_VECTOR_BYTES 64
#define DUET_ABI_NAMESPACE vector_512
#endif
#elif defined(__AVX__)
#define DUET_BATCH_BYTES 32
#define DUET_VECTOR_BYTES 32
#define DUET_ABI_NAMESPACE vector_256
#else
#define DUET_BATCH_BYTES 16
#define DUET_VECTOR_BYTES 16
#define DUET_ABI_NAMESPACE vector_128
#endif

/// The vector width follows the compiler's -m flags and is part of the layout of `dual`. This
/// inline namespace makes it part of the name too: files built with different flags do not link.
#define DUET_ABI_BEGIN inline namespace DUET_ABI_NAMESPACE {
#define DUET_ABI_END }

/// The arithmetic of small numbers must be inlined whatever the compiler's size heuristics think:
/// a call spills every partial to memory. Where nothing is optimised, it would only make
/// compilation slower and the steps of a debugger longer.
#ifdef __OPTIMIZE__
#define DUET_ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define DUET_ALWAYS_INLINE inline
#endif

/// Inlines a lambda as DUET_ALWAYS_INLINE does a function; stands between its parameters and its
/// body.
#ifdef __OPTIMIZE__
#define DUET_INLINE_LAMBDA __attribute__((always_inline))
#else
#define DUET_INLINE_LAMBDA
#endif

/// At the beginning of a body: its products and sums may be fused with those around them, where the
/// target multiplies and adds in one step. g++ does so by itself; clang does it within one
/// expression only, as if bodies were not inlined. Defined as nothing, -ffp-contract alone decides.
#ifndef DUET_CONTRACTED
#ifdef __clang__
#define DUET_CONTRACTED _Pragma("clang fp contract(fast)")
#else
#define DUET_CONTRACTED
#endif
#endif
