// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <Eigen/Core>

#include <limits>
#include <vector>

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
  /// How much each row counts, wᵢ > 0 in proportion; none: all the same.
  std::vector<double> weights = {};
  /// Σᵢ of the rows' errors, or one matrix for all of them: 3 × 3, rad², of turns in the row's body
  /// axes, for poses 6 × 6 of the twists [v; ω] there. Residuals are then |Lᵢ⁻¹ rᵢ|, Σᵢ = Lᵢ Lᵢᵀ,
  /// in standard deviations, `outlier` with them, and `length` does not matter. None: of one size.
  std::vector<Eigen::MatrixXd> covariances = {};
  int max_iterations = 100; ///< of the least-squares method
};

} // namespace duet
