// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/errors.hpp>

#include <locale>
#include <sstream>
#include <string>

/// \file
/// Exceptions, and what they say, from its parts.

namespace duet::detail {

/// The parts in a row, whatever the locale.
template <class... Parts>
[[nodiscard, gnu::cold, gnu::noinline]] std::string message(const Parts&... parts) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
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
