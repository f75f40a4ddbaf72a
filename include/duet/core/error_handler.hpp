// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <type_traits>

/// \file
/// Errors with exceptions and without: the only header that has `throw`, `try` and `catch`. All
/// files that are linked together are compiled with exceptions, or all without.

namespace duet {

/// What is called with an error's message where there are no exceptions.
using error_handler = void (*)(const char* message);

namespace detail {
inline std::atomic<error_handler> current_error_handler = nullptr;
} // namespace detail

/// Has `handler` called with the message of an error in programs that are compiled without
/// exceptions (`-fno-exceptions`), from the thread that found it. It does not go on from there:
/// should the handler return, or be null, as it is at first, the message goes to the standard error
/// stream, and `std::abort` is called. Where there are exceptions they are thrown, and the handler
/// is not called.
/// \return the handler before
inline error_handler set_error_handler(error_handler handler) noexcept {
  return detail::current_error_handler.exchange(handler);
}

} // namespace duet

namespace duet::detail {

/// Throws the error; without exceptions, ends in the handler that `set_error_handler` has set.
template <class Error>
[[noreturn]] DUET_COLD DUET_OUT_OF_LINE void raise(Error error) {
#ifdef __cpp_exceptions
  throw error;
#else
  if (const error_handler handler = current_error_handler) {
    handler(error.what());
  }
  std::fprintf(stderr, "%s\n", error.what());
  std::abort();
#endif
}

/// Calls `body`, and `on_error` with an `Error` that is thrown in it; of type `void`, with nothing
/// for whatever is thrown. Without exceptions no error leaves the body.
template <class Error, class Body, class Handler>
DUET_ALWAYS_INLINE void catching(const Body& body, [[maybe_unused]] const Handler& on_error) {
#ifdef __cpp_exceptions
  if constexpr (std::is_void_v<Error>) {
    try {
      body();
    } catch (...) {
      on_error();
    }
  } else {
    try {
      body();
    } catch (const Error& error) {
      on_error(error);
    }
  }
#else
  body();
#endif
}

/// Throws again what is being handled by a `catching`.
[[noreturn]] inline void raise_again() {
#ifdef __cpp_exceptions
  throw;
#else
  std::abort();
#endif
}

} // namespace duet::detail
