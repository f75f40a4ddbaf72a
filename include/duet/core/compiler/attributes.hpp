// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiler/target.hpp>

/// \file
/// Attributes and pragmas for compilers. In plain C++20 all of them are empty.

/// The arithmetic of small numbers must be inlined whatever the compiler's size heuristics decide:
/// a call spills every partial to memory. Without optimisation it would only slow down compilation
/// and debugging.
#if defined(__OPTIMIZE__) && !defined(DUET_PORTABLE)
#define DUET_ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define DUET_ALWAYS_INLINE inline
#endif

/// Inlines a lambda as DUET_ALWAYS_INLINE does a function; placed between its parameters and its
/// body.
#if defined(__OPTIMIZE__) && !defined(DUET_PORTABLE)
#define DUET_INLINE_LAMBDA __attribute__((always_inline))
#else
#define DUET_INLINE_LAMBDA
#endif

/// At the beginning of a body: allows its products and sums to be fused with those around them, if
/// the target multiplies and adds in one step. g++ does so by itself; clang does it within one
/// expression only, as if bodies were not inlined. If it is defined as nothing, -ffp-contract alone
/// decides.
#ifndef DUET_CONTRACTED
#if defined(__clang__) && !defined(DUET_PORTABLE)
#define DUET_CONTRACTED _Pragma("clang fp contract(fast)")
#else
#define DUET_CONTRACTED
#endif
#endif

/// Attributes: a function that is never inlined, one that is rarely called, a variable that is kept
/// although it is never read.
#ifdef DUET_PORTABLE
#define DUET_OUT_OF_LINE
#define DUET_COLD
#define DUET_KEPT
#else
#define DUET_OUT_OF_LINE [[gnu::noinline]]
#define DUET_COLD [[gnu::cold]]
#define DUET_KEPT [[gnu::used]]
#endif

/// Marks a member that takes no space if its type is empty. For compatibility with old layouts MSVC
/// has another name for it and ignores the standard's.
#ifdef _MSC_VER
#define DUET_NO_UNIQUE_ADDRESS [[msvc::no_unique_address]]
#else
#define DUET_NO_UNIQUE_ADDRESS [[no_unique_address]]
#endif

/// Compiler barrier: memory may have changed, so that the compiler reads again what it would have
/// copied to the stack.
#ifdef DUET_PORTABLE
#define DUET_REREAD_MEMORY()
#else
#define DUET_REREAD_MEMORY() __asm__ volatile("" ::: "memory")
#endif
