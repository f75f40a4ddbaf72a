// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>

#include <boost/rational.hpp>

/// \file
/// Dual and Taylor numbers over the rational numbers: derivatives of algebra without round-off.
///
/// Constants are integers and rationals, not fractions like 0.5. Division by zero throws
/// `boost::bad_rational`, also if the divisor has infinitesimal parts.

namespace duet {

template <class I>
struct field_traits<boost::rational<I>> {
  static constexpr bool is_field = true;
  using constant_type = I;
};

} // namespace duet
