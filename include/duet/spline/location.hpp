// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <cstddef>

/// \file
/// Where on a curve a parameter is.

namespace duet {

/// What a curve does outside its domain. Up to 8 ulp beyond an end, of the end of larger magnitude,
/// is that end: so far sums of steps may be off.
enum class outside {
  error,      ///< throws invalid_input
  clamp,      ///< stays where it is at the end, without rates
  extrapolate ///< goes on with its first or last piece
};

/// The caller's memory of the span that a parameter was in, for parameters that move little from
/// one evaluation to the next. Any value will do to begin with, and for any curve.
struct span_hint {
  std::size_t span = 0;
};

} // namespace duet
