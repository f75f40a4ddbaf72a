// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "formulas/formula.hpp"

#include <vector>

/// \file
/// The labels of the documents' formulas, the arms, and what other tests prove.

namespace duet_formulas {

inline constexpr const char* labels[] = {
    "N1",  "N2",  "N3",  "N4",  "N5",  "N6",  "N7",  "N8",  "N9",    "N10",     "N11",  "N12",
    "N13", "N14", "N15", "N16", "N17", "N18", "N19", "N20", "N21",   "N22",     "N23",  "N24",
    "N25", "P1",  "P2",  "P3",  "P4",  "P5",  "P6",  "P7",  "Panda", "iiwa 14", "UR5e", "Baxter"};

inline std::vector<reference> references() {
  return {
      {"N25", "given paths, inverse kinematics", "`follow_path`, `inverse_kinematics`",
       "`planning/follow_path`, `planning/inverse_kinematics`"},
      {"P1", "basis functions", "`bspline_basis`", "`examples/printed_formulas`, `spline/basis`"},
      {"P3", "its first derivative", "`cumulative_bspline::motion`, `printed_derivative`",
       "`examples/printed_formulas`, `spline/motion`"},
      {"P4", "its second derivative", "`cumulative_bspline::motion`, `printed_derivative`",
       "`examples/printed_formulas`, `spline/motion`"},
      {"P5", "angular velocity from Euler angles", "`euler_rate_matrix`",
       "`examples/printed_formulas`, `quaternion/euler_rate`"},
      {"P6", "error measures $\\delta_E$, $d\\delta_E$", "`examples/wheel_carrier`",
       "`examples/wheel_carrier`"},
      {"P7", "the experiment", "`examples/wheel_carrier`", "`examples/wheel_carrier`"},
  };
}

} // namespace duet_formulas
