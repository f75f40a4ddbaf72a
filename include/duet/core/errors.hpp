// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

/// \file
/// The exceptions duet throws. Each message says what, where and which value.

namespace duet {

/// An argument that no result exists for: knots that do not increase, a quaternion that is zero …
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

/// The parts in a row, whatever the locale.
template <class... Parts>
[[nodiscard, gnu::cold, gnu::noinline]] std::string message(const Parts&... parts) {
  std::ostringstream text;
  text.imbue(std::locale::classic()); // known by <ios>
  (text << ... << parts);
  return text.str();
}

/// \throws invalid_input, which says the parts in a row, unless the condition holds
template <class... Parts>
void require(bool condition, const Parts&... parts) {
  if (!condition) [[unlikely]] {
    throw invalid_input(message(parts...));
  }
}

} // namespace duet::detail
