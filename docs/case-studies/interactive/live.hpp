// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>

#include <cmath>

#ifdef __EMSCRIPTEN__
#include <emscripten.h>
#endif

/// \file
/// Interface of the pages: C functions of numbers and arrays of doubles, compiled for the browser
/// and, for comparison in tests, as a native library.

#ifdef __EMSCRIPTEN__

#define DUET_LIVE extern "C" EMSCRIPTEN_KEEPALIVE

// clang-format off
EM_JS(void, duet_live_error, (const char* message), { throw new Error(UTF8ToString(message)); })
// clang-format on

namespace live {
/// Errors are thrown as JavaScript errors, which unwind all calls.
inline const bool errors_are_thrown = (duet::set_error_handler(duet_live_error), true);
} // namespace live

#else

#define DUET_LIVE extern "C"

#endif

namespace live {

/// Writes numbers and vectors consecutively.
class writer {
public:
  explicit writer(double* out) : out_(out) {}

  writer& operator<<(double x) {
    *out_++ = x;
    return *this;
  }
  template <class V>
    requires requires(const V& v) { v.size(); }
  writer& operator<<(const V& v) {
    for (int i = 0; i < int(v.size()); ++i) {
      *out_++ = v[i];
    }
    return *this;
  }

private:
  double* out_;
};

} // namespace live
