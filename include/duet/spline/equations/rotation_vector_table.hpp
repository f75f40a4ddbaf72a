// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/orientations.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// The rows between which rotation-vector splines are made.

namespace duet::detail {

/// Steps and turns from row to row. The parameter is counted in units of about one step, so that
/// all derivatives have one size.
template <class T>
struct rotation_vector_table {
  using R = real_type_t<T>;

  R unit;
  std::vector<R> steps;          ///< of the parameter, in units
  std::vector<vector3<T>> turns; ///< half-angle vectors

  /// \param u  increasing
  /// \param q  as many unit elements, signs aligned
  rotation_vector_table(const std::vector<R>& u, const std::vector<quaternion<T>>& q) {
    using std::frexp;
    using std::ldexp;
    const std::size_t last = u.size() - 1;
    int exponent = 0;
    static_cast<void>(frexp(R((u.back() - u.front()) / R(last)), &exponent));
    unit = ldexp(R(1), exponent);
    steps.reserve(last);
    turns.reserve(last);
    for (std::size_t i = 0; i < last; ++i) {
      steps.push_back((u[i + 1] - u[i]) / unit);
      turns.push_back(log_vector(turn_between(q[i], q[i + 1]), "interpolate"));
    }
  }

  /// The longest interval of the parameter as a multiple of the shortest.
  [[nodiscard]] R unevenness() const {
    const auto [shortest, longest] = std::minmax_element(steps.begin(), steps.end());
    return *longest / *shortest;
  }

  /// The largest angle from one row to the next, rad, and the row it starts from.
  [[nodiscard]] std::pair<R, std::size_t> largest_turn() const {
    using std::sqrt;
    std::pair<R, std::size_t> largest{R(-1), 0};
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const R angle = 2 * sqrt(R(innermost(dot(components(turns[i]), components(turns[i])))));
      if (angle > largest.first) {
        largest = {angle, i};
      }
    }
    return largest;
  }

  /// Velocity and acceleration at a row of the parabola through it and its neighbours, as if turns
  /// were small.
  [[nodiscard]] std::pair<vector3<T>, vector3<T>> parabola(std::size_t i, bool is_cyclic) const {
    const std::size_t last = steps.size();
    const std::size_t left = i > 0 ? i - 1 : is_cyclic ? last - 1 : 0;
    const std::size_t right = i < last ? i : last - 1;
    const vector3<T> before = turns[left] / steps[left];
    const vector3<T> after = turns[right] / steps[right];
    const R h = steps[left] + steps[right];
    return {(before * steps[right] + after * steps[left]) / h, (after - before) * (2 / h)};
  }

  /// A power of the unit.
  [[nodiscard]] R unit_to(std::size_t exponent) const {
    R result(1);
    for (std::size_t i = 0; i < exponent; ++i) {
      result *= unit;
    }
    return result;
  }

  /// Coefficients of polynomials of the parameter itself.
  template <class Polynomial>
  void in_own_units(std::vector<Polynomial>& polynomials) const {
    for (Polynomial& each : polynomials) {
      R per_unit(1);
      for (vector3<T>& coefficient : each) {
        coefficient = per_unit * components(coefficient);
        per_unit /= unit;
      }
    }
  }
};

} // namespace duet::detail
