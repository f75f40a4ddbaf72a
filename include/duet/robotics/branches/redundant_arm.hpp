// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/robotics/branches/seven_joint_arm.hpp>

#include <vector>

/// \file
/// Search for the components of the self-motion of seven joints.

namespace duet::detail {

/// Curves of configurations with the tip at the goal, and components of other dimensions.
///
/// \param resolution  maximum distance between consecutive points of curves, lengths relative to
/// the arm's size
[[nodiscard]] DUET_COMPILED_FUNCTION std::vector<traced_curve> all_curves(const redundant_arm& arm,
                                                                          double resolution);

} // namespace duet::detail

#ifndef DUET_COMPILED
#include <duet/robotics/branches/component_search.hpp>
#endif
