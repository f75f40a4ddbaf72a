// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/config.hpp>
#include <duet/robotics/branches/circle_roots.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

/// \file
/// Angles from equations that are linear in their cosines and sines.

namespace duet::detail {

/// Trigonometric polynomial a + b cos θ + c sin θ.
struct first_harmonic {
  double a = 0, b = 0, c = 0;

  [[nodiscard]] double at(double theta) const {
    return a + b * std::cos(theta) + c * std::sin(theta);
  }
  [[nodiscard]] double rate(double theta) const {
    return c * std::cos(theta) - b * std::sin(theta);
  }
  /// Squared amplitude, that of the largest deviation from a.
  [[nodiscard]] double square() const { return b * b + c * c; }
};

/// Distance below which two zeros count as one, of multiplicity 2: round-off
/// separates them by as much.
inline constexpr double one_angle = 3e-7;

/// Calls visit(θ, multiplicity) for the zeros of a + b cos θ + c sin θ, also where it is nearly
/// zero: the pair of zeros there may be complex only because of round-off in a, b and c, which come
/// from ill-conditioned angles.
///
/// \param error  error of a, b and c, if it exceeds round-off
/// \return false if the function is zero to round-off, or an error decides whether there are zeros
template <class Visit>
bool visit_zeros(const first_harmonic& f, const Visit& visit, double error = 0) {
  constexpr double rounding = 1e-12, nearly = 1e-9;
  const double r = std::sqrt(f.b * f.b + f.c * f.c);
  if (!(r > rounding)) {
    return std::abs(f.a) > rounding;
  }
  const double cosine = -f.a / r, centre = std::atan2(f.c, f.b);
  if (std::abs(cosine) <= 1 - one_angle * one_angle) {
    const double half_distance = std::acos(cosine);
    visit(centre + half_distance, 1);
    visit(centre - half_distance, 1);
  } else if (std::abs(cosine) <= 1 + std::max(nearly, error / r)) {
    visit(cosine > 0 ? centre : centre + std::acos(-1.), 2);
  }
  return std::abs(std::abs(cosine) - 1) * r >= error;
}

/// System of two equations f(θ) = g(φ).
struct angle_pairs {
  std::array<first_harmonic, 2> f, g;

  /// Calls visit(θ, φ, multiplicity) for each solution.
  ///
  /// \return false if one of the angles is undetermined
  template <class Visit>
  bool operator()(const Visit& visit) const {
    const double by_theta = regularity(f), by_phi = regularity(g);
    const auto swapped = [&](double x, double y, int m) { visit(y, x, m); };
    if (is_constant(f) || is_constant(g)) {
      is_constant(f) ? solve_constant(f, g, visit) : solve_constant(g, f, swapped);
      return false;
    }
    constexpr double singular = 1e-9;
    if (std::min(by_theta, by_phi) > singular) {
      if (by_theta >= by_phi) {
        return solve_regular(f, g, visit);
      }
      return solve_regular(g, f, swapped);
    }
    return by_theta < by_phi ? solve_dependent(f, g, visit) : solve_dependent(g, f, swapped);
  }

private:
  using two_values = std::array<first_harmonic, 2>;

  [[nodiscard]] static double determinant(const two_values& f) {
    return f[0].b * f[1].c - f[0].c * f[1].b;
  }
  /// Determinant relative to the squared size of its rows.
  [[nodiscard]] static double regularity(const two_values& f) {
    const double size = f[0].b * f[0].b + f[0].c * f[0].c + f[1].b * f[1].b + f[1].c * f[1].c;
    return size > 1e-18 ? std::abs(determinant(f)) / size : 0;
  }

  /// True if f does not depend on its angle, to round-off.
  [[nodiscard]] static bool is_constant(const two_values& f) {
    constexpr double rounding = 1e-12;
    return std::max(f[0].square(), f[1].square()) <= rounding * rounding;
  }
  /// Solves for φ if θ is arbitrary: by the equation with the larger amplitude, where the other one
  /// holds, too.
  template <class Visit>
  static void solve_constant(const two_values& f, const two_values& g, const Visit& visit) {
    constexpr double rounding = 1e-6; // for φ where the zeros nearly coincide
    const std::size_t k = g[0].square() >= g[1].square() ? 0 : 1;
    static_cast<void>(
        visit_zeros({g[k].a - f[k].a, g[k].b, g[k].c}, [&](double phi, int multiplicity) {
          if (std::abs(g[1 - k].at(phi) - f[1 - k].a) < rounding) {
            visit(0., phi, multiplicity);
          }
        }));
  }

  /// Solves a system of which a linear combination of both equations does not depend on θ.
  template <class Visit>
  static bool solve_dependent(const two_values& f, const two_values& g, const Visit& visit) {
    const double at_0 = std::hypot(f[0].b, f[0].c), at_1 = std::hypot(f[1].b, f[1].c);
    const std::size_t larger = at_0 >= at_1 ? 0 : 1, other = 1 - larger;
    const first_harmonic &fl = f[larger], &fo = f[other], &gl = g[larger], &go = g[other];
    const double size = fl.b * fl.b + fl.c * fl.c;
    const double ratio = size > 0 ? (fl.b * fo.b + fl.c * fo.c) / size : 0;
    bool is_determined = true;
    const first_harmonic in_phi{go.a - fo.a - ratio * (gl.a - fl.a), go.b - ratio * gl.b,
                                go.c - ratio * gl.c};
    const bool has_phi = visit_zeros(in_phi, [&](double phi, int m) {
      const bool has_theta = visit_zeros({fl.a - gl.at(phi), fl.b, fl.c},
                                         [&](double theta, int n) { visit(theta, phi, m * n); });
      is_determined = is_determined && has_theta;
    });
    return has_phi && is_determined;
  }

  /// Solves (cos θ, sin θ) = u + V (cos φ, sin φ), whose square is 1.
  ///
  /// \return false if the equation is zero to round-off
  template <class Visit>
  static bool solve_regular(const two_values& f, const two_values& g, const Visit& visit) {
    const double d = determinant(f);
    const auto solved = [&](double r0, double r1) {
      return std::array{(r0 * f[1].c - r1 * f[0].c) / d, (f[0].b * r1 - f[1].b * r0) / d};
    };
    const auto u = solved(g[0].a - f[0].a, g[1].a - f[1].a);
    const auto v = solved(g[0].b, g[1].b), w = solved(g[0].c, g[1].c);
    // u + q z + q̄/z
    using complex = std::complex<double>;
    const complex q0(v[0] / 2, -w[0] / 2), q1(v[1] / 2, -w[1] / 2);
    const double squares = u[0] * u[0] + u[1] * u[1] + 2 * (std::norm(q0) + std::norm(q1));
    const std::array<complex, 3> coefficients{squares - 1, 2. * (u[0] * q0 + u[1] * q1),
                                              q0 * q0 + q1 * q1};
    // Ratio of round-off to that of coefficients of which the largest is 1.
    const double noise =
        (squares + 1) / std::sqrt(std::max({std::norm(coefficients[0]), std::norm(coefficients[1]),
                                            std::norm(coefficients[2])}));
    constexpr double vanishing = 1e12;
    if (noise > vanishing) {
      return false; // for every φ there is a θ
    }
    const circle_roots<2> roots(coefficients);
    std::array<bool, 4> is_done{};
    for (int i = 0; i < 4; ++i) {
      const complex z = roots[i];
      const double off = std::sqrt(std::norm(z)) - 1, sensitivity = noise * roots.sensitivity(i),
                   error = std::min(1e-5, 1e-9 + 1e-13 * sensitivity);
      const auto visit_at = [&](double phi, int multiplicity) {
        const double c = std::cos(phi), s = std::sin(phi);
        visit(std::atan2(u[1] + v[1] * c + w[1] * s, u[0] + v[0] * c + w[0] * s), phi,
              multiplicity);
      };
      // Two zeros z and 1/z̄ that nearly coincide, which round-off may have made complex.
      if (off > error && off < std::min(1e-2, 1e-11 * sensitivity)) {
        visit_at(std::arg(z) - off, 1);
        visit_at(std::arg(z) + off, 1);
      }
      if (is_done[std::size_t(i)] || !(std::abs(off) < error)) {
        continue;
      }
      int multiplicity = 1;
      for (int j = i + 1; j < 4; ++j) {
        if (std::abs(roots[j] - z) < one_angle) {
          is_done[std::size_t(j)] = true;
          ++multiplicity;
        }
      }
      visit_at(std::arg(z), multiplicity);
    }
    return true;
  }
};

} // namespace duet::detail
