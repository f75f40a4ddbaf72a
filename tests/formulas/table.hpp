// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "formulas/formula.hpp"

#include <vector>

/// \file
/// All rows of the table.

namespace duet_formulas {

std::vector<formula> quaternion_formulas();
std::vector<formula> dual_formulas();
std::vector<formula> rigid_motion_formulas();
std::vector<formula> planning_formulas();

} // namespace duet_formulas
