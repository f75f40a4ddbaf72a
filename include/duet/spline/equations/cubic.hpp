// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.
#pragma once

#include <duet/core/scalar_traits.hpp>
#include <duet/dual/dual.hpp>
#include <duet/quaternion/exponential.hpp>
#include <duet/quaternion/quaternion.hpp>
#include <duet/quaternion/rotation.hpp>
#include <duet/quaternion/three_vector.hpp>
#include <duet/spline/basis.hpp>
#include <duet/spline/blocks/tridiagonal.hpp>
#include <duet/spline/cumulative_bspline.hpp>
#include <duet/spline/curve_ends.hpp>
#include <duet/spline/equations/curve_equations.hpp>
#include <duet/spline/equations/small_turns.hpp>
#include <duet/spline/knots.hpp>
#include <duet/spline/motion.hpp>
#include <duet/spline/orientations.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

/// \file
/// What the increments of an interpolating cubic have to fulfil.

namespace duet::detail {

/// Equations for the half-angle vectors ω_1, ω_2 … of the cubic through Q_0 … Q_n: with the piece
/// S of its span,
///   S(u_i)⁻¹ S(u_{i+1}) = Q_i⁻¹ Q_{i+1},   i = 0 … n − 1,
/// and, where the ends ask for it, one for the rates at either end. Three increments meet in every
/// equation, not as logarithms of controls but as vectors of any length. Unknown k is ω_{k+1}; of
/// a periodic curve ω_{k+2}, counted round.
template <class T>
class cubic_equations {
  using R = real_type_t<T>;

public:
  using curve_type = cumulative_bspline<T, 4>;
  using real_type = R;
  using unknowns = std::vector<vector3<T>>;
  using matrix = block_tridiagonal<R, 3>;

  cubic_equations(const std::vector<R>& u, std::vector<quaternion<T>> q, const curve_ends<T>& ends)
      : kind_(ends.kind), basis_(knots(u, ends.kind)), data_(std::move(q)) {
    const std::size_t n = u.size() - 1;
    turns_.reserve(n);
    arcs_.reserve(n);
    R shortest = u[1] - u[0], longest = shortest;
    for (std::size_t i = 0; i < n; ++i) {
      turns_.push_back(turn_between(data_[i], data_[i + 1]));
      std::size_t span = i;
      if (kind_ == end_kind::not_a_knot) {
        span = i == 0 ? 0 : i == n - 1 ? n - 3 : i - 1;
      }
      arc a{span, basis_.template weights<0>(span, u[i])[0], basis_.changes(span, u[i], u[i + 1])};
      if (u[i] == basis_.breaks()[span]) {
        a.from[2] = R(0);
      }
      arcs_.push_back(a);
      shortest = std::min(shortest, R(u[i + 1] - u[i]));
      longest = std::max(longest, R(u[i + 1] - u[i]));
    }
    unevenness_ = longest / shortest;
    const auto& rates = kind_ == end_kind::velocity ? ends.velocity : ends.acceleration;
    end_rates_ = {rotate(conj(data_.front()), rates[0]), rotate(conj(data_.back()), rates[1])};
  }

  /// Fewer leave equations without their unknowns.
  [[nodiscard]] static std::size_t least_rows(end_kind kind) {
    return kind == end_kind::not_a_knot ? 4 : kind == end_kind::periodic ? 3 : 2;
  }

  /// Number of equations, which is that of the unknowns.
  [[nodiscard]] std::size_t size() const { return arcs_.size() + (has_end_rates() ? 2 : 0); }
  [[nodiscard]] corners corner_columns() const {
    return is_cyclic() ? corners{size() - 1, 0} : corners{2, size() - 3};
  }
  [[nodiscard]] unknowns start() const { return small_turn_solution<R>(*this); }

  [[nodiscard]] R relative_step(const unknowns& x, const unknowns& step) const {
    return detail::relative_step<R>(*this, x, step);
  }
  [[nodiscard]] const R& unevenness() const { return unevenness_; }

  /// The largest angle from one row to the next, and the row before it.
  [[nodiscard]] std::pair<R, std::size_t> largest_turn() const {
    std::pair<R, std::size_t> result{R(0), 0};
    for (std::size_t i = 0; i < turns_.size(); ++i) {
      const R angle = 2 * log_vector(innermost_of(turns_[i]), "interpolate").norm();
      if (angle > result.first) {
        result = {angle, i};
      }
    }
    return result;
  }

  /// Makes them the equations of a motion that turns less: Q_i⁻¹ Q_{i+1} to the power λ, end rates
  /// by the factor λ.
  void scale(const R& lambda) {
    for (quaternion<T>& turn : turns_) {
      turn = duet::exp((lambda * components(log_vector(turn, "interpolate"))).eigen());
    }
    for (vector3<T>& rate : end_rates_) {
      rate = lambda * components(rate);
    }
  }

  /// The j-th of the three unknowns in an equation.
  [[nodiscard]] std::size_t unknown(std::size_t row, std::size_t j) const {
    const std::size_t n = size();
    if (is_cyclic()) {
      return (row + n - 1 + j) % n;
    }
    return (row == 0 ? 0 : row == n - 1 ? n - 3 : row - 1) + j;
  }
  /// Its block's place: 0 lower, 1 diagonal, 2 upper, corners included.
  [[nodiscard]] std::size_t place(std::size_t row, std::size_t j) const {
    return (j + (is_cyclic() ? 0 : row == 0 ? 1 : row == size() - 1 ? 2 : 0)) % 3;
  }

  /// What an equation leaves, a half-angle vector; end rates are brought to the size of an
  /// increment.
  template <class D>
  [[nodiscard]] vector3<D> residual(std::size_t row, const std::array<vector3<D>, 3>& omega) const {
    if (has_end_rates()) {
      if (row == 0 || row + 1 == size()) {
        return end_residual(row == 0, omega);
      }
      --row;
    }
    const arc& a = arcs_[row];
    // Factors that stand on both sides are left out: they turn those between them. What is left is
    // as small as the turn, and keeps all its digits.
    std::array<vector3<D>, 3> turned;
    for (std::size_t j = 0; j < 3; ++j) {
      turned[j] = a.change[j] * components(omega[j]);
      if (j > 0 && a.from[j] != 0) {
        const quaternion<D> back = duet::exp((R(-a.from[j]) * components(omega[j])).eigen());
        for (std::size_t k = 0; k < j; ++k) {
          turned[k] = rotate(back, turned[k]);
        }
      }
    }
    const quaternion<D> turn = duet::exp(turned[0]) * duet::exp(turned[1]) * duet::exp(turned[2]);
    return log_vector(quaternion<D>(conj(turn) * quaternion<D>(turns_[row])), "interpolate");
  }

  /// An equation for turns so small that their order does not matter: Σ weights_j x_j = right.
  [[nodiscard]] small_turn_equation<T> small_turns(std::size_t row) const {
    if (has_end_rates()) {
      if (row == 0 || row + 1 == size()) {
        const curve_end end = end_of_curve(row == 0);
        std::array<R, 3> weights = end.weights[kind_ == end_kind::velocity ? 1 : 2];
        for (R& weight : weights) {
          weight *= end.scale;
        }
        return {weights, end.scale * components(end_rates_[row == 0 ? 0 : 1])};
      }
      --row;
    }
    return {arcs_[row].change, log_vector(turns_[row], "interpolate")};
  }

  /// All of them.
  void residuals(const std::vector<vector3<T>>& x, std::vector<vector3<T>>& result) const {
    result.resize(size());
    for (std::size_t row = 0; row < size(); ++row) {
      result[row] =
          residual(row, std::array{x[unknown(row, 0)], x[unknown(row, 1)], x[unknown(row, 2)]});
    }
  }

  /// Residuals and factorised Jacobian; false where that is singular. For real T.
  [[nodiscard]] bool linearise(const unknowns& x, unknowns& r, matrix& jacobian) const {
    using D = dual<R, 9, derivative_tag<cubic_equations>>;
    r.resize(x.size());
    auto& rows = jacobian.rows();
    rows.resize(x.size());
    for (std::size_t row = 0; row < x.size(); ++row) {
      std::array<vector3<D>, 3> omega;
      for (std::size_t j = 0; j < 3; ++j) {
        const vector3<R>& value = x[unknown(row, j)];
        for (int b = 0; b < 3; ++b) {
          omega[j][b] = D::variable(value[b], int(3 * j) + b);
        }
      }
      const vector3<D> left = residual(row, omega);
      for (std::size_t j = 0; j < 3; ++j) {
        matrix3<R>& block = rows[row].at(place(row, j));
        for (int a = 0; a < 3; ++a) {
          r[row][a] = left[a].value();
          for (int b = 0; b < 3; ++b) {
            block(a, b) = left[a].partial(int(3 * j) + b);
          }
        }
      }
    }
    return jacobian.factorise(corner_columns());
  }

  [[nodiscard]] curve_type curve(const std::vector<R>&, const std::vector<quaternion<T>>&,
                                 const unknowns& x) const {
    std::vector<vector3<T>> omega = increments(x);
    std::vector<quaternion<T>> made = controls(omega);
    return curve_type(basis_, std::move(made), std::move(omega));
  }

private:
  [[nodiscard]] bool is_cyclic() const { return kind_ == end_kind::periodic; }
  [[nodiscard]] bool has_end_rates() const { return !is_cyclic() && kind_ != end_kind::not_a_knot; }

  [[nodiscard]] static std::vector<R> knots(const std::vector<R>& u, end_kind kind) {
    return kind == end_kind::periodic     ? periodic_knots(u, 4)
           : kind == end_kind::not_a_knot ? not_a_knot_knots(u, 4)
                                          : clamped_knots(u, 4);
  }

  /// ω_0 = 0 and the increments of all controls.
  [[nodiscard]] std::vector<vector3<T>> increments(const std::vector<vector3<T>>& x) const {
    std::vector<vector3<T>> omega{vector3<T>::Zero()};
    omega.reserve(basis_.size());
    for (std::size_t i = 1; i < basis_.size(); ++i) {
      omega.push_back(x[is_cyclic() ? (i + 2 * size() - 2) % size() : i - 1]);
    }
    return omega;
  }

  /// Each control from the data at the start of its span, so that no error grows along the curve.
  [[nodiscard]] std::vector<quaternion<T>>
  controls(const std::vector<vector3<T>>& increments) const {
    std::vector<quaternion<T>> result;
    result.reserve(basis_.size());
    for (std::size_t i = 0; i < arcs_.size(); ++i) {
      const arc& a = arcs_[i];
      if (a.span == result.size()) {
        const auto back = [&](std::size_t j) {
          return duet::exp((R(-a.from[j]) * components(increments[a.span + 1 + j])).eigen());
        };
        result.push_back(normalized(data_[i] * back(1) * back(0)));
      }
    }
    while (result.size() < basis_.size()) {
      result.push_back(normalized(result.back() * duet::exp(increments[result.size()])));
    }
    return result;
  }

  /// From row i to row i + 1: the span, the weights of its three increments at row i, and by how
  /// much these change.
  struct arc {
    std::size_t span;
    std::array<R, 3> from, change;
  };

  /// The weights at an end of the curve, and what brings its rate to the size of an increment.
  struct curve_end {
    cumulative_weights<R, 4, 2> weights;
    R scale;
  };
  [[nodiscard]] curve_end end_of_curve(bool at_start) const {
    const std::size_t span = at_start ? 0 : basis_.breaks().size() - 2;
    const R h = basis_.breaks()[span + 1] - basis_.breaks()[span];
    return {basis_.template weights<2>(span, at_start ? basis_.front() : basis_.back()),
            kind_ == end_kind::velocity ? R(h / 3) : R(h * h / 6)};
  }

  template <class D>
  [[nodiscard]] vector3<D> end_residual(bool at_start,
                                        const std::array<vector3<D>, 3>& omega) const {
    const curve_end end = end_of_curve(at_start);
    const auto m = product_of_exponentials<2>(quaternion<D>(D(1)), omega.data(), end.weights);
    return end.scale * ((kind_ == end_kind::velocity ? m.velocity : m.acceleration) -
                        components(end_rates_[at_start ? 0 : 1]));
  }

  end_kind kind_;
  bspline_basis<4, R> basis_;
  std::vector<quaternion<T>> data_;
  std::vector<quaternion<T>> turns_;
  std::vector<arc> arcs_;
  R unevenness_;
  std::array<vector3<T>, 2> end_rates_;
};

template <class Own, class T>
struct equations_of<cumulative_bspline<Own, 4>, T> {
  using type = cubic_equations<T>;
};

} // namespace duet::detail
