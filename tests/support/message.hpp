// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>

#include <string>

/// \file
/// What exceptions say.

namespace duet_test {

/// The message of the E that f throws, or nothing.
template <class E = duet::invalid_input, class F>
[[nodiscard]] std::string message_of(const F& f) {
  try {
    f();
  } catch (const E& error) {
    return error.what();
  }
  return "";
}

} // namespace duet_test
