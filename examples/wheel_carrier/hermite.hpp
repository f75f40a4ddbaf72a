// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "splines.hpp"
#include "table.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <memory>
#include <vector>

/// \file
/// Hermite interpolation with the rates of every row, the alternative that the paper mentions.

namespace wheel_carrier {

inline curve hermite_curve(const table& t, const carrier& mechanism) {
  std::vector<vector3> rates_of_rows;
  for (const double u : t.u) {
    rates_of_rows.push_back(mechanism.at(u).omega());
  }
  using hermite = duet::rotation_vector_spline<double>;
  const auto s = std::make_shared<const hermite>(
      duet::hermite_spline(t.u, t.q, rates_of_rows, duet::frame::spatial));
  return {"Hermite",
          "all rates",
          [s](double u) {
            const auto m = s->motion(u, duet::frame::spatial);
            return rates{m.velocity, m.acceleration};
          },
          {}};
}

} // namespace wheel_carrier
