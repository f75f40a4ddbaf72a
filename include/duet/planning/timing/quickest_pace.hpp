// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/compiled.hpp>
#include <duet/planning/timing/pace_bounds.hpp>

#include <array>
#include <cstddef>
#include <vector>

/// \file
/// The quickest pace within bounds. For those who extend duet.

namespace duet::detail {

/// A pace within bounds, as the coefficients of its B-spline.
struct found_pace {
  std::vector<double> coefficients;
  std::array<double, 2> reached{}; ///< at both ends, of what was asked for
  std::size_t nearest_joint = 0;   ///< whose limits of acceleration and jerk are
};

/// Nearly the quickest one: what bounds are kept off their limits costs about 10 / accuracy of the
/// time.
/// \param ends  what the pace is to be at the ends, where rates keep their limits; 0: anything
[[nodiscard]] DUET_COMPILED_FUNCTION found_pace quickest_pace(const pace_bounds& bounds,
                                                              const std::array<double, 2>& ends,
                                                              double accuracy);

} // namespace duet::detail

#ifndef DUET_COMPILED
#include <duet/planning/timing/pace_search.hpp>
#endif
