// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Errors of rotation-vector splines through the table of the wheel carrier.

#include "../../examples/wheel_carrier/carrier.hpp"
#include "../../examples/wheel_carrier/table.hpp"
#include "support/test.hpp"

#include <duet/spline/interpolate.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

namespace test_examples_wheel_carrier_splines {
namespace {

using namespace wheel_carrier;

/// The largest dδ_E over the travel, percent.
template <class Spline>
double worst_acceleration(const std::vector<state>& states, const Spline& s) {
  double worst = 0;
  for (const state& exact : states) {
    const vector3 error =
        s.motion(exact.u, duet::frame::spatial).acceleration - exact.omega_first();
    worst = std::max(worst, 100 * error.norm() / exact.omega_first().norm());
  }
  return worst;
}

TEST_CASE("P7: rotation-vector splines through the 0.003-rad table have small dδ_E") {
  const carrier mechanism(example_hardpoints());
  const table t = equal_arc_table(mechanism, arc_length(mechanism), 105);
  std::vector<state> states;
  for (int i = 0; i <= 800; ++i) {
    states.push_back(mechanism.at(i == 800 ? highest : lowest + (highest - lowest) * i / 800));
  }
  const duet::clamped rates{states.front().omega(), states.back().omega()};
  using cubic = duet::rotation_vector_spline<double>;
  using quintic = duet::rotation_vector_spline<double, 6>;
  CHECK(worst_acceleration(states, duet::interpolate<cubic>(t.u, t.q, rates)) < 0.05);
  CHECK(worst_acceleration(states, duet::interpolate<quintic>(t.u, t.q, rates)) < 0.005);
  // The rates of every row known.
  std::vector<vector3> of_rows;
  for (const double u : t.u) {
    of_rows.push_back(mechanism.at(u).omega());
  }
  CHECK(worst_acceleration(states, duet::hermite_spline(t.u, t.q, of_rows, duet::frame::spatial)) <
        0.05);
  // Nothing known beyond the table.
  CHECK(worst_acceleration(states, duet::interpolate<cubic>(t.u, t.q, duet::not_a_knot{})) < 0.4);
  CHECK(worst_acceleration(states, duet::interpolate<quintic>(t.u, t.q, duet::not_a_knot{})) <
        0.005);
}

} // namespace
} // namespace test_examples_wheel_carrier_splines
