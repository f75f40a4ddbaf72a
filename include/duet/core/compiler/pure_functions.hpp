// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <cmath>

/// \file
/// exp, log, √, sin and cos of built-in numbers, declared free of side effects; of other numbers,
/// and in plain C++20, the functions of these names.
///
/// Each of the C library's functions may write errno, so clang reloads memory after every call, and
/// no longer recognises two sines of one x. Declared as not writing errno, they let it keep all in
/// registers, make √ one instruction, and merge the sine and the cosine of one x into one call. g++
/// does well by itself.

namespace duet::detail {

#if defined(__clang__) && defined(__GLIBC__) && !defined(DUET_PORTABLE)
[[gnu::const]] double pure_exp(double) noexcept __asm__("exp");
[[gnu::const]] double pure_log(double) noexcept __asm__("log");
[[gnu::const]] double pure_sqrt(double) noexcept __asm__("sqrt");
[[gnu::const]] double pure_sin(double) noexcept __asm__("sin");
[[gnu::const]] double pure_cos(double) noexcept __asm__("cos");
[[gnu::const]] float pure_exp(float) noexcept __asm__("expf");
[[gnu::const]] float pure_log(float) noexcept __asm__("logf");
[[gnu::const]] float pure_sqrt(float) noexcept __asm__("sqrtf");
[[gnu::const]] float pure_sin(float) noexcept __asm__("sinf");
[[gnu::const]] float pure_cos(float) noexcept __asm__("cosf");
#endif

template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE T pure_exp(const T& x) {
  using std::exp;
  return exp(x);
}
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE T pure_log(const T& x) {
  using std::log;
  return log(x);
}
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE T pure_sqrt(const T& x) {
  using std::sqrt;
  return sqrt(x);
}
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE T pure_sin(const T& x) {
  using std::sin;
  return sin(x);
}
template <class T>
[[nodiscard]] DUET_ALWAYS_INLINE T pure_cos(const T& x) {
  using std::cos;
  return cos(x);
}

} // namespace duet::detail
