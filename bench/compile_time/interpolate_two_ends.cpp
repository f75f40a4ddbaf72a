// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// What interpolate.cpp does, with two kinds of ends.

#include <duet/spline/interpolate.hpp>

#include <vector>

duet::rotation_vector_spline<double> curve(const std::vector<double>& times,
                                           const std::vector<duet::quaternion<double>>& rows,
                                           bool natural) {
  using curve = duet::rotation_vector_spline<double>;
  return natural ? duet::interpolate<curve>(times, rows, duet::natural{})
                 : duet::interpolate<curve>(times, rows, duet::not_a_knot{});
}
