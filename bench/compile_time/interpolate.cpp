// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A curve through rotations.

#include <duet/spline/interpolate.hpp>

#include <vector>

duet::rotation_vector_spline<double> curve(const std::vector<double>& times,
                                           const std::vector<duet::quaternion<double>>& rows) {
  return duet::interpolate<duet::rotation_vector_spline<double>>(times, rows, duet::natural{});
}
