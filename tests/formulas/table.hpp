// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "formulas/formula.hpp"

/// \file
/// All rows of the table.

namespace duet_formulas {

std::vector<formula> quaternion_formulas();
std::vector<formula> dual_formulas();
std::vector<formula> rigid_motion_formulas();
std::vector<formula> planning_formulas();
std::vector<formula> motion_formulas();
std::vector<formula> experiment_formulas();

std::vector<expression_route> quaternion_expressions();
std::vector<expression_route> dual_quaternion_expressions();
std::vector<expression_route> motion_expressions();
std::vector<expression_route> planning_expressions();
std::vector<expression_route> experiment_expressions();

} // namespace duet_formulas
