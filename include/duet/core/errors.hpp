// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/core/error_handler.hpp>

#include <initializer_list>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

/// \file
/// Exceptions thrown by duet. Each message names the function, the problem and the value.

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
