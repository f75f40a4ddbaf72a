// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A cumulative B-spline through rotations.

#include <duet/spline/interpolate.hpp>

#include <vector>

duet::cumulative_bspline<double> curve(const std::vector<double>& times,
                                       const std::vector<duet::quaternion<double>>& rows) {
  return duet::interpolate<duet::cumulative_bspline<double>>(times, rows, duet::natural{});
}
