// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "comparison.hpp"

#include <duet/spline/basis.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// The configuration of the carrier q_K = [x y z φ θ ψ] and its first two derivatives with respect
/// to u, computed from the table as in the paper.

namespace wheel_carrier {

/// The wheel centre W and the angles [φ θ ψ] of R = Rz(ψ) Ry(θ) Rx(φ), each with first and second
/// derivatives with respect to u; metres and radians.
struct configuration {
  std::array<vector3, 3> position, angles;
};

template <std::size_t N>
std::array<vector3, 3> angles_of(const std::array<rotation, N>& q) {
  const auto series = angle_series(q);
  std::array<vector3, 3> result;
  for (int k = 0; k < 3; ++k) {
    result[std::size_t(k)] = {series[2].derivative(k), series[1].derivative(k),
                              series[0].derivative(k)};
  }
  return result;
}

inline configuration configuration_of(const state& s) {
  return {{s.centre, s.centre_first, s.centre_second},
          angles_of(std::array{s.q, s.q_first, s.q_second})};
}

/// P2 for vectors, W(u) = W_{−1} + Σ (W_i − W_{i−1}) B̃_i(u): the cubic curve through the wheel
/// centres of the rows, with known derivatives at the ends.
class position_spline {
public:
  position_spline(const std::vector<double>& u, const std::vector<vector3>& rows,
                  const vector3& start_rate, const vector3& end_rate)
      : basis_(duet::clamped_knots(u, spline::order)), controls_(basis_.size()) {
    const std::size_t n = rows.size() - 1;
    controls_[0] = rows[0];
    controls_[1] = rows[0] + start_rate / basis_.weights<1>(0, u.front())[1][0];
    controls_[n + 2] = rows[n];
    controls_[n + 1] = rows[n] - end_rate / basis_.weights<1>(n - 1, u.back())[1][2];
    // Each interior row depends on three control points. Gaussian elimination without pivoting: for
    // B-splines no element grows.
    std::vector<double> ratio(n);
    std::vector<vector3> reduced(n);
    reduced[0] = controls_[1];
    for (std::size_t i = 1; i < n; ++i) {
      const auto [w] = basis_.weights<0>(i, u[i]);
      const double pivot = w[0] - w[1] - (1 - w[0]) * ratio[i - 1];
      ratio[i] = (w[1] - w[2]) / pivot;
      reduced[i] = (rows[i] - (1 - w[0]) * reduced[i - 1]) / pivot;
    }
    for (std::size_t i = n; --i > 0;) {
      controls_[i + 1] = reduced[i] - ratio[i] * controls_[i + 2];
    }
  }

  /// W, W′, W″.
  [[nodiscard]] std::array<vector3, 3> at(double u) const {
    const std::size_t span = basis_.find_span(u);
    const std::size_t first = basis_.first_function(span);
    const auto weights = basis_.weights<2>(span, u);
    std::array<vector3, 3> result{controls_[first], vector3::Zero(), vector3::Zero()};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j) {
        result[k] += (controls_[first + 1 + j] - controls_[first + j]) * weights[k][j];
      }
    }
    return result;
  }

private:
  spline::basis_type basis_;
  std::vector<vector3> controls_;
};

/// Errors of the configuration: norms of the errors of (x, y, z) and (φ, θ, ψ), of their first
/// and of their second derivatives.
struct configuration_errors {
  std::array<std::vector<double>, 3> position, angles;

  void add(const configuration& c, const configuration& exact) {
    for (std::size_t k = 0; k < 3; ++k) {
      position[k].push_back((c.position[k] - exact.position[k]).norm());
      angles[k].push_back((c.angles[k] - exact.angles[k]).norm());
    }
  }
};

} // namespace wheel_carrier
