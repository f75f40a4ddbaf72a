// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "carrier.hpp"
#include "comparison.hpp"
#include "options.hpp"
#include "table.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// \file
/// Every spline of duet with every end condition, through the same table.

namespace wheel_carrier {

/// Rates at the ends, if they are known.
struct known_ends {
  std::optional<end_rates> velocity, acceleration;
};

inline known_ends ends_of(const state& first, const state& last) {
  return {end_rates{first.omega(), last.omega()},
          end_rates{first.omega_first(), last.omega_first()}};
}

/// A curve through a table, of any type.
struct curve {
  std::string spline, ends;
  std::function<rates(double)> at, automatic;

  [[nodiscard]] std::string name() const { return spline + ", " + ends; }
};

/// The spline of this name through the table, with the ends of this name.
/// \throws std::runtime_error if the rates at the ends are not known
curve make_curve(const std::string& name, const table& t, const std::string& ends,
                 const known_ends& known);

/// The spline of the paper.
spline cumulative_curve(const table& t, const std::string& ends, const known_ends& known);

struct spline_and_ends {
  const char *spline, *ends;
};
inline constexpr spline_and_ends all_curves[] = {{"cumulative", "natural"},
                                                 {"cumulative", "not-a-knot"},
                                                 {"cumulative", "clamped"},
                                                 {"cumulative", "acceleration"},
                                                 {"rotation-vector", "natural"},
                                                 {"rotation-vector", "not-a-knot"},
                                                 {"rotation-vector", "clamped"},
                                                 {"rotation-vector", "acceleration"},
                                                 {"quintic", "natural"},
                                                 {"quintic", "not-a-knot"},
                                                 {"quintic", "clamped"},
                                                 {"quintic", "acceleration"},
                                                 {"quintic", "both"}};

inline error_curve errors(const std::vector<state>& reference, const curve& c) {
  error_curve result;
  for (const state& exact : reference) {
    const rates r = c.at(exact.u);
    result.delta.push_back(100 * relative(r.delta, exact.omega()));
    result.delta_first.push_back(100 * relative(r.delta_first, exact.omega_first()));
  }
  return result;
}

} // namespace wheel_carrier
