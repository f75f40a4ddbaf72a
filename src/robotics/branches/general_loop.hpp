// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "loop_equation.hpp"

#include <cstdint>

/// \file
/// Solution of loops of six joints without a closed form.

namespace duet::detail {
DUET_ABI_BEGIN

/// Loop with a goal close to the given one.
[[nodiscard]] loop_equation with_disturbed_goal(loop_equation loop, double by, std::uint64_t seed);

/// True if the goal is farther away than the joints can reach.
[[nodiscard]] bool is_beyond_reach(const loop_equation& loop);

/// True if no solution is regular, whatever the goal, as if two neighbouring joints rotate about
/// one axis.
[[nodiscard]] bool is_always_singular(const loop_equation& loop);

/// All solutions of a loop by Raghavan–Roth elimination, for arms without special geometry.
[[nodiscard]] loop_solution_set eliminated(const loop_equation& loop);

/// All solutions of a loop with two prismatic joints, by the zeros of a polynomial.
[[nodiscard]] loop_solution_set solve_two_prismatic(const loop_equation& loop);

DUET_ABI_END
} // namespace duet::detail
