// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "accuracy/probe.hpp"

#include <duet/dual_quaternion/pose.hpp>
#include <duet/spline/motion.hpp>

#include <cstdio>

/// \file
/// Motions of curves as lists of numbers: four for a rotation, eight for a pose with the real part
/// first; angular rates before linear ones.

namespace duet_test::accuracy {

using pose_scalar = duet::screw_dual<double>;
template <class T>
inline constexpr bool is_pose = std::is_same_v<T, pose_scalar>;

[[nodiscard]] inline std::string short_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", x);
  return text;
}

[[nodiscard]] inline double value_of(double x) { return x; }
[[nodiscard]] inline double value_of(const pose_scalar& x) { return x.value(); }
[[nodiscard]] inline double dual_part_of(double) { return 0; }
[[nodiscard]] inline double dual_part_of(const pose_scalar& x) { return x.epsilon(); }

/// Appends the components, real parts before dual parts; returns the number of components.
template <class T>
std::size_t append_components(numbers& list, const duet::quaternion<T>& q) {
  for (const T& c : {q.w(), q.x(), q.y(), q.z()}) {
    list.push_back(value_of(c));
  }
  for (const T& c : {q.w(), q.x(), q.y(), q.z()}) {
    if (is_pose<T>) {
      list.push_back(dual_part_of(c));
    }
  }
  return 4;
}
template <class T>
std::size_t append_components(numbers& list, const duet::vector3<T>& v) {
  for (int i = 0; i < 3; ++i) {
    list.push_back(value_of(v[i]));
  }
  for (int i = 0; i < 3 && is_pose<T>; ++i) {
    list.push_back(dual_part_of(v[i]));
  }
  return 3;
}
template <class Element>
void append(input& at, const Element& x) {
  const std::size_t before = at.x.size();
  const std::size_t each = append_components(at.x, x);
  at.parts.insert(at.parts.end(), (at.x.size() - before) / each, each);
}

/// Taylor coefficients, at each parameter, of Q, Q′, Q″, Q‴ and of the rates in the spatial and the
/// body frame; for poses also of the rates of the translation.
template <class Curve>
[[nodiscard]] computed_results measured_motion(const Curve& s, const numbers& parameters) {
  using T = typename Curve::scalar_type;
  computed_results result;
  for (const double u : parameters) {
    const auto append_series = [&](const auto& series, const std::vector<std::size_t>& parts,
                                   int order) {
      const std::size_t first = result.coefficients.size();
      result.coefficients.resize(first + series[0].size());
      double factorial = 1;
      for (std::size_t k = 0; k < series.size(); ++k) {
        factorial *= k > 1 ? double(k) : 1;
        for (std::size_t i = 0; i < series[k].size(); ++i) {
          result.coefficients[first + i].push_back(series[k][i] / factorial);
        }
      }
      result.parts.insert(result.parts.end(), parts.begin(), parts.end());
      result.orders.insert(result.orders.end(), parts.size(), order);
    };
    std::vector<numbers> values;
    for (const auto& q : s.derivatives(u)) {
      append_components(values.emplace_back(), q);
    }
    append_series(values, std::vector<std::size_t>(is_pose<T> ? 2 : 1, 4), 0);
    // Angular rates come first here, but last in twists.
    const auto append_rates = [&](const duet::motion<T>& m, bool has_angular) {
      std::vector<numbers> rates;
      for (const auto& rate : {m.velocity, m.acceleration, m.jerk}) {
        numbers& list = rates.emplace_back();
        constexpr int angular = is_pose<T> ? 3 : 0;
        for (int i = 0; i < 3 && has_angular; ++i) {
          list.push_back(rate[angular + i]);
        }
        for (int i = 0; i < angular; ++i) {
          list.push_back(rate[i]);
        }
      }
      append_series(rates, std::vector<std::size_t>(rates[0].size() / 3, 3), 1);
    };
    append_rates(s.motion(u, duet::frame::spatial), true);
    append_rates(s.motion(u, duet::frame::body), true);
    if constexpr (is_pose<T>) {
      append_rates(s.motion(u, duet::frame::hybrid), false);
    }
  }
  return result;
}

} // namespace duet_test::accuracy
