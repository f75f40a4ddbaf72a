// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "carrier.hpp"

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

/// \file
/// The lookup table of the mechanism: orientations over u, at equal arcs.

namespace wheel_carrier {

struct table {
  std::vector<double> u;
  std::vector<rotation> q;
};

/// The range the wheel travels over (P7), metres.
inline constexpr double lowest = -0.19;
inline constexpr double highest = 0.20;

/// The angle between neighbouring rows of the paper's table, rad (P7).
inline constexpr double paper_angle = 0.003;

/// Arc length of the orientation from `lowest` on: s(u) = ∫ |ω| du, tabulated once so that it can
/// be inverted quickly.
class arc_length {
public:
  explicit arc_length(const carrier& mechanism) : mechanism_(mechanism), sums_{0} {
    for (int i = 0; i < intervals; ++i) {
      sums_.push_back(sums_.back() + integral(node(i), node(i + 1)));
    }
  }

  [[nodiscard]] double total() const { return sums_.back(); }

  /// The u with s(u) = arc.
  [[nodiscard]] double inverse(double arc) const {
    if (arc <= 0) {
      return lowest;
    }
    if (arc >= total()) {
      return highest;
    }
    const auto i = int(std::upper_bound(sums_.begin(), sums_.end(), arc) - sums_.begin()) - 1;
    const auto residual = [&](double u) {
      return sums_[std::size_t(i)] + (u > node(i) ? integral(node(i), u) : 0.0) - arc;
    };
    std::uintmax_t iterations = 100;
    const auto [below, above] = boost::math::tools::toms748_solve(
        residual, node(i), node(i + 1), boost::math::tools::eps_tolerance<double>(46), iterations);
    return (below + above) / 2;
  }

private:
  static constexpr int intervals = 40;

  [[nodiscard]] static double node(int i) { return lowest + (highest - lowest) * i / intervals; }
  [[nodiscard]] double integral(double from, double to) const {
    const auto speed = [this](double u) { return mechanism_.at(u).omega().norm(); };
    return boost::math::quadrature::gauss<double, 7>::integrate(speed, from, to);
  }

  const carrier& mechanism_;
  std::vector<double> sums_;
};

/// Rows at equal arcs over the whole range; their u values are not uniform.
inline table equal_arc_table(const carrier& mechanism, const arc_length& arcs, int rows) {
  table result;
  for (int i = 0; i < rows; ++i) {
    const double fraction = double(i) / (rows - 1); // exactly 1 in the last row
    const double u = arcs.inverse(arcs.total() * fraction);
    result.u.push_back(u);
    result.q.push_back(mechanism.at(u).q);
  }
  return result;
}

} // namespace wheel_carrier
