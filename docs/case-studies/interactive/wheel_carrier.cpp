// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The wheel carrier of examples/wheel_carrier in the browser: the mechanism, and the errors of
// splines through tables of its orientation. Metres, radians, spatial axes.

#include "live.hpp"

#include "../../../examples/wheel_carrier/carrier.hpp"
#include "../../../examples/wheel_carrier/comparison.hpp"
#include "../../../examples/wheel_carrier/equal_arcs.hpp"

#include <duet/spline/interpolate.hpp>
#include <duet/spline/rotation_vector_spline.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace {

using namespace wheel_carrier;
using rotation_vector_cubic = duet::rotation_vector_spline<double>;
using rotation_vector_quintic = duet::rotation_vector_spline<double, 6>;

enum spline_kind { cumulative, cubic, quintic, hermite };
enum end_condition_kind { natural, not_a_knot, clamped, acceleration, both };

/// The mechanism at the heights of docs/case-studies/wheel_carrier.md, solved once.
class reference {
public:
  static constexpr int count = 2001;

  reference() : mechanism_(example_hardpoints()), arcs_(mechanism_) {
    for (int i = 0; i < count; ++i) {
      states_.push_back(
          mechanism_.at(i + 1 == count ? highest : lowest + (highest - lowest) * i / (count - 1)));
    }
  }
  reference(const reference&) = delete;

  [[nodiscard]] const carrier& mechanism() const { return mechanism_; }
  [[nodiscard]] const std::vector<state>& states() const { return states_; }
  [[nodiscard]] table rows(int n) const { return equal_arc_table(mechanism_, arcs_, n); }

private:
  carrier mechanism_;
  arc_length arcs_;
  std::vector<state> states_;
};

const reference& solved() {
  static const reference result;
  return result;
}

/// The last table is cached, since readers move one slider at a time.
const table& table_of(int rows) {
  static table result;
  if (int(result.u.size()) != rows) {
    result = solved().rows(rows);
  }
  return result;
}

template <class Spline>
Spline interpolated(const table& t, int ends) {
  const state& first = solved().states().front();
  const state& last = solved().states().back();
  const duet::clamped velocities{first.omega(), last.omega()};
  const duet::end_acceleration accelerations{first.omega_first(), last.omega_first()};
  switch (ends) {
  case natural:
    return duet::interpolate<Spline>(t.u, t.q, duet::natural{});
  case not_a_knot:
    return duet::interpolate<Spline>(t.u, t.q, duet::not_a_knot{});
  case clamped:
    return duet::interpolate<Spline>(t.u, t.q, velocities);
  case acceleration:
    return duet::interpolate<Spline>(t.u, t.q, accelerations);
  default:
    return duet::interpolate<Spline>(t.u, t.q, duet::fully_clamped{velocities, accelerations});
  }
}

rotation_vector_cubic through_rates(const table& t) {
  std::vector<vector3> velocities;
  for (const double u : t.u) {
    velocities.push_back(solved().mechanism().at(u).omega());
  }
  return duet::hermite_spline(t.u, t.q, velocities, duet::frame::spatial);
}

/// Calls f with the spline.
template <class F>
void with_spline(const table& t, int kind, int ends, const F& f) {
  switch (kind) {
  case cumulative:
    return f(interpolated<spline>(t, ends));
  case cubic:
    return f(interpolated<rotation_vector_cubic>(t, ends));
  case quintic:
    return f(interpolated<rotation_vector_quintic>(t, ends));
  default:
    return f(through_rates(t));
  }
}

template <class Spline>
rates true_rates(const Spline& s, double u) {
  const auto m = s.motion(u, duet::frame::spatial);
  return {m.velocity, m.acceleration};
}

/// Median, maximum, and the lowest height at which the maximum is attained, except for round-off.
void summary_of(const std::vector<double>& values, live::writer& out) {
  const summary s = summarise(values);
  const auto top = std::find_if(values.begin(), values.end(),
                                [&](double x) { return x >= (1 - 1e-9) * s.maximum; });
  out << s.median << s.maximum << solved().states()[std::size_t(top - values.begin())].u;
}

/// The largest value between any two rows; 0 where there is no sample.
std::vector<double> largest_between(const std::vector<double>& rows,
                                    const std::vector<double>& values) {
  std::vector<double> result(rows.size() - 1);
  std::size_t interval = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    while (interval + 2 < rows.size() && solved().states()[i].u > rows[interval + 1]) {
      ++interval;
    }
    result[interval] = std::max(result[interval], values[i]);
  }
  return result;
}

/// δ_E and dδ_E of rates with respect to u at all heights, in percent.
template <class Rates>
error_curve errors_of(const Rates& at) {
  error_curve result;
  for (const state& exact : solved().states()) {
    const rates r = at(exact.u);
    result.delta.push_back(100 * relative(r.delta, exact.omega()));
    result.delta_first.push_back(100 * relative(r.delta_first, exact.omega_first()));
  }
  return result;
}

} // namespace

/// The hardpoints.
/// \param out  wheel centre (3), then of each rod the end on the chassis (3) and on the carrier
/// (3):
///             33 numbers
DUET_LIVE void hardpoints_of_carrier(double* out) {
  live::writer to(out);
  const hardpoints points = example_hardpoints();
  to << points.wheel_centre;
  for (const rod& each : points.rods) {
    to << each.chassis << each.carrier;
  }
}

/// The carrier with its wheel at a height u ∈ [−0.19, 0.20].
/// \param out  wheel centre W (3), where W and R take the rods' ends on the carrier (15) and the
///             directions of the wheel, ahead, to the left and up (9), toe-in, camber, δ (3),
///             ∂δ/∂u (3): 35 numbers
DUET_LIVE void carrier_at(double u, double* out) {
  live::writer to(out);
  const state s = solved().mechanism().at(u);
  const hardpoints& points = solved().mechanism().points();
  to << s.centre;
  for (const rod& each : points.rods) {
    to << vector3(s.centre + duet::rotate(s.q, vector3(each.carrier - points.wheel_centre)));
  }
  for (int i = 0; i < 3; ++i) {
    to << vector3(duet::rotate(s.q, vector3(vector3::Unit(i))));
  }
  to << toe_in(s.q) << camber(s.q) << s.omega() << s.omega_first();
}

/// δ and ∂δ/∂u of a spline at a height.
/// \param out  true (6), and of the cumulative spline as printed with functions from B_0 (6), else
/// 0
DUET_LIVE void rates_at(int rows, int kind, int ends, double u, double* out) {
  live::writer to(out);
  with_spline(table_of(rows), kind, ends, [&](const auto& s) {
    const rates t = true_rates(s, u);
    rates p{vector3::Zero(), vector3::Zero()};
    if constexpr (requires { duet::printed_derivative(s, u); }) {
      p = as_printed_from_zero(s, u);
    }
    to << t.delta << t.delta_first << p.delta << p.delta_first;
  });
}

/// Errors of a spline relative to the mechanism, percent (P6), at 2001 heights.
/// \param rows  number of rows of the table, at least 6
/// \param kind  0 cumulative, 1 rotation-vector cubic, 2 quintic, 3 Hermite
/// \param ends  0 natural, 1 not-a-knot, 2 clamped, 3 acceleration, 4 both, for the quintic only;
///              ignored for Hermite
/// \param out   median, maximum and height of the maximum of δ_E, then of dδ_E, then of both as
///              printed (0 unless the spline is cumulative); the heights of the rows; the largest
///              error between any two rows: δ_E, dδ_E, δ_E printed, dδ_E printed:
///              12 + rows + 4 (rows − 1) numbers
DUET_LIVE void errors_of_spline(int rows, int kind, int ends, double* out) {
  live::writer to(out);
  const table& t = table_of(rows);
  with_spline(t, kind, ends, [&](const auto& s) {
    const error_curve correct = errors_of([&](double u) { return true_rates(s, u); });
    std::vector<double> none(correct.delta.size());
    error_curve printed{none, none};
    if constexpr (requires { duet::printed_derivative(s, 0.); }) {
      printed = errors_of([&](double u) { return as_printed_from_zero(s, u); });
    }
    const std::vector<double>* curves[] = {&correct.delta, &correct.delta_first, &printed.delta,
                                           &printed.delta_first};
    for (const auto* values : curves) {
      summary_of(*values, to);
    }
    to << t.u;
    for (const auto* values : curves) {
      to << largest_between(t.u, *values);
    }
  });
}
