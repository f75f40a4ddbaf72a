// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

/// \file
/// Sides on which rotations and poses are perturbed.

namespace duet {

/// Side on which a small rotation vector or twist δ perturbs a rotation or pose q. Jacobians with
/// respect to q and of q are those of δ.
enum class perturbation {
  right, ///< q exp(δ/2): δ in body axes
  left   ///< exp(δ/2) q: δ in spatial axes
};

} // namespace duet
