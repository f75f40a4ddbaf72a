// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/text/number_text.hpp>

#include <concepts>
#include <limits>
#include <sstream>
#include <string>

/// \file
/// Numbers of any scalar with all their digits.

namespace duet::detail {

/// A number for messages, told apart from its neighbours.
template <Real R>
[[nodiscard]] std::string all_digits(const R& x) {
  if constexpr (std::floating_point<R>) {
    return to_text(x);
  } else {
    std::ostringstream text;
    text.precision(std::numeric_limits<R>::max_digits10);
    text << x;
    return text.str();
  }
}

} // namespace duet::detail
