// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

/// \file
/// Initial values of fields of aggregates.

namespace duet::detail {

/// T(), or zeros if T is a matrix of fixed size, whose default constructor leaves its entries
/// uninitialised.
template <class T>
[[nodiscard]] constexpr T zero_initialized() {
  if constexpr (requires { requires(T::SizeAtCompileTime > 0); }) {
    return T::Zero();
  } else {
    return T();
  }
}

} // namespace duet::detail
