// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include "bounded_step.hpp"
#include "small_vector.hpp"
#include <duet/quaternion/three_vector.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

/// \file
/// Singular configurations: null space, missing twist and escape direction.

namespace duet::detail {
DUET_ABI_BEGIN

/// Singular value that counts as zero.
inline constexpr double singularity_threshold = 1e-5;

/// Null space of the Jacobian: joint motion with the tip fixed. Keeps a reference to the Jacobian.
template <int Capacity>
class self_motion_space {
public:
  using vector = small_vector<Capacity>;

  /// \param none  singular values up to this count as zero
  explicit self_motion_space(const small_matrix<6, Capacity>& jacobian,
                             double none = singularity_threshold)
      : jacobian_(jacobian), gram_(gram_of(jacobian), {0, none * none}) {}

  /// Projection of a step onto the null space, where the tip is fixed: λ (JᵀJ + λ)⁻¹ times the
  /// step, λ the square of the singular value that counts as zero.
  [[nodiscard]] vector projection_of(vector step) const {
    const small_twist force = gram_.solve(residual_after_step({}, jacobian_, step));
    for (std::ptrdiff_t i = 0; i < jacobian_.cols(); ++i) {
      step[i] += column_dot(jacobian_, i, force);
    }
    return step;
  }
  /// Unit direction of the null space nearest to `desired`; zero if none is near it.
  [[nodiscard]] vector direction(vector desired) const {
    for (int round = 0; round < 2; ++round) { // the second time for round-off
      desired = projection_of(desired);
      const double length = norm(desired);
      if (!(length > .3)) {
        return {};
      }
      desired = 1 / length * desired;
    }
    return desired;
  }
  /// Any unit direction of the null space; zero if it has dimension zero.
  [[nodiscard]] vector any_direction() const {
    vector best;
    double largest = 0;
    for (std::ptrdiff_t i = 0; i < jacobian_.cols(); ++i) {
      vector unit;
      unit[i] = 1;
      const auto d = direction(unit);
      if (std::abs(d[i]) > largest) { // d[i] is the component of the unit vector in d
        largest = std::abs(d[i]);
        best = d;
      }
    }
    return best;
  }

private:
  const small_matrix<6, Capacity>& jacobian_;
  damped_gram gram_;
};

/// Sign of the determinant of J with a direction of self-motion below it for one degree of
/// redundancy, else 1. It is constant along a self-motion curve, and changes beyond a crossing of
/// curves, and on the curve beyond a near crossing.
template <int Capacity>
[[nodiscard]] double orientation(const small_matrix<6, Capacity>& jacobian,
                                 const small_vector<Capacity>& direction) {
  if (jacobian.cols() != 7) {
    return 1;
  }
  small_matrix<7, 7> m;
  for (int k = 0; k < 7; ++k) {
    for (int i = 0; i < 6; ++i) {
      m(i, k) = jacobian(i, k);
    }
    m(6, k) = direction[k];
  }
  double sign = 1;
  for (int i = 0; i < 7; ++i) {
    int pivot = i;
    for (int k = i + 1; k < 7; ++k) {
      pivot = std::abs(m(i, k)) > std::abs(m(i, pivot)) ? k : pivot;
    }
    std::swap(m.columns[std::size_t(i)], m.columns[std::size_t(pivot)]);
    sign = (m(i, i) < 0) != (pivot != i) ? -sign : sign;
    for (int k = i + 1; k < 7 && m(i, i) != 0; ++k) {
      auto& column = m.columns[std::size_t(k)];
      column = column - m(i, k) / m(i, i) * m.columns[std::size_t(i)];
    }
  }
  return sign;
}

/// Left singular twist: left singular vector w of J for its smallest singular value; wᵀJ = 0 in a
/// singular configuration.
template <int Capacity>
[[nodiscard]] small_twist left_singular_twist(const small_matrix<6, Capacity>& jacobian) {
  constexpr double none = 1e-6;
  const damped_gram gram(gram_of(jacobian), {0, none * none});
  small_twist w{{1, .7, -.4, .9, -.6, .5}};
  for (int k = 0; k < 3; ++k) {
    w = gram.solve(w);
    w = 1 / norm(w) * w;
  }
  return w;
}

/// Singular configuration to second order: w, `left_singular_twist`, and H, the second derivatives
/// of the tip's displacement along w,
///
/// H_jk = w · [ω_j × v_k; ½ ω_j × ω_k], j ≤ k, of the columns [v; ω] of J in `frame::hybrid`.
template <int Capacity>
class singular_point {
public:
  explicit singular_point(const small_matrix<6, Capacity>& jacobian)
      : jacobian_(jacobian), w_(left_singular_twist(jacobian)) {
    const three_vector<double> force{w_[0], w_[1], w_[2]}, moment{w_[3], w_[4], w_[5]};
    for (std::ptrdiff_t k = 0; k < jacobian.cols(); ++k) {
      const auto& column = jacobian.columns[std::size_t(k)];
      const three_vector<double> v{column[0], column[1], column[2]};
      const three_vector<double> omega{column[3], column[4], column[5]};
      for (std::ptrdiff_t j = 0; j <= k; ++j) {
        const auto& before = jacobian.columns[std::size_t(j)];
        const three_vector<double> axis{before[3], before[4], before[5]};
        h_(j, k) = dot(force, cross(axis, v)) + .5 * dot(moment, cross(axis, omega));
        h_(k, j) = h_(j, k);
      }
    }
  }

  /// Escape direction, of unit length, in which the singularity is left fastest; its opposite is as
  /// good. Joint velocities n of the null space move the tip at θ + s d by s wᵀHd·n: d is the unit
  /// vector that maximises this over all n of length 1.
  [[nodiscard]] small_vector<Capacity> escape_direction() const {
    small_vector<Capacity> d;
    for (std::ptrdiff_t i = 0; i < jacobian_.cols(); ++i) {
      d[i] = 1 + .1 * double(i);
    }
    const self_motion_space still(jacobian_);
    for (int k = 0; k < 8; ++k) {
      d = times_h(still.projection_of(times_h(d)));
      const double length = norm(d);
      if (!(length > 1e-12)) {
        return {};
      }
      d = 1 / length * d;
    }
    return d;
  }

  /// Two steps s n, n the direction of least motion of the tip, that move it along w as a small
  /// twist does: wᵀJn s + ½ s² nᵀHn = w·e. Zero if there are none.
  [[nodiscard]] std::array<small_vector<Capacity>, 2> steps_for(const small_twist& e) const {
    const auto n = self_motion_space(jacobian_, damping_threshold).any_direction();
    const double linear = -dot(w_, residual_after_step({}, jacobian_, n)),
                 quadratic = dot(n, times_h(n));
    const double root = std::sqrt(linear * linear + 2 * quadratic * dot(w_, e));
    std::array<small_vector<Capacity>, 2> result;
    for (std::size_t k = 0; k < 2; ++k) {
      const double s = ((k == 0 ? root : -root) - linear) / quadratic;
      if (std::abs(s) < 1) { // not NaN either
        result[k] = s * n;
      }
    }
    return result;
  }

private:
  [[nodiscard]] small_vector<Capacity> times_h(const small_vector<Capacity>& x) const {
    small_vector<Capacity> result;
    for (std::ptrdiff_t k = 0; k < jacobian_.cols(); ++k) {
      result = result + x[k] * h_.columns[std::size_t(k)];
    }
    return result;
  }

  const small_matrix<6, Capacity>& jacobian_;
  small_twist w_;
  small_matrix<Capacity, Capacity> h_;
};

/// Smallest singular value of a Jacobian, from above.
template <int Capacity>
[[nodiscard]] double smallest_singular_value_of(const small_matrix<6, Capacity>& jacobian) {
  return damped_gram(gram_of(jacobian)).smallest();
}

DUET_ABI_END
} // namespace duet::detail
