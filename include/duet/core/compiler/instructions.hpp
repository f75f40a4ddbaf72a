// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <duet/core/compiler/vector.hpp>

#include <cmath>
#include <concepts>
#include <type_traits>

// The whole header costs a compiler a third of the time of Eigen/Core.
#ifndef DUET_PORTABLE
#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif
#endif

/// \file
/// Vector instructions that compilers do not generate from loops over lanes; in plain C++20 the
/// loops.

namespace duet::detail {

/// True if any lane of a mask is set.
template <class Mask>
[[nodiscard]] DUET_ALWAYS_INLINE bool any_lane(const Mask& m) {
#ifndef DUET_PORTABLE
#if defined(__AVX512F__)
  if constexpr (sizeof(m) == 64 && !std::is_class_v<Mask>) {
    return _mm512_test_epi64_mask(__m512i(m), __m512i(m)) != 0;
  } else
#endif
#if defined(__AVX__)
      if constexpr (sizeof(m) == 32 && !std::is_class_v<Mask>) {
    return !_mm256_testz_si256(__m256i(m), __m256i(m));
  } else
#endif
#if defined(__SSE2__)
      if constexpr (sizeof(m) == 16 && !std::is_class_v<Mask>) {
    return _mm_movemask_epi8(__m128i(m)) != 0;
  } else
#endif
#endif
  {
    constexpr int width = int(sizeof(m) / sizeof(m[0]));
    auto bits = m[0];
    for (int i = 1; i < width; ++i) {
      bits = bits | m[i];
    }
    return bits != 0;
  }
}

/// √ of every lane.
template <class V>
[[nodiscard]] DUET_ALWAYS_INLINE V root_of_packet(const V& x) {
#ifndef DUET_PORTABLE
#if defined(__AVX512F__)
  if constexpr (std::same_as<V, vector_of<double, 8>>) {
    return V(_mm512_maskz_sqrt_pd(__mmask8(-1), x));
  }
#endif
#if defined(__AVX__)
  if constexpr (std::same_as<V, vector_of<double, 4>>) {
    return V(_mm256_sqrt_pd(x));
  } else if constexpr (std::same_as<V, vector_of<float, 8>>) {
    return V(_mm256_sqrt_ps(x));
  }
#endif
#if defined(__SSE2__)
  if constexpr (std::same_as<V, vector_of<double, 2>>) {
    return V(_mm_sqrt_pd(x));
  } else if constexpr (std::same_as<V, vector_of<float, 4>>) {
    return V(_mm_sqrt_ps(x));
  }
#endif
#if defined(__aarch64__)
  if constexpr (std::same_as<V, vector_of<double, 2>>) {
    return V(vsqrtq_f64(float64x2_t(x)));
  } else if constexpr (std::same_as<V, vector_of<float, 4>>) {
    return V(vsqrtq_f32(float32x4_t(x)));
  }
#endif
#endif
  V result = x;
  for (int i = 0; i < int(sizeof(V) / sizeof(x[0])); ++i) {
    result[i] = std::sqrt(x[i]);
  }
  return result;
}

} // namespace duet::detail
