// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The wheel carrier's mechanism against values on which three independent solvers agree, and the
// errors of the interpolated table against those of an independent prototype.

#include "../../examples/wheel_carrier/carrier.hpp"
#include "../../examples/wheel_carrier/comparison.hpp"
#include "../../examples/wheel_carrier/configuration.hpp"
#include "../../examples/wheel_carrier/pictures.hpp"
#include "../../examples/wheel_carrier/table.hpp"
#include "support/test.hpp"

#include <duet/spline/interpolate.hpp>

namespace test_examples_wheel_carrier {
namespace {

using namespace wheel_carrier;

struct reference {
  double u;
  vector2 xy;
  rotation q;
  vector3 omega, omega_first;
};

const std::vector<reference> references{
    {-0.19,
     {0.028114268213, 0.931205477399},
     {0.999392182193, -0.012204994244, -0.031794307145, 0.007444885562},
     {-0.29516302816, 0.428068087641, -0.169406642509},
     {5.6926830606, -1.0740275764, 1.4676072695}},
    {0.0,
     {0.0, 0.95},
     {1, 0, 0, 0},
     {0.526646994515, 0.248648617129, -0.039914418756},
     {4.5358754104, -0.7621400487, 0.0625172908}},
    {0.20,
     {-0.001952841610, 0.879161123870},
     {0.993481401791, 0.112039582875, 0.020089517772, -0.006184451578},
     {1.927114776517, 0.197925164613, -0.127372543603},
     {11.0163100237, 0.5908726713, -0.9258931868}}};

struct experiment {
  carrier mechanism{example_hardpoints()};
  arc_length arcs{mechanism};
  table t = equal_arc_table(mechanism, arcs, 105);
  std::vector<state> states; // 401 of them, at even heights
  std::vector<double> samples;

  experiment() {
    for (int i = 0; i <= 400; ++i) {
      samples.push_back(lowest + (highest - lowest) * i / 400);
      states.push_back(mechanism.at(samples.back()));
    }
  }
};
/// Made once for all cases: not optimised it takes seconds.
const experiment& the_experiment() {
  static const experiment result;
  return result;
}

TEST_CASE("carrier: position, orientation and derivatives agree with the reference values") {
  const carrier mechanism(example_hardpoints());
  for (const reference& expected : references) {
    CAPTURE(expected.u);
    const state s = mechanism.at(expected.u);
    CHECK((s.centre.head<2>() - expected.xy).cwiseAbs().maxCoeff() < 1e-10);
    CHECK(s.centre[2] == expected.u);
    CHECK(norm(s.q - expected.q) < 1e-10);
    CHECK((s.omega() - expected.omega).cwiseAbs().maxCoeff() < 1e-10);
    CHECK((s.omega_first() - expected.omega_first).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("P7: the table has 105 rows, 0.003 rad apart, at non-uniform heights") {
  const auto& [mechanism, arcs, t, states, samples] = the_experiment();
  CHECK(std::abs(arcs.total() - 0.311551898) < 1e-9);
  for (std::size_t i = 1; i < t.q.size(); ++i) {
    const double angle = duet::rotation_vector(t.q[i] * conj(t.q[i - 1])).norm();
    // The angle between two rows is a chord of the arc: shorter where the axis moves.
    CHECK(angle < arcs.total() / 104 * (1 + 1e-12));
    CHECK(angle > arcs.total() / 104 * (1 - 5e-4));
  }
  CHECK(t.u[1] - t.u[0] > 1.5 * (t.u[104] - t.u[103]));
}

TEST_CASE("P5, P6: errors of the spline relative to the mechanism are as expected") {
  const auto& [mechanism, arcs, t, states, samples] = the_experiment();
  const spline clamped = duet::interpolate<spline>(
      t.u, t.q, duet::clamped{states.front().omega(), states.back().omega()});
  const spline natural = duet::interpolate<spline>(t.u, t.q, duet::natural{});

  SUBCASE("clamped ends: all exact methods are accurate") {
    for (const method& w : {methods[0], methods[1], methods[2]}) {
      CAPTURE(w.name);
      const error_curve e = errors(states, clamped, w);
      CHECK(summarise(e.delta).maximum < 0.001);
      CHECK(summarise(e.delta_first).maximum < 0.06);
      CHECK(summarise(e.delta).median < 0.00005);
      CHECK(summarise(e.delta_first).median < 0.007);
    }
  }
  SUBCASE("natural ends: large errors at the ends, small ones between them") {
    const error_curve e = errors(states, natural, methods[0]);
    CHECK(summarise(e.delta).ends > 1);
    CHECK(summarise(e.delta_first).ends == doctest::Approx(100).epsilon(0.01));
    CHECK(summarise(e.delta_first).median < 0.01);
  }
  SUBCASE("automatic differentiation agrees with the closed form, the printed formulas do not") {
    CHECK(automatic_against_closed_form(clamped, samples) < 1e-12);
    const double printed = printed_formula_error(clamped, samples);
    CHECK(printed > 1e-4);
    CHECK(printed < 1e-3);
    CHECK(summarise(errors(states, clamped, methods[3]).delta_first).median > 100);
    CHECK(summarise(errors(states, clamped, methods[4]).delta_first).median > 100);
  }
  SUBCASE("angular velocity errors peak inside with clamped ends, at both ends with natural ones") {
    const std::vector<double> inside = errors(states, clamped, methods[0]).delta;
    const std::vector<double> outside = errors(states, natural, methods[0]).delta;
    const double middle = summarise(inside).interior;
    CHECK(inside.front() < 1e-3 * middle);
    CHECK(inside.back() < 1e-3 * middle);
    CHECK(middle == summarise(inside).maximum);
    CHECK(outside.front() > 10 * summarise(outside).interior);
    CHECK(outside.back() > 2 * summarise(outside).interior);
  }
  SUBCASE("q_K, q′_K and q″_K are accurate") {
    std::vector<vector3> rows;
    for (const double u : t.u) {
      rows.push_back(mechanism.at(u).centre);
    }
    const position_spline position(t.u, rows, states.front().centre_first,
                                   states.back().centre_first);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      CHECK((position.at(t.u[i])[0] - rows[i]).norm() < 1e-14);
    }
    CHECK((position.at(lowest)[1] - states.front().centre_first).norm() < 1e-13);
    CHECK((position.at(highest)[1] - states.back().centre_first).norm() < 1e-13);
    configuration_errors off;
    for (const state& s : states) {
      const configuration exact = configuration_of(s);
      // P5: the angles' rates are those of the rotation.
      const auto& [angles, first, second] = exact.angles;
      const vector3 omega = duet::euler_rate_matrix<duet::zyx>(angles[2], angles[1]) *
                            vector3(first[2], first[1], first[0]);
      CHECK((omega - s.omega()).norm() < 1e-13 * s.omega().norm());
      off.add({position.at(s.u), angles_of(clamped.derivatives(s.u))}, exact);
    }
    const double limits[2][3] = {{2e-9, 5e-7, 8e-4}, {5e-9, 2e-6, 4e-3}};
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(summarise(off.position[k]).maximum < limits[0][k]);
      CHECK(summarise(off.angles[k]).maximum < limits[1][k]);
    }
  }
}

TEST_CASE("carrier: rods that cannot close throw loop_closure_failure with the height") {
  hardpoints points = example_hardpoints();
  points.rods[2].chassis[1] = 0.8;
  try {
    (void)carrier(points).at(-0.19);
    FAIL("they close");
  } catch (const duet::loop_closure_failure& error) {
    CHECK(error.parameter().front() == doctest::Approx(-0.1334868).epsilon(1e-6));
  }
}

// Samples on a row count for the interval before it; the interval (3, 3.5] has none.
TEST_CASE(
    "largest_between_rows: largest errors per interval; intervals without samples are skipped") {
  const std::vector<double> samples{0, .5, 1, 1.5, 2, 3, 4};
  const std::vector<named_curve> curves{{"a", {{1, 3, 2, 5, 4, 0, 6}, {7, 1, 1, 2, 9, 3, 8}}}};
  const auto [heights, largest] = largest_between_rows(samples, curves, {0, 1, 3, 3.5, 4});
  CHECK(heights == std::vector<double>{.5, 2, 3.75});
  REQUIRE(largest.size() == 1);
  CHECK(largest[0].first == "a");
  CHECK(largest[0].second.delta == std::vector<double>{3, 5, 6});
  CHECK(largest[0].second.delta_first == std::vector<double>{7, 9, 8});
}

TEST_CASE("two_digits: two significant digits, with spaces in groups of three") {
  CHECK(example::two_digits(.0051768) == "0.0052");
  CHECK(example::two_digits(99.4) == "99");
  CHECK(example::two_digits(2634.) == "2600");
  CHECK(example::two_digits(457123.) == "460 000");
  CHECK(example::two_digits(1234567.) == "1 200 000");
}

} // namespace
} // namespace test_examples_wheel_carrier
