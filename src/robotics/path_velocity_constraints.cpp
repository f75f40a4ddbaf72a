// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

#include "timing/path_velocity_constraints.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace duet::detail {
DUET_ABI_BEGIN

namespace {

/// Polynomial of degree at most nine in u, 0 ≤ u ≤ 1, by its powers.
struct piece_polynomial {
  std::array<double, 10> of{};

  friend piece_polynomial operator+(piece_polynomial p, const piece_polynomial& q) {
    for (std::size_t i = 0; i < 10; ++i) {
      p.of[i] += q.of[i];
    }
    return p;
  }
  friend piece_polynomial operator*(double x, piece_polynomial p) {
    for (double& each : p.of) {
      each *= x;
    }
    return p;
  }
  friend piece_polynomial operator*(const piece_polynomial& p, const piece_polynomial& q) {
    piece_polynomial result;
    for (std::size_t i = 0; i < 10; ++i) {
      for (std::size_t j = 0; p.of[i] != 0 && i + j < 10; ++j) {
        result.of[i + j] += p.of[i] * q.of[j];
      }
    }
    return result;
  }
};

/// Cubic polynomial by its Bernstein coefficients, with the amount by which the middle two have to
/// be moved up and down to enclose another polynomial.
struct cubic_approximation {
  std::array<double, 4> at{};
  double error = 0;

  cubic_approximation() = default;
  /// Interpolates a polynomial at 0, 1/3, 2/3 and 1. The difference, with Bernstein coefficients
  /// e_j, e_0 = e_9 = 0, is u (1 − u) Σ 72 / (j (9 − j)) e_j B_{j−1}(u) with those of seventh
  /// degree, and the middle two coefficients are multiplied by 3 u (1 − u).
  explicit cubic_approximation(piece_polynomial p) {
    double end = 0, third = 0, two_thirds = 0;
    for (std::size_t i = 10; i-- > 0;) {
      end += p.of[i];
      third = third / 3 + p.of[i];
      two_thirds = two_thirds * 2 / 3 + p.of[i];
    }
    const double start = p.of[0];
    at = {start, 3 * third - 1.5 * two_thirds + end / 3 - 5 * start / 6,
          3 * two_thirds - 1.5 * third + start / 3 - 5 * end / 6, end};
    p.of[0] = 0;
    p.of[1] -= 3 * (at[1] - at[0]);
    p.of[2] -= 3 * (at[0] - 2 * at[1] + at[2]);
    p.of[3] -= at[3] - at[0] + 3 * (at[1] - at[2]);
    for (std::size_t j = 1; j < 9; ++j) {
      double sum = 0, share = 1; // binomial(j, i) / binomial(9, i)
      for (std::size_t i = 0; i <= j; ++i) {
        sum += share * p.of[i];
        share *= double(j - i) / double(9 - i);
      }
      error = std::max(error, 24.0 / double(j * (9 - j)) * std::abs(sum));
    }
  }
};

/// Smallest number from `low` to 1 at which an increasing function is not below
/// a value, by bisection.
double crossing(const auto& f, double value, double low) {
  double high = 1;
  for (double middle; middle = (low + high) / 2, low < middle && middle < high;) {
    (f(middle) < value ? low : high) = middle;
  }
  return high;
}

} // namespace

reference_parametrisation::reference_parametrisation(const std::vector<double>& arc_lengths,
                                                     ends_at_rest rest) {
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

std::vector<reference_piece>
reference_parametrisation::pieces(const std::vector<double>& knots) const {
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

void reference_parametrisation::advance(double p_0, double p_1, double p_2, double c_2, double& c_1,
                                        double& c_0) {
  // The differences have one sign. ds/dτ at the end is c_2 + 2 c_1 − 3 p_0: at least a twentieth
  // of c_2 − p_0 remains.
  const double near_end = p_1 - p_0, next = p_2 - p_1, max_bend = 2.85 * (c_2 - p_0);
  const double bend = std::clamp((next - near_end) / near_end, -.5, max_bend / near_end) * near_end;
  c_1 = p_0 - bend / 6;
  c_0 = 6 * p_0 - 4 * c_1 - c_2;
}

std::array<double, 4> reference_parametrisation::powers(std::size_t k) const {
  const double d_0 = c_[k + 1] - c_[k], d_1 = c_[k + 2] - c_[k + 1], d_2 = c_[k + 3] - c_[k + 2];
  return {c_[k + 1] + (d_1 - d_0) / 6, (d_0 + d_1) / 2, (d_1 - d_0) / 2, (d_2 - 2 * d_1 + d_0) / 6};
}

namespace {

/// Bernstein coefficients of p u² for cubic polynomials u and p given by theirs; those of p are
/// linear forms.
std::array<linear_form, 10> times_square(const std::array<linear_form, 4>& p,
                                         const std::array<double, 4>& u) {
  constexpr std::array<double, 4> of_3{1, 3, 3, 1}; // binomial coefficients
  constexpr std::array<double, 10> of_9{1, 9, 36, 84, 126, 126, 84, 36, 9, 1};
  std::array<linear_form, 10> result{};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      for (std::size_t r = 0; r < 4; ++r) {
        const double factor = of_3[a] * of_3[b] * of_3[r] / of_9[a + b + r] * u[a] * u[b];
        for (std::size_t i = 0; i < 3; ++i) {
          result[a + b + r][i] += factor * p[r][i];
        }
      }
    }
  }
  return result;
}

} // namespace

std::array<linear_form, 3> path_velocity_powers(std::size_t k, std::size_t intervals) {
  const linear_form start = k == 0 ? linear_form{1, 0, 0} : linear_form{.5, .5, 0};
  const linear_form end = k + 1 == intervals ? linear_form{0, 0, 1} : linear_form{0, .5, .5};
  std::array<linear_form, 3> result{start, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const double middle = i == 1 ? 1 : 0;
    result[1][i] = 2 * (middle - start[i]);
    result[2][i] = start[i] - 2 * middle + end[i];
  }
  return result;
}

path_velocity_constraints::path_velocity_constraints(const std::vector<joint_cubic>& curve,
                                                     const std::vector<reference_piece>& path,
                                                     std::size_t intervals,
                                                     const Eigen::VectorXd& velocity,
                                                     const Eigen::VectorXd& acceleration,
                                                     const Eigen::VectorXd& jerk) {
  pieces.reserve(path.size());
  joints.reserve(path.size() * std::size_t(velocity.size()));
  for (const reference_piece& piece : path) {
    add(curve[piece.edge], piece, intervals, velocity, acceleration, jerk);
  }
}

void path_velocity_constraints::add(const joint_cubic& q, const reference_piece& piece,
                                    std::size_t intervals, const Eigen::VectorXd& velocity,
                                    const Eigen::VectorXd& acceleration,
                                    const Eigen::VectorXd& jerk) {
  using polynomial = piece_polynomial;
  const double l = piece.length, f = piece.from;
  // With x = s − start: q' = p_0 + p_1 x + p_2 x² / 2, q'' = p_1 + p_2 x, q''' = p_2.
  const std::array<Eigen::VectorXd, 3> p{q.first(piece.start), q.second(piece.start),
                                         Eigen::VectorXd(6 * q.c3)};
  const polynomial offset{{0, piece.a * l, piece.b * l * l, piece.c * l * l * l}};
  const polynomial slope{{piece.a, 2 * piece.b * l, 3 * piece.c * l * l}};
  const polynomial bend{{2 * piece.b, 6 * piece.c * l}};
  const polynomial half_square = .5 * (offset * offset);

  // Factors of p_0, p_1 and p_2; those of accelerations and jerks for each coefficient.
  const std::array rates{cubic_approximation(slope), cubic_approximation(offset * slope),
                         cubic_approximation(half_square * slope)};
  std::array<std::array<cubic_approximation, 3>, 3> changes, jerks;
  piece_bounds bounds{piece.interval, l, {}, {}};
  const auto b = path_velocity_powers(piece.interval, intervals);
  for (std::size_t i = 0; i < 3; ++i) {
    const double start = b[0][i] + f * (b[1][i] + f * b[2][i]);
    const double rise = b[1][i] + 2 * f * b[2][i], curvature = b[2][i];
    bounds.squared_velocity[0][i] = start;
    bounds.squared_velocity[1][i] = start + rise * l / 3;
    bounds.squared_velocity[2][i] = start + l * (2 * rise + l * curvature) / 3;
    bounds.squared_velocity[3][i] = start + l * (rise + l * curvature);
    const polynomial squared_velocity{{start, rise * l, curvature * l * l}};
    const polynomial half_rise{{rise / 2, curvature * l}};
    const polynomial square = slope * slope * squared_velocity;
    const polynomial change = bend * squared_velocity + slope * half_rise;
    const polynomial both = 3 * (slope * change);
    const polynomial third =
        6 * piece.c * squared_velocity + 3 * (bend * half_rise) + curvature * slope;
    changes[i] = {cubic_approximation(change), cubic_approximation(square + offset * change),
                  cubic_approximation(offset * square + half_square * change)};
    jerks[i] = {cubic_approximation(third), cubic_approximation(both + offset * third),
                cubic_approximation(slope * square + offset * both + half_square * third)};
  }
  std::array<double, 4> largest_rate{};
  for (Eigen::Index j = 0; j < velocity.size(); ++j) {
    joint_bounds rows;
    double beyond = 0;
    std::array<double, 4> rate{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double factor = p[k][j], size = std::abs(factor);
      for (std::size_t r = 0; r < 4; ++r) {
        rate[r] += factor * rates[k].at[r];
      }
      beyond += size * rates[k].error;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t r = 0; r < 4; ++r) {
          rows.acceleration[r][i] += factor * changes[i][k].at[r] / acceleration[j];
          rows.jerk[r][i] += factor * jerks[i][k].at[r] / jerk[j];
        }
        rows.beyond_acceleration[i] += size * changes[i][k].error / acceleration[j];
        rows.beyond_jerk[i] += size * jerks[i][k].error / jerk[j];
      }
    }
    for (std::size_t r = 0; r < 4; ++r) {
      const double size = std::abs(rate[r]) + (r == 1 || r == 2 ? beyond : 0);
      largest_rate[r] = std::max(largest_rate[r], size / velocity[j]);
    }
    joints.push_back(rows);
  }
  bounds.square_rate = times_square(bounds.squared_velocity, largest_rate);
  pieces.push_back(bounds);
}

DUET_ABI_END
} // namespace duet::detail
