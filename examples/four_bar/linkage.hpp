// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/dual/eigen_traits.hpp>
#include <duet/dual/math.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

/// \file
/// A planar four-bar linkage: its constraints, and the closed forms it is compared with.

namespace four_bar {

/// Coupler angle β and rocker angle ψ, from the ground link.
using angles = Eigen::Vector2d;

/// The crank rotates about (0, 0), the rocker about (ground, 0).
struct linkage {
  double crank, coupler, rocker, ground;

  /// a e^{iθ} + b e^{iβ} = d + c e^{iψ}: the constraints of a `constrained_mechanism` driven by θ.
  template <class X, class T>
  [[nodiscard]] auto operator()(const X& x, const T& theta) const {
    using std::cos;
    using std::sin;
    return duet::make_vector(crank * cos(theta) + coupler * cos(x[0]) - ground - rocker * cos(x[1]),
                             crank * sin(theta) + coupler * sin(x[0]) - rocker * sin(x[1]));
  }

  /// By Grashof: the shortest and the longest link against the other two.
  [[nodiscard]] std::string kind() const {
    std::array<double, 4> sorted{crank, coupler, rocker, ground};
    std::sort(sorted.begin(), sorted.end());
    const double excess = sorted[0] + sorted[3] - sorted[1] - sorted[2];
    if (std::abs(excess) <= 1e-12 * sorted[3]) {
      return "change-point linkage";
    }
    return excess > 0            ? "triple rocker"
           : sorted[0] == ground ? "double crank"
           : sorted[0] == crank  ? "crank-rocker"
           : sorted[0] == rocker ? "rocker-crank"
                                 : "double rocker";
  }
};

/// β and ψ by Freudenstein's equation k cos ψ + s sin ψ = (c² + k² + s² − b²)/2c with
/// k + is = a e^{iθ} − d; NaN if the linkage cannot close.
///
/// \param side  −1 or 1: which of its two solutions
inline angles closed_form(const linkage& l, double theta, double side) {
  const double k = l.crank * std::cos(theta) - l.ground;
  const double s = l.crank * std::sin(theta);
  const double square = k * k + s * s;
  const double q = (l.rocker * l.rocker + square - l.coupler * l.coupler) / (2 * l.rocker);
  const double psi = std::atan2(s, k) + side * std::atan2(std::sqrt(square - q * q), q);
  return {std::atan2(l.rocker * std::sin(psi) - s, l.rocker * std::cos(psi) - k), psi};
}

/// Closed forms of ψ′ and ψ″ with respect to θ: the first and second derivative of the loop
/// equation, projected onto the coupler.
struct rocker_rates {
  double first, second;

  rocker_rates(const linkage& l, double theta, const angles& x) {
    const auto [a, b, c, d] = l;
    const double beta = x[0], psi = x[1];
    const double across = c * std::sin(psi - beta);
    first = a * std::sin(theta - beta) / across;
    const double coupler_first = a * std::sin(theta - psi) / (b * std::sin(psi - beta));
    second = (a * std::cos(theta - beta) + b * coupler_first * coupler_first -
              c * first * first * std::cos(psi - beta)) /
             across;
  }
};

/// A point of the coupler.
template <class X, class T>
[[nodiscard]] auto coupler_point(const linkage& l, const Eigen::Vector2d& position, const X& x,
                                 const T& theta) {
  using std::cos;
  using std::sin;
  return duet::make_vector(l.crank * cos(theta) + position[0] * cos(x[0]) - position[1] * sin(x[0]),
                           l.crank * sin(theta) + position[0] * sin(x[0]) +
                               position[1] * cos(x[0]));
}

} // namespace four_bar
