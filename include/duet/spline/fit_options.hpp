// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <limits>

/// \file
/// What may be chosen of a fit.

namespace duet {

/// Settings of `fit`.
struct fit_options {
  /// Of poses: the distance that counts as much as a turn by one radian.
  double length = 1;
  /// A residual beyond this counts by its size, not by its square (Huber's loss), and rows that are
  /// farther off than four times this, and twelve times the median of those around, do not count:
  /// outliers however far leave the curve where the others take it. Zero: three times the median
  /// residual. Infinite: plain least squares.
  double outlier = std::numeric_limits<double>::infinity();
  int max_iterations = 100;
};

} // namespace duet
