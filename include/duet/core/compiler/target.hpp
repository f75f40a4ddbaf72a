// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// Detection of the compiler and the target; attributes and pragmas, all of them empty in plain
/// C++20.
///
/// This folder is the seam between duet and a compiler's extensions of C++20: nothing else in
/// duet's headers names a compiler, a processor or an extension (house/tree). Every name here has a
/// version in plain C++20 as well, which gives the same results. It is used if the compiler lacks
/// GNU's extensions, and if a program defines `DUET_PORTABLE`, so that it can be tested.

#if !defined(DUET_PORTABLE) && !defined(__GNUC__) && !defined(__clang__)
#define DUET_PORTABLE
#endif

/// Width in bytes of the vectors that batches fill, the target's own, and of those that packed
/// partials are stored in: the same, except that clang does better with two 256-bit vectors there
/// than with one of 512 bits, if a row fills no more than two of these.
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

/// The vector width follows the compiler's -m flags and is part of the layout of `dual`, and so is
/// the kind of vectors, the compiler's or arrays. These inline namespaces make both part of the
/// name too: files built with different settings do not link.
#ifdef DUET_PORTABLE
#define DUET_ABI_BEGIN                                                                             \
  inline namespace portable {                                                                      \
  inline namespace DUET_ABI_NAMESPACE {
#define DUET_ABI_END                                                                               \
  }                                                                                                \
  }
#else
#define DUET_ABI_BEGIN inline namespace DUET_ABI_NAMESPACE {
#define DUET_ABI_END }
#endif

namespace duet::detail {

/// clang gains less from a rarely taken branch than from masks, g++ the other way round.
#ifdef __clang__
inline constexpr bool masks_beat_branches = true;
#else
inline constexpr bool masks_beat_branches = false;
#endif

} // namespace duet::detail

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

/// Attributes: a function that is never inlined, one that is rarely called.
#ifdef DUET_PORTABLE
#define DUET_OUT_OF_LINE
#define DUET_COLD
#else
#define DUET_OUT_OF_LINE [[gnu::noinline]]
#define DUET_COLD [[gnu::cold]]
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

/// Precedes a declaration whose use is a mistake. It has no body, and a result of the expected
/// type, as far as it is known: otherwise compilers first report that the result cannot be used, as
/// in `std::cout << f(x)` or `const auto [y, dy] = f(x)`.
///
/// Plain C++20 gives a warning, and the missing body does not link.
#ifdef DUET_PORTABLE
#define DUET_REFUSED(sentence) [[deprecated("duet: " sentence)]]
#else
#define DUET_REFUSED(sentence) __attribute__((unavailable("duet: " sentence)))
#endif
