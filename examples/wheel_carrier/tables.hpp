// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "carrier.hpp"
#include "comparison.hpp"
#include "configuration.hpp"
#include "splines.hpp"
#include "table.hpp"

#include <duet/core/text/csv.hpp>

#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

/// \file
/// Tables of a run as CSV.

namespace wheel_carrier {

using duet::csv_line;

/// u, W, q, toe-in and camber of the left wheel in degrees, W from its design position.
inline std::string path_csv(const std::vector<state>& states, const vector3& design) {
  std::string text = "u,x,y,z,qw,qx,qy,qz,toe_in_deg,camber_deg,dx,dy\n";
  constexpr double degrees = 180 / std::numbers::pi;
  for (const state& s : states) {
    text += csv_line({s.u, s.centre[0], s.centre[1], s.centre[2], s.q.w(), s.q.x(), s.q.y(),
                      s.q.z(), toe_in(s.q) * degrees, camber(s.q) * degrees,
                      s.centre[0] - design[0], s.centre[1] - design[1]});
  }
  return text;
}

inline std::string table_csv(const table& t) {
  std::string text = "u,qw,qx,qy,qz\n";
  for (std::size_t i = 0; i < t.u.size(); ++i) {
    text += csv_line({t.u[i], t.q[i].w(), t.q[i].x(), t.q[i].y(), t.q[i].z()});
  }
  return text;
}

/// u, then δ and ∂δ/∂u of the spline.
inline std::string rates_csv(const curve& c, const std::vector<double>& samples) {
  std::string text = "u,delta_x,delta_y,delta_z,ddelta_x,ddelta_y,ddelta_z\n";
  for (const double u : samples) {
    const rates r = c.at(u);
    text += csv_line({u, r.delta[0], r.delta[1], r.delta[2], r.delta_first[0], r.delta_first[1],
                      r.delta_first[2]});
  }
  return text;
}

/// u, then x, y, z, φ, θ, ψ and their first and second derivatives.
inline std::string configuration_csv(const std::vector<double>& samples,
                                     const std::vector<configuration>& values) {
  std::vector<std::string> names{"u"};
  for (const char* const order : {"", "_first", "_second"}) {
    for (const char* const name : {"x", "y", "z", "phi", "theta", "psi"}) {
      names.push_back(std::string(name) + order);
    }
  }
  std::string text = duet::csv_header(names);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::vector<double> row{samples[i]};
    for (std::size_t k = 0; k < 3; ++k) {
      for (const vector3& v : {values[i].position[k], values[i].angles[k]}) {
        row.insert(row.end(), v.data(), v.data() + 3);
      }
    }
    text += csv_line(row);
  }
  return text;
}

inline std::string configuration_errors_csv(const std::vector<double>& samples,
                                            const configuration_errors& off) {
  std::string text =
      "u,position,angles,position_first,angles_first,position_second,angles_second\n";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    text += csv_line({samples[i], off.position[0][i], off.angles[0][i], off.position[1][i],
                      off.angles[1][i], off.position[2][i], off.angles[2][i]});
  }
  return text;
}

using named_curve = std::pair<std::string, error_curve>;

/// u, then δ_E and dδ_E in percent for every curve.
inline std::string errors_csv(const std::vector<double>& samples,
                              const std::vector<named_curve>& curves) {
  std::vector<std::string> names{"u"};
  for (const auto& [name, curve] : curves) {
    names.push_back("delta_E " + name);
    names.push_back("ddelta_E " + name);
  }
  std::string text = duet::csv_header(names);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::vector<double> row{samples[i]};
    for (const auto& [name, curve] : curves) {
      row.push_back(curve.delta[i]);
      row.push_back(curve.delta_first[i]);
    }
    text += csv_line(row);
  }
  return text;
}

} // namespace wheel_carrier
