// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "splines.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/spline/interpolate.hpp>

#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace wheel_carrier {
namespace {

using rotation_vector_cubic = duet::rotation_vector_spline<double>;
using rotation_vector_quintic = duet::rotation_vector_spline<double, 6>;

/// The curve of this type with the end conditions of this name.
template <class Spline>
Spline interpolated(const table& t, const std::string& ends, const known_ends& known) {
  const auto need = [&](const std::optional<end_rates>& rates) {
    if (!rates) {
      throw std::runtime_error("--end-conditions " + ends +
                               ": a table alone has no rates at its ends (add --end-velocities or "
                               "--hardpoints)");
    }
    return *rates;
  };
  if (ends == "natural") {
    return duet::interpolate<Spline>(t.u, t.q, duet::natural{});
  }
  if (ends == "not-a-knot") {
    return duet::interpolate<Spline>(t.u, t.q, duet::not_a_knot{});
  }
  if (ends == "clamped") {
    const end_rates v = need(known.velocity);
    return duet::interpolate<Spline>(t.u, t.q, duet::clamped{v.start, v.end});
  }
  const end_rates a = need(known.acceleration);
  if (ends == "acceleration") {
    return duet::interpolate<Spline>(t.u, t.q, duet::end_acceleration{a.start, a.end});
  }
  if constexpr (std::is_same_v<Spline, rotation_vector_quintic>) {
    const end_rates v = need(known.velocity);
    return duet::interpolate<Spline>(
        t.u, t.q,
        duet::fully_clamped{duet::clamped{v.start, v.end}, duet::end_acceleration{a.start, a.end}});
  } else {
    throw std::runtime_error("--end-conditions both requires --spline quintic");
  }
}

template <class Spline>
curve make_curve(const std::string& name, const table& t, const std::string& ends,
                 const known_ends& known) {
  const auto s = std::make_shared<const Spline>(interpolated<Spline>(t, ends, known));
  return {name, ends,
          [s](double u) {
            const auto m = s->motion(u, duet::frame::spatial);
            return rates{m.velocity, m.acceleration};
          },
          [s](double u) {
            const auto q = duet::derivatives<2>(*s, u);
            return rates_of(q[0], q[1], q[2]);
          }};
}

} // namespace

curve make_curve(const std::string& name, const table& t, const std::string& ends,
                 const known_ends& known) {
  return name == "cumulative"        ? make_curve<spline>(name, t, ends, known)
         : name == "rotation-vector" ? make_curve<rotation_vector_cubic>(name, t, ends, known)
                                     : make_curve<rotation_vector_quintic>(name, t, ends, known);
}

spline cumulative_curve(const table& t, const std::string& ends, const known_ends& known) {
  return interpolated<spline>(t, ends, known);
}

} // namespace wheel_carrier
