// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/robotics/timing/path_velocity_constraints.hpp>

#include <array>
#include <cstddef>
#include <vector>

/// \file
/// Minimum-time squared path velocity b(τ) = τ̇² under limits. For those who extend duet.

namespace duet::detail {

/// Squared path velocity within limits, by the coefficients of its B-spline.
struct path_velocity_result {
  std::vector<double> coefficients;
  std::array<double, 2> reached{}; ///< fraction of the required value attained at each end
  std::size_t nearest_joint = 0;   ///< joint whose acceleration and jerk limits are the nearest
};

/// Nearly minimum-time squared path velocity by a log-barrier interior-point method: the margins to
/// the limits cost about 10 / accuracy of the time.
///
/// \param ends  squared path velocities required at the ends, where joint velocities satisfy their
/// limits; 0: free
[[nodiscard]] DUET_COMPILED_FUNCTION path_velocity_result minimum_time_path_velocity(
    const path_velocity_constraints& bounds, const std::array<double, 2>& ends, double accuracy);

} // namespace duet::detail

#ifndef DUET_COMPILED
#include <duet/robotics/timing/log_barrier_solver.hpp>
#endif
