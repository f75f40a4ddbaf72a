// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

/// \file
/// Exceptions thrown by duet, each message with the function, the problem and the value; errors
/// without exceptions. The only header with `throw`, `try` and `catch`. All files that are linked
/// together are compiled with exceptions, or all without.

namespace duet {

/// Function called with the message of an error in programs without exceptions.
using error_handler = void (*)(const char* message);

namespace detail {
inline std::atomic<error_handler> current_error_handler = nullptr;
} // namespace detail

/// Sets the handler called with the message of an error in programs that are compiled without
/// exceptions (`-fno-exceptions`), in the thread of the error. The program does not continue: if
/// the handler returns, or is null (the default), the message goes to the standard error stream,
/// and `std::abort` is called. With exceptions they are thrown, and the handler is not called.
///
/// \return the previous handler
inline error_handler set_error_handler(error_handler handler) noexcept {
  return detail::current_error_handler.exchange(handler);
}

} // namespace duet

namespace duet::detail {

/// Throws the error; without exceptions, calls the handler set by `set_error_handler` and ends the
/// program.
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

/// Calls `body`, and `on_error` with an `Error` that is thrown in it; if `Error` is `void`, without
/// argument for anything thrown. Without exceptions no error leaves the body.
template <class Error, class Body, class Handler>
void catching(const Body& body, [[maybe_unused]] const Handler& on_error) {
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

/// Rethrows the exception being handled by a `catching`.
[[noreturn]] inline void raise_again() {
#ifdef __cpp_exceptions
  throw;
#else
  std::abort();
#endif
}

} // namespace duet::detail

namespace duet {

/// An argument without a valid result: knots that do not increase, a quaternion that is zero …
class invalid_input : public std::invalid_argument {
public:
  using std::invalid_argument::invalid_argument;
};

/// An iteration that did not reach its solution; the message gives its last residual and step.
class no_convergence : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

} // namespace duet

namespace duet::detail {

/// A part of a message: text, or any object that can be written to a stream.
class message_part {
public:
  message_part(std::string_view text) : text_(text) {}
  template <class Value>
    requires(!std::is_convertible_v<const Value&, std::string_view>)
  message_part(const Value& value)
      : value_(&value),
        write_([](std::ostream& out, const void* of) { out << *static_cast<const Value*>(of); }) {}

  void write(std::ostream& out) const {
    if (write_ != nullptr) {
      write_(out, value_);
    } else {
      out << text_;
    }
  }

private:
  std::string_view text_;
  const void* value_ = nullptr;
  void (*write_)(std::ostream&, const void*) = nullptr;
};

/// The parts concatenated, independent of the locale. (Compiled once, not for every list of types.)
[[nodiscard]] DUET_COLD DUET_OUT_OF_LINE inline std::string
joined(std::initializer_list<message_part> parts) {
  std::ostringstream text;
  text.imbue(std::locale::classic()); // declared by <ios>
  for (const message_part& part : parts) {
    part.write(text);
  }
  return text.str();
}
template <class... Parts>
[[nodiscard]] std::string message(const Parts&... parts) {
  return joined({message_part(parts)...});
}

/// \throws invalid_input with the concatenated parts, unless the condition holds
template <class... Parts>
void require(bool condition, const Parts&... parts) {
  if (!condition) [[unlikely]] {
    raise(invalid_input(message(parts...)));
  }
}

} // namespace duet::detail
