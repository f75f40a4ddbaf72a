// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <cmath>
#include <concepts>

/// \file
/// exp, log and √ of built-in numbers, told to do nothing but compute.
///
/// Each of the C library's functions may write errno, so clang reloads after every call what is in
/// memory, and no longer knows that two sines are of one x. Told that nobody looks at errno, it
/// keeps all in registers and makes √ one instruction. g++ does well by itself.

namespace duet::detail {

#if defined(__clang__) && defined(__GLIBC__)
extern "C" {
[[gnu::const]] double duet_exp(double) noexcept __asm__("exp");
[[gnu::const]] double duet_log(double) noexcept __asm__("log");
[[gnu::const]] double duet_sqrt(double) noexcept __asm__("sqrt");
[[gnu::const]] float duet_expf(float) noexcept __asm__("expf");
[[gnu::const]] float duet_logf(float) noexcept __asm__("logf");
[[gnu::const]] float duet_sqrtf(float) noexcept __asm__("sqrtf");
}
#endif

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE T pure_exp(const T& x) {
#if defined(__clang__) && defined(__GLIBC__)
  if constexpr (std::same_as<T, double>) {
    return duet_exp(x);
  } else if constexpr (std::same_as<T, float>) {
    return duet_expf(x);
  }
#endif
  using std::exp;
  return exp(x);
}

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE T pure_log(const T& x) {
#if defined(__clang__) && defined(__GLIBC__)
  if constexpr (std::same_as<T, double>) {
    return duet_log(x);
  } else if constexpr (std::same_as<T, float>) {
    return duet_logf(x);
  }
#endif
  using std::log;
  return log(x);
}

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE T pure_sqrt(const T& x) {
#if defined(__clang__) && defined(__GLIBC__)
  if constexpr (std::same_as<T, double>) {
    return duet_sqrt(x);
  } else if constexpr (std::same_as<T, float>) {
    return duet_sqrtf(x);
  }
#endif
  using std::sqrt;
  return sqrt(x);
}

} // namespace duet::detail
