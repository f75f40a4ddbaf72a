// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

/// \file
/// Detection of the compiler and the target.
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
