// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <Eigen/Core>

#include <limits>
#include <vector>

/// \file
/// Options of `fit`.

namespace duet {

/// Options of `fit`.
struct fit_options {
  /// Characteristic length: distance between poses that counts as much as a rotation by 1 rad.
  double characteristic_length = 1;
  /// Outlier threshold, in the unit of the residuals. Larger residuals count by their size, not by
  /// their square (Huber's loss). Samples farther off than four times the threshold and twelve
  /// times the median of their neighbours are ignored, so that outliers, however far, do not move
  /// the curve. 0: three times the median residual. Infinity, the default: plain least squares.
  double outlier_threshold = std::numeric_limits<double>::infinity();
  /// Relative weights wᵢ > 0 of the samples; empty, the default: all equal.
  std::vector<double> weights = {};
  /// Covariance matrices Σᵢ of the samples' errors, or one for all: 3 × 3 of rotation vectors in
  /// the sample's body axes, rad²; for poses 6 × 6 of twists [v; ω] there. Residuals, and with them
  /// `outlier_threshold`, are then |Lᵢ⁻¹ rᵢ| in standard deviations, Σᵢ = Lᵢ Lᵢᵀ, and
  /// `characteristic_length` has no effect. Empty, the default: errors of one size.
  std::vector<Eigen::MatrixXd> covariances = {};
  int max_iterations = 100; ///< maximum number of Levenberg–Marquardt iterations
};

} // namespace duet
