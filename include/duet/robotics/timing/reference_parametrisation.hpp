// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

/// \file
/// Reparametrisation s(τ) of a path for smooth motions, also from and to rest. For
/// those who extend duet.

namespace duet::detail {

/// Segment of a path on one edge of a curve and in one interval [k, k + 1] of τ: its start on the
/// edge, and s relative to that start, a t + b t² + c t³ with t = τ − k − from, 0 ≤ t ≤ length.
struct reference_piece {
  std::size_t edge, interval;
  double from, length, start, a, b, c;
};

/// True for each end of a path at which a motion is at rest.
struct ends_at_rest {
  bool first = true, last = true;
};

/// Arc length s of a path as a cubic B-spline of τ, 0 ≤ τ ≤ n: twice continuously differentiable
/// and increasing, as its coefficients are except for the outer ones. At ends at rest s grows with
/// τ³, so that a motion with any τ̇ > 0 there is at rest without acceleration.
class reference_parametrisation {
public:
  /// Approximates given arc lengths.
  ///
  /// \param arc_lengths  approximate s at τ = 0, 1, …, n, n ≥ 4; exact at τ = 0 and n
  explicit reference_parametrisation(const std::vector<double>& arc_lengths,
                                     ends_at_rest rest = {}) {
    const std::size_t n = arc_lengths.size() - 1;
    c_.assign(n + 3, arc_lengths.back());
    std::fill_n(c_.begin(), 3, arc_lengths.front());
    const std::size_t first = rest.first ? 2 : 1, last = rest.last ? n - 2 : n - 1;
    for (std::size_t i = first; i <= last; ++i) {
      // Subtracting a sixth of the second difference reproduces cubic polynomials.
      const double before = arc_lengths[i] - arc_lengths[i - 1],
                   after = arc_lengths[i + 1] - arc_lengths[i];
      c_[i + 1] = arc_lengths[i] - std::clamp((after - before) / 6, -after / 2, before / 2);
    }
    if (!rest.first) {
      advance(arc_lengths[0], arc_lengths[1], arc_lengths[2], c_[2], c_[1], c_[0]);
    }
    if (!rest.last) {
      advance(arc_lengths[n], arc_lengths[n - 1], arc_lengths[n - 2], c_[n], c_[n + 1], c_[n + 2]);
    }
  }

  /// Derivative ds/dτ at an end.
  [[nodiscard]] double first_slope() const { return (c_[2] - c_[0]) / 2; }
  [[nodiscard]] double last_slope() const { return (c_[c_.size() - 1] - c_[c_.size() - 3]) / 2; }

  /// All segments, split at the ends of intervals and of edges.
  ///
  /// \param knots  arc lengths s at which edges begin and end
  [[nodiscard]] std::vector<reference_piece> pieces(const std::vector<double>& knots) const {
    std::vector<reference_piece> result;
    std::size_t edge = 0;
    for (std::size_t k = 0; k + 3 < c_.size(); ++k) {
      const auto [p_0, p_1, p_2, p_3] = powers(k);
      const auto arc_length = [p_0 = p_0, p_1 = p_1, p_2 = p_2, p_3 = p_3](double t) {
        return p_0 + t * (p_1 + t * (p_2 + t * p_3));
      };
      for (double from = 0; from < 1;) {
        const bool is_last = edge + 2 == knots.size();
        const double end = knots[edge + 1];
        const double to = is_last || arc_length(1) <= end ? 1 : crossing(arc_length, end, from);
        if (to > from) {
          result.push_back({edge, k, from, to - from,
                            std::clamp(arc_length(from) - knots[edge], 0.0, end - knots[edge]),
                            p_1 + from * (2 * p_2 + 3 * from * p_3), p_2 + 3 * from * p_3, p_3});
        }
        edge += !is_last && (to < 1 || arc_length(1) >= end);
        from = to;
      }
    }
    return result;
  }

private:
  /// Computes the last two coefficients c_1 and c_0 at an end in motion at p_0, from the next two
  /// positions and the coefficient before them.
  static void advance(double p_0, double p_1, double p_2, double c_2, double& c_1, double& c_0) {
    // The differences have one sign. ds/dτ at the end is c_2 + 2 c_1 − 3 p_0: at least a twentieth
    // of c_2 − p_0 remains.
    const double near_end = p_1 - p_0, next = p_2 - p_1, max_bend = 2.85 * (c_2 - p_0);
    const double bend =
        std::clamp((next - near_end) / near_end, -.5, max_bend / near_end) * near_end;
    c_1 = p_0 - bend / 6;
    c_0 = 6 * p_0 - 4 * c_1 - c_2;
  }
  /// Coefficients of s in [k, k + 1] by powers of τ − k.
  [[nodiscard]] std::array<double, 4> powers(std::size_t k) const {
    const double d_0 = c_[k + 1] - c_[k], d_1 = c_[k + 2] - c_[k + 1], d_2 = c_[k + 3] - c_[k + 2];
    return {c_[k + 1] + (d_1 - d_0) / 6, (d_0 + d_1) / 2, (d_1 - d_0) / 2,
            (d_2 - 2 * d_1 + d_0) / 6};
  }
  /// Smallest number from `low` to 1 at which an increasing function is not below
  /// a value, by bisection.
  [[nodiscard]] static double crossing(const auto& f, double value, double low) {
    double high = 1;
    for (double middle; middle = (low + high) / 2, low < middle && middle < high;) {
      (f(middle) < value ? low : high) = middle;
    }
    return high;
  }

  std::vector<double> c_;
};

} // namespace duet::detail
