// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

/// \file
/// A path over a parameter that makes motions from rest to rest smooth. For those who extend duet.

namespace duet::detail {

/// A part of a path on one edge of a curve and in one interval [k, k + 1] of τ: where it starts on
/// the edge, and s from there on, a t + b t² + c t³ with t = τ − k − from, 0 ≤ t ≤ length.
struct reference_piece {
  std::size_t edge, interval;
  double from, length, start, a, b, c;
};

/// The length s of a path as a cubic B-spline of τ, 0 ≤ τ ≤ n: twice continuously differentiable,
/// and it rises as its coefficients do. At the ends s grows with τ³, so that a motion with any
/// τ̇ > 0 there is at rest, and without acceleration.
class reference_law {
public:
  /// \param places  about where it is at τ = 0, 1, …, n, n ≥ 4
  explicit reference_law(const std::vector<double>& places) {
    const std::size_t n = places.size() - 1;
    c_.assign(n + 3, places.back());
    std::fill_n(c_.begin(), 3, places.front());
    for (std::size_t i = 2; i + 1 < n; ++i) {
      // With a sixth of the second difference taken off cubic polynomials stay what they are.
      const double before = places[i] - places[i - 1], after = places[i + 1] - places[i];
      c_[i + 1] = places[i] - std::clamp((after - before) / 6, -after / 2, before / 2);
    }
  }

  /// All of it, cut where intervals end and where edges do.
  /// \param knots  where in s edges begin and end
  [[nodiscard]] std::vector<reference_piece> pieces(const std::vector<double>& knots) const {
    std::vector<reference_piece> result;
    std::size_t edge = 0;
    for (std::size_t k = 0; k + 3 < c_.size(); ++k) {
      const auto [p_0, p_1, p_2, p_3] = powers(k);
      const auto place = [p_0 = p_0, p_1 = p_1, p_2 = p_2, p_3 = p_3](double t) {
        return p_0 + t * (p_1 + t * (p_2 + t * p_3));
      };
      for (double from = 0; from < 1;) {
        const bool is_last = edge + 2 == knots.size();
        const double end = knots[edge + 1];
        const double to = is_last || place(1) <= end ? 1 : crossing(place, end, from);
        if (to > from) {
          result.push_back({edge, k, from, to - from,
                            std::clamp(place(from) - knots[edge], 0.0, end - knots[edge]),
                            p_1 + from * (2 * p_2 + 3 * from * p_3), p_2 + 3 * from * p_3, p_3});
        }
        edge += !is_last && (to < 1 || place(1) >= end);
        from = to;
      }
    }
    return result;
  }

private:
  /// Of s in [k, k + 1], by powers of τ − k.
  [[nodiscard]] std::array<double, 4> powers(std::size_t k) const {
    const double d_0 = c_[k + 1] - c_[k], d_1 = c_[k + 2] - c_[k + 1], d_2 = c_[k + 3] - c_[k + 2];
    return {c_[k + 1] + (d_1 - d_0) / 6, (d_0 + d_1) / 2, (d_1 - d_0) / 2,
            (d_2 - 2 * d_1 + d_0) / 6};
  }
  /// The first number from `low` to 1 at which an increasing function is not below a value.
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
