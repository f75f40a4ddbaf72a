// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "carrier.hpp"
#include "error_measure.hpp"

#include <duet/derivative/derivative.hpp>
#include <duet/quaternion/euler.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/printed.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

/// \file
/// Angular velocity per unit of u, δ, and its derivative ∂δ/∂u of a spline by several methods, and
/// their errors relative to the mechanism (P5, P6).

namespace wheel_carrier {

using spline = duet::cumulative_bspline<double>;

/// δ and ∂δ/∂u, spatial axes.
struct rates {
  vector3 delta, delta_first;
};

/// From Q, Q′, Q″: δ = 2 vec(Q′ Q*), ∂δ/∂u = 2 vec(Q″ Q*).
inline rates rates_of(const rotation& q, const rotation& first, const rotation& second) {
  return {2 * (first * conj(q)).vec(), 2 * (second * conj(q)).vec()};
}

/// The exact closed form: P3 and P4, corrected.
inline rates closed_form(const spline& s, double u) {
  const auto m = s.motion(u, duet::frame::spatial);
  return {m.velocity, m.acceleration};
}

/// Automatic differentiation: Taylor numbers through the evaluation of the curve.
inline rates automatic(const spline& s, double u) {
  const auto q = duet::derivatives<2>(s, u);
  return rates_of(q[0], q[1], q[2]);
}

/// ψ, θ, φ of R = Rz(ψ) Ry(θ) Rx(φ) with their first two derivatives, from Q, Q′, Q″.
template <std::size_t N>
std::array<duet::taylor<double, 2>, 3> angle_series(const std::array<rotation, N>& q) {
  using series = duet::taylor<double, 2>;
  const auto component = [&](auto get) { return series({get(q[0]), get(q[1]), get(q[2]) / 2}); };
  return duet::euler<duet::zyx>(
      duet::quaternion<series>(component([](const auto& p) { return p.w(); }),
                               component([](const auto& p) { return p.x(); }),
                               component([](const auto& p) { return p.y(); }),
                               component([](const auto& p) { return p.z(); })));
}

/// By Euler angles (P5, corrected): δ = A [ψ′ θ′ φ′]ᵀ and its derivative.
inline rates through_euler_angles(const spline& s, double u) {
  const auto angles = angle_series(s.derivatives(u));
  using linear = duet::taylor<double, 1>;
  const auto angle = [&](std::size_t i) {
    return linear({angles[i].coefficient(0), angles[i].coefficient(1)});
  };
  const auto rate = [&](std::size_t i) {
    return linear({angles[i].derivative(1), angles[i].derivative(2)});
  };
  const duet::vector3<linear> delta = duet::euler_rate_matrix<duet::zyx>(angle(0), angle(1)) *
                                      duet::vector3<linear>(rate(0), rate(1), rate(2));
  return {delta.unaryExpr([](const linear& x) { return x.value(); }),
          delta.unaryExpr([](const linear& x) { return x.derivative(1); })};
}

/// P3 and P4 as printed, with basis functions from B_{-1}.
inline rates as_printed(const spline& s, double u) {
  const auto p = duet::printed_derivative(s, u);
  return rates_of(s(u), p.literal_first, p.literal_second);
}

/// P3 and P4 as printed, with basis functions from B_0.
inline rates as_printed_from_zero(const spline& s, double u) {
  const auto p = duet::printed_derivative(s, u);
  return rates_of(s(u), p.from_zero_first, p.from_zero_second);
}

/// P3 and P4 with the basis corrected, the ω_i still summed as if they commuted.
inline rates commuting(const spline& s, double u) {
  const auto p = duet::printed_derivative(s, u);
  return rates_of(s(u), p.commuting_first, p.commuting_second);
}

/// Numerical differentiation: a parabola through three neighbouring rotation vectors, which gives
/// central differences inside the domain.
inline rates central_differences(const spline& s, double u) {
  constexpr double h = 1e-4; // balances truncation against rounding in the second difference
  const double a = std::clamp(u, s.basis().front() + h, s.basis().back() - h);
  const rotation centre = s(a);
  const vector3 ahead = duet::rotation_vector(s(a + h) * conj(centre));
  const vector3 behind = duet::rotation_vector(s(a - h) * conj(centre));
  const vector3 second = (ahead + behind) / (h * h);
  return {(ahead - behind) / (2 * h) + second * (u - a), second};
}

/// The methods, in the order of the report.
struct method {
  const char* name;
  rates (*evaluate)(const spline&, double);
};
inline constexpr std::array methods{method{"closed form", closed_form},
                                    method{"automatic (Taylor)", automatic},
                                    method{"Euler angles, P5", through_euler_angles},
                                    method{"printed, functions from B_-1", as_printed},
                                    method{"printed, functions from B_0", as_printed_from_zero},
                                    method{"basis corrected, commuting", commuting},
                                    method{"central differences", central_differences}};

/// P6 at the samples, in percent: δ_E and dδ_E.
struct error_curve {
  std::vector<double> delta, delta_first;
};

inline error_curve errors(const std::vector<state>& reference, const spline& s, const method& w) {
  error_curve result;
  for (const state& exact : reference) {
    const rates r = w.evaluate(s, exact.u);
    result.delta.push_back(100 * relative(r.delta, exact.omega()));
    result.delta_first.push_back(100 * relative(r.delta_first, exact.omega_first()));
  }
  return result;
}

/// A curve's maximum, median, and the maxima in the middle 90 % and the outer 10 % of the samples,
/// which are uniform in u.
struct summary {
  double maximum, median, interior, ends;
};

inline summary summarise(const std::vector<double>& values) {
  const std::size_t edge = values.size() / 20;
  const auto first = values.begin() + std::ptrdiff_t(edge);
  const auto last = values.end() - std::ptrdiff_t(edge);
  summary result{};
  result.interior = *std::max_element(first, last);
  result.ends =
      std::max(*std::max_element(values.begin(), first), *std::max_element(last, values.end()));
  result.maximum = std::max(result.interior, result.ends);
  std::vector<double> sorted = values;
  const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  result.median = *middle;
  return result;
}

/// Largest relative difference of δ and ∂δ/∂u between automatic differentiation and the closed
/// form. Where a rate vanishes, as at natural ends, it is taken relative to a thousandth of its
/// maximum; where ∂δ/∂u vanishes everywhere, as between two rows, of what would change δ by itself
/// from end to end.
template <class ClosedForm, class Automatic>
double automatic_against_closed_form(const ClosedForm& closed_form, const Automatic& automatic,
                                     const std::vector<double>& samples) {
  double delta_floor = 0;
  double delta_first_floor = 0;
  for (const double u : samples) {
    const rates c = closed_form(u);
    delta_floor = std::max(delta_floor, c.delta.norm() / 1000);
    delta_first_floor = std::max(delta_first_floor, c.delta_first.norm() / 1000);
  }
  delta_first_floor =
      std::max(delta_first_floor, delta_floor / std::abs(samples.back() - samples.front()));
  const auto relative_to = [](double difference, double size) {
    return difference == 0 ? 0 : difference / size;
  };
  double worst = 0;
  for (const double u : samples) {
    const rates a = automatic(u);
    const rates c = closed_form(u);
    worst = std::max(
        {worst, relative_to((a.delta - c.delta).norm(), std::max(c.delta.norm(), delta_floor)),
         relative_to((a.delta_first - c.delta_first).norm(),
                     std::max(c.delta_first.norm(), delta_first_floor))});
  }
  return worst;
}

inline double automatic_against_closed_form(const spline& s, const std::vector<double>& samples) {
  return automatic_against_closed_form([&](double u) { return closed_form(s, u); },
                                       [&](double u) { return automatic(s, u); }, samples);
}

/// Largest ‖Q″ printed − Q″‖/‖Q″‖ on the curve, Q″ printed being the commuting sum.
inline double printed_formula_error(const spline& s, const std::vector<double>& samples) {
  double worst = 0;
  for (const double u : samples) {
    const rotation second = s.derivatives(u)[2];
    const rotation printed = duet::printed_derivative(s, u).commuting_second;
    worst = std::max(worst, norm(printed - second) / norm(second));
  }
  return worst;
}

} // namespace wheel_carrier
