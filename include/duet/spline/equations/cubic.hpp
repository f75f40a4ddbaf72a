// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/core/select.hpp>
#include <duet/dual/stumpff.hpp>
#include <duet/quaternion/exponential_jacobian.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/blocks.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/end_conditions.hpp>
#include <duet/spline/equations/newton.hpp>
#include <duet/spline/orientations.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

/// \file
/// Equations for the increments of the interpolating cumulative cubic.

namespace duet::detail {

/// Equation Σ weights_j x_j = right for small rotations, which commute to first order, so that
/// coordinates do not mix.
template <class T>
struct small_angle_equation {
  std::array<real_type_t<T>, 3> weights;
  vector3<T> right;
};

/// Derivatives of a vector with respect to three vectors.
template <class R>
using gradient_by_three = std::array<matrix3<R>, 3>;

/// Transposed rotation matrix of e = exp(v), and J(v).
template <class R>
struct rotation_factor {
  matrix3<R> back, jacobian;
  explicit rotation_factor(const vector3<R>& v) {
    const R s = dot(components(v), components(v));
    const auto [cosine, ratio] = first_stumpff_pair(s);
    // c_1(4s), 2c_2(4s) and 4c_3(4s) from those of s
    jacobian = axial_matrix<R>(cosine * ratio, -ratio * ratio, 4 * stumpff<3>(R(4 * s)), v);
    back = axial_matrix<R>(cosine * cosine - s * ratio * ratio, -2 * cosine * ratio,
                           2 * ratio * ratio, v);
  }
};

/// Derivatives of −P* δP with respect to ω_0, ω_1 and ω_2 for the product P = e_1 e_2 …, e = exp(b
/// ω_j) for each factor (j, b). Each factor rotates the derivatives back and adds b J(b ω_j) δω_j.
template <class R, std::size_t Factors>
[[nodiscard]] gradient_by_three<R>
minus_product_gradient(const std::array<std::pair<std::size_t, R>, Factors>& factors,
                       const std::array<vector3<R>, 3>& omega) {
  gradient_by_three<R> by;
  by.fill(matrix3<R>::Zero());
  std::array<bool, 3> is_taken_in{};
  for (const auto& [j, b] : factors) {
    if (b != 0) {
      const rotation_factor<R> e(b * components(omega[j]));
      for (std::size_t k = 0; k < 3; ++k) {
        if (is_taken_in[k]) {
          by[k] = product(e.back, by[k]);
        }
      }
      is_taken_in[j] = true;
      add_multiple(by[j], R(-b), e.jacobian);
    }
  }
  return by;
}

/// Derivatives of e* (b_0 ω_0 + b_1 ω_1) e + b_2 ω_2, e = exp(ω_2), with respect to ω_0, ω_1 and
/// ω_2; or without e.
template <class R>
[[nodiscard]] gradient_by_three<R>
end_gradient(const std::array<R, 3>& b, const std::array<vector3<R>, 3>& omega, bool is_rotated) {
  gradient_by_three<R> by;
  by.fill(matrix3<R>::Zero());
  for (std::size_t j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      by[j](i, i) = b[j];
    }
  }
  if (is_rotated) { // ŵ = e* w e changes by 2 ŵ × J δω_2
    const rotation_factor<R> e(omega[2]);
    vector3<R> twice_rate = vector3<R>::Zero();
    for (std::size_t j = 0; j < 2; ++j) {
      by[j] = product(e.back, by[j]);
      add_product(twice_rate, R(2), by[j], omega[j]);
    }
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, other = (k + 2) % 3;
      for (int i = 0; i < 3; ++i) {
        by[2](k, i) +=
            twice_rate[next] * e.jacobian(other, i) - twice_rate[other] * e.jacobian(next, i);
      }
    }
  }
  return by;
}

/// Equations for the half-angle vectors ω_1, ω_2 … of the cubic through Q_0 … Q_n: with the piece S
/// of its span,
///   S(u_i)⁻¹ S(u_{i+1}) = Q_i⁻¹ Q_{i+1},   i = 0 … n − 1,
/// and, if the end conditions need it, one for the velocity or acceleration at either end. Every
/// equation involves three increments, as vectors of any length instead of logarithms of control
/// points. Unknown k is ω_{k+1}; for a periodic curve ω_{k+2}, counted cyclically.
template <class T>
class cubic_equations {
  using R = real_type_t<T>;

public:
  using curve_type = cumulative_bspline<T, 4>;
  using real_type = R;
  using unknowns = std::vector<vector3<T>>;
  using matrix = block_tridiagonal<R>;

  cubic_equations(const std::vector<R>& u, std::vector<quaternion<T>> q, const curve_ends<T>& ends)
      : kind_(ends.kind), basis_(knots(u, ends.kind)), data_(std::move(q)),
        rotations_(u.size() - 1), angles_(rotations_.size()), arcs_(rotations_.size()) {
    const std::size_t n = rotations_.size();
    R shortest = u[1] - u[0], longest = shortest;
    for (std::size_t i = 0; i < n; ++i) {
      rotations_[i] = relative_rotation(data_[i], data_[i + 1]);
      angles_[i] = log_out_of_line(rotations_[i]);
      const bool is_shifted = kind_ == end_condition_kind::not_a_knot;
      const std::size_t span = !is_shifted || i == 0 ? i : std::min(i - 1, n - 3);
      arc& a = arcs_[i];
      a = {span, basis_.template weights<0>(span, u[i])[0], basis_.changes(span, u[i], u[i + 1])};
      a.from[2] = u[i] == basis_.breaks()[span] ? R(0) : a.from[2];
      const R step = u[i + 1] - u[i];
      shortest = std::min(shortest, step);
      longest = std::max(longest, step);
    }
    unevenness_ = longest / shortest;
    const auto& rates = kind_ == end_condition_kind::velocity ? ends.velocity : ends.acceleration;
    end_rates_ = {rotate(conj(data_.front()), rates[0]), rotate(conj(data_.back()), rates[1])};
  }

  /// Minimum number of samples; fewer leave equations without their unknowns.
  [[nodiscard]] static std::size_t min_samples(end_condition_kind kind) {
    return kind == end_condition_kind::not_a_knot ? 4
           : kind == end_condition_kind::periodic ? 3
                                                  : 2;
  }

  /// Number of equations, equal to the number of unknowns.
  [[nodiscard]] std::size_t size() const { return arcs_.size() + (has_end_rates() ? 2 : 0); }
  [[nodiscard]] corners corner_columns() const {
    return is_cyclic() ? corners{size() - 1, 0} : corners{2, size() - 3};
  }

  /// Initial guess of Newton's method: the solution for small rotations; zero if their equations
  /// are singular. For real T.
  [[nodiscard]] unknowns start() const {
    matrix equations;
    auto& rows = equations.rows();
    rows.resize(size());
    unknowns x(size());
    for (std::size_t row = 0; row < size(); ++row) {
      const small_angle_equation<R> equation = small_angles(row);
      for (std::size_t j = 0; j < 3; ++j) {
        rows[row].at(block_position(row, j)) = equation.weights[j] * matrix3<R>::Identity();
      }
      x[row] = equation.right;
    }
    if (equations.factorise(corner_columns())) {
      equations.solve(x);
    } else {
      x.assign(size(), vector3<R>::Zero());
    }
    return x;
  }

  /// Size of a step of the unknowns from x relative to the values it changes: the maximum over all
  /// equations of the change divided by the largest term of the equation. So small equations of
  /// short intervals count as much as those of long ones. For real T.
  [[nodiscard]] R relative_step(const unknowns& x, const unknowns& step) const {
    using std::abs;
    std::vector<R> moved(size(), R(0)), term(size());
    R largest(0);
    for (std::size_t row = 0; row < size(); ++row) {
      const small_angle_equation<R> equation = small_angles(row);
      term[row] = length(equation.right);
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t k = unknown(row, j);
        const R weight = abs(equation.weights[j]);
        const R change = weight * length(step[k]);
        moved[row] += change;
        term[row] = std::max(R(term[row] + change), R(weight * length(x[k])));
      }
      largest = std::max(largest, term[row]);
    }
    // Far from all rotations, terms decay below the smallest numbers: they are bounded from below.
    const R epsilon = std::numeric_limits<R>::epsilon();
    const R min_term = largest * (epsilon * epsilon) * (epsilon * epsilon);
    R result(0);
    for (std::size_t row = 0; row < size(); ++row) {
      const R ratio = moved[row] > 0 ? R(moved[row] / std::max(term[row], min_term)) : moved[row];
      result = larger_or_nan(result, ratio);
    }
    return result;
  }
  [[nodiscard]] const R& unevenness() const { return unevenness_; }

  /// Largest rotation angle between neighbouring samples, rad, and the index of the sample before
  /// it.
  [[nodiscard]] std::pair<R, std::size_t> max_rotation() const { return largest_rotation(angles_); }

  /// Changes the equations to those of a smaller motion: Q_i⁻¹ Q_{i+1} to the power λ, end rates
  /// times λ.
  void scale(const R& lambda) {
    for (std::size_t i = 0; i < rotations_.size(); ++i) {
      angles_[i] = lambda * components(angles_[i]);
      rotations_[i] = exp_out_of_line(angles_[i]);
    }
    for (vector3<T>& rate : end_rates_) {
      rate = lambda * components(rate);
    }
  }

  /// Index of the j-th of the three unknowns in an equation.
  [[nodiscard]] std::size_t unknown(std::size_t row, std::size_t j) const {
    const std::size_t n = size();
    return is_cyclic() ? (row + n - 1 + j) % n : std::min(row - std::size_t(row > 0), n - 3) + j;
  }
  /// Position of the block of this unknown: 0 lower, 1 diagonal, 2 upper, corners included.
  [[nodiscard]] std::size_t block_position(std::size_t row, std::size_t j) const {
    return (j + (is_cyclic() ? 0 : row == 0 ? 1 : row == size() - 1 ? 2 : 0)) % 3;
  }

  /// Residual of an equation, a half-angle vector; end rates are scaled to the size of an
  /// increment.
  [[nodiscard]] vector3<T> residual(std::size_t row, const std::array<vector3<T>, 3>& omega) const {
    if (is_end(row)) {
      return end_residual(row == 0, omega);
    }
    const std::size_t interval = interval_of(row);
    const arc& a = arcs_[interval];
    // Common factors on both sides cancel, except that they rotate the factors between them. The
    // remaining vectors are as small as the rotation of the arc and have all its digits.
    std::array<vector3<T>, 3> steps;
    for (std::size_t j = 0; j < 3; ++j) {
      steps[j] = a.change[j] * components(omega[j]);
      if (j > 0 && a.from[j] != 0) {
        const quaternion<T> back = exp_out_of_line<T>(R(-a.from[j]) * components(omega[j]));
        for (std::size_t k = 0; k < j; ++k) {
          steps[k] = rotate(back, steps[k]);
        }
      }
    }
    const quaternion<T> along_arc =
        exp_out_of_line(steps[0]) * exp_out_of_line(steps[1]) * exp_out_of_line(steps[2]);
    return log_out_of_line(quaternion<T>(conj(along_arc) * rotations_[interval]));
  }

  /// Equation Σ weights_j x_j = right for small rotations, which commute to first order.
  [[nodiscard]] small_angle_equation<T> small_angles(std::size_t row) const {
    if (is_end(row)) {
      return end_equation(row == 0);
    }
    return {arcs_[interval_of(row)].change, angles_[interval_of(row)]};
  }

  /// Residuals of all equations.
  void residuals(const unknowns& x, unknowns& result) const {
    result.resize(size());
    for (std::size_t row = 0; row < size(); ++row) {
      result[row] = residual(row, its_unknowns(row, x));
    }
  }

  /// Computes residuals and the factorised Jacobian; false if it is singular. For real T.
  [[nodiscard]] bool linearise(const unknowns& x, unknowns& r, matrix& jacobian) const {
    static_assert(Real<T>);
    residuals(x, r);
    auto& rows = jacobian.rows();
    rows.resize(x.size());
    for (std::size_t row = 0; row < x.size(); ++row) {
      const gradient_by_three<R> blocks = gradient(row, its_unknowns(row, x));
      for (std::size_t j = 0; j < 3; ++j) {
        rows[row].at(block_position(row, j)) = blocks[j];
      }
    }
    return jacobian.factorise(corner_columns());
  }

  [[nodiscard]] curve_type curve(const std::vector<R>&, const std::vector<quaternion<T>>&,
                                 const unknowns& x) const {
    std::vector<vector3<T>> omega = increments(x);
    return curve_type(basis_, controls(omega), omega);
  }

private:
  [[nodiscard]] bool is_cyclic() const { return kind_ == end_condition_kind::periodic; }
  [[nodiscard]] bool has_end_rates() const {
    return !is_cyclic() && kind_ != end_condition_kind::not_a_knot;
  }
  /// True for the equation of a rate at an end.
  [[nodiscard]] bool is_end(std::size_t row) const {
    return has_end_rates() && (row == 0 || row + 1 == size());
  }
  /// Interval between samples of any other equation.
  [[nodiscard]] std::size_t interval_of(std::size_t row) const {
    return row - (has_end_rates() ? 1 : 0);
  }

  [[nodiscard]] static std::vector<R> knots(const std::vector<R>& u, end_condition_kind kind) {
    return kind == end_condition_kind::periodic     ? periodic_knots(u, 4)
           : kind == end_condition_kind::not_a_knot ? not_a_knot_knots(u, 4)
                                                    : clamped_knots(u, 4);
  }

  /// ω_0 = 0 and the increments of all control points.
  [[nodiscard]] std::vector<vector3<T>> increments(const std::vector<vector3<T>>& x) const {
    std::vector<vector3<T>> omega(basis_.size(), vector3<T>::Zero());
    for (std::size_t i = 1; i < omega.size(); ++i) {
      omega[i] = x[is_cyclic() ? (i + 2 * size() - 2) % size() : i - 1];
    }
    return omega;
  }

  /// Control points, each from the data point at the start of its span, so that errors do not
  /// accumulate along the curve.
  [[nodiscard]] std::vector<quaternion<T>>
  controls(const std::vector<vector3<T>>& increments) const {
    std::vector<quaternion<T>> result;
    result.reserve(basis_.size());
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      const arc& a = arcs_[i];
      if (a.span == result.size()) {
        const auto back = [&](std::size_t j) {
          return exp_out_of_line<T>(R(-a.from[j]) * components(increments[a.span + 1 + j]));
        };
        result.push_back(normalized(data_[i] * back(1) * back(0)));
      }
    }
    while (result.size() < basis_.size()) {
      result.push_back(normalized(result.back() * exp_out_of_line(increments[result.size()])));
    }
    return result;
  }

  /// Interval from sample i to sample i + 1: its span, the weights of its three increments at
  /// sample i, and the changes of these weights.
  struct arc {
    std::size_t span;
    std::array<R, 3> from, change;
  };

  [[nodiscard]] std::array<vector3<T>, 3> its_unknowns(std::size_t row, const unknowns& x) const {
    return {x[unknown(row, 0)], x[unknown(row, 1)], x[unknown(row, 2)]};
  }

  /// Derivatives of the residual of an equation with respect to its unknowns. (The logarithm r of
  /// the difference of rotations changes by that of the difference times J⁻¹(r), which does not
  /// affect Newton steps: J(r) r = r.)
  [[nodiscard]] gradient_by_three<R> gradient(std::size_t row,
                                              const std::array<vector3<R>, 3>& omega) const {
    if (is_end(row)) {
      return end_gradient(end_equation(row == 0).weights, omega, row > 0);
    }
    const auto& [span, from, change] = arcs_[interval_of(row)];
    using factor = std::pair<std::size_t, R>;
    return minus_product_gradient(std::array{factor(2, -from[2]), factor(1, -from[1]),
                                             factor(0, change[0]), factor(1, from[1] + change[1]),
                                             factor(2, from[2] + change[2])},
                                  omega);
  }

  /// Weights of the increments in the rate that is given at an end of the curve, and that rate,
  /// both scaled to the size of an increment.
  [[nodiscard]] small_angle_equation<T> end_equation(bool at_start) const {
    const std::size_t span = at_start ? 0 : basis_.breaks().size() - 2;
    const R h = basis_.breaks()[span + 1] - basis_.breaks()[span];
    const bool is_velocity = kind_ == end_condition_kind::velocity;
    const R scale = is_velocity ? R(h / 3) : R(h * h / 6),
            end = basis_.breaks()[at_start ? 0 : span + 1];
    const auto weights = basis_.template weights<2>(span, end);
    small_angle_equation<T> result{weights[is_velocity ? 1 : 2],
                                   scale * components(end_rates_[at_start ? 0 : 1])};
    for (R& weight : result.weights) {
      weight *= scale;
    }
    return result;
  }

  /// Residual of an end equation. The weights are zero at the start and one at the end, where the
  /// rate of the last factor is that of the last increment alone: only this increment rotates the
  /// others.
  [[nodiscard]] vector3<T> end_residual(bool at_start,
                                        const std::array<vector3<T>, 3>& omega) const {
    const auto [b, right] = end_equation(at_start);
    three_vector<T> sum = b[0] * components(omega[0]) + b[1] * components(omega[1]);
    if (!at_start) {
      sum = rotated(conj(exp_out_of_line(omega[2])), sum);
    }
    return sum + b[2] * components(omega[2]) - components(right);
  }

  end_condition_kind kind_;
  bspline_basis<4, R> basis_;
  std::vector<quaternion<T>> data_;
  std::vector<quaternion<T>> rotations_;
  std::vector<vector3<T>> angles_; ///< half-angle vectors of `rotations_`
  std::vector<arc> arcs_;
  R unevenness_;
  std::array<vector3<T>, 2> end_rates_;
};

template <class Own, class T>
struct equations_of<cumulative_bspline<Own, 4>, T> {
  using type = cubic_equations<T>;
};

} // namespace duet::detail
